#include "models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

namespace etendue::compare_detail {
namespace {

using Values = std::vector<double>;

// Values of an interleaved R G B picture; outside it the nearest pixel.
struct Grid {
  const double* values;
  int width, height;

  double at(int x, int y, std::size_t c) const {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return values[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) + c];
  }
};

template <class F>
Values each_pixel(const Grid& grid, F&& value) {
  Values result(3 * static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  std::size_t i = 0;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) result[i++] = value(x, y, c);
    }
  }
  return result;
}

Values slope_x(const Grid& g) {
  return each_pixel(g, [&](int x, int y, std::size_t c) { return (g.at(x + 1, y, c) - g.at(x - 1, y, c)) / 2; });
}
Values slope_y(const Grid& g) {
  return each_pixel(g, [&](int x, int y, std::size_t c) { return (g.at(x, y + 1, c) - g.at(x, y - 1, c)) / 2; });
}
Values laplacian(const Grid& g) {
  return each_pixel(g, [&](int x, int y, std::size_t c) {
    return g.at(x + 1, y, c) + g.at(x - 1, y, c) + g.at(x, y + 1, c) + g.at(x, y - 1, c) - 4 * g.at(x, y, c);
  });
}

// Catmull-Rom weights of the samples at -1, 0, 1, 2 for the place t in [0, 1).
std::array<double, 4> cubic(double t) {
  return {t * (-.5 + t * (1 - .5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (.5 + t * (2 - 1.5 * t)), t * t * (-.5 + .5 * t)};
}

// The picture moved by (dx, dy) pixels: first along rows, then along columns.
Values moved(const Grid& g, double dx, double dy) {
  const auto along = [](const Grid& from, double d, int sx, int sy) {
    const double whole = std::floor(-d);
    const std::array<double, 4> w = cubic(-d - whole);
    const int k = static_cast<int>(whole);
    return each_pixel(from, [&](int x, int y, std::size_t c) {
      double sum = 0;
      for (int j = 0; j < 4; ++j) sum += w[static_cast<std::size_t>(j)] * from.at(x + sx * (k + j - 1), y + sy * (k + j - 1), c);
      return sum;
    });
  };
  const Values rows = along(g, dx, 1, 0);
  return along(Grid{rows.data(), g.width, g.height}, dy, 0, 1);
}

// base + sum theta_k slopes_k. The slopes are made when asked for: eight of a large picture are too many to keep for every light.
Model linear_model(Model::Kind kind, const Values& base, int parameters, std::function<std::vector<Values>()> make_slopes) {
  Model model;
  model.kind = kind;
  model.parameters = parameters;
  model.predict = [&base, make_slopes = std::move(make_slopes)](const Values& theta, Values& picture, std::vector<Values>& slopes) {
    picture = base;
    slopes = make_slopes();
    for (std::size_t k = 0; k < slopes.size(); ++k) {
      for (std::size_t i = 0; i < picture.size(); ++i) picture[i] += theta[k] * slopes[k][i];
    }
  };
  return model;
}

// c base^(1 + p): theta = (ln c, p). Values that are not positive have no power and stay.
Model gamma_model(const Values& base) {
  Model model;
  model.kind = Model::Kind::gamma;
  model.parameters = 2;
  model.linear = false;
  double sum = 0;
  for (double value : base) sum += std::max(value, 0.0);
  const double scale = sum > 0 ? sum / static_cast<double>(base.size()) : 1;  // so that c and p are hardly correlated
  model.predict = [&base, scale](const Values& theta, Values& picture, std::vector<Values>& slopes) {
    const double factor = std::exp(std::clamp(theta[0], -50.0, 50.0)), power = std::clamp(1 + theta[1], .05, 20.0);
    picture = base;
    slopes.assign(2, Values(base.size()));
    for (std::size_t i = 0; i < base.size(); ++i) {
      if (!(base[i] > 0)) continue;
      const double log_value = std::log(base[i] / scale);
      picture[i] = factor * scale * std::exp(power * log_value);
      slopes[0][i] = picture[i];
      slopes[1][i] = picture[i] * log_value;
    }
  };
  return model;
}

// Moved by (dx, dy) pixels; d/dx of a picture moved by +dx is minus its slope.
Model shift_model(const Values& base, int width, int height) {
  Model model;
  model.kind = Model::Kind::shift;
  model.parameters = 2;
  model.linear = false;
  model.predict = [&base, width, height](const Values& theta, Values& picture, std::vector<Values>& slopes) {
    picture = moved(Grid{base.data(), width, height}, std::clamp(theta[0], -8.0, 8.0), std::clamp(theta[1], -8.0, 8.0));
    const Grid grid{picture.data(), width, height};
    slopes = {slope_x(grid), slope_y(grid)};
    for (Values& slope : slopes) {
      for (double& value : slope) value = -value;
    }
  };
  return model;
}

Values layer_values(const Picture& picture, const std::string& name) {
  const Layer* layer = picture.find(name);
  if (!layer || layer->pixels.size() != 3 * std::size_t{picture.width} * picture.height) return {};
  return {layer->pixels.begin(), layer->pixels.end()};
}

double total(const Values& values) {
  double sum = 0;
  for (double value : values) sum += std::abs(value);
  return sum;
}

// The reference's layer of a light carries the very noise that the difference has; its surroundings' mean does not, and their ratio to the
// picture's gives the edges back that the light shares with the picture.
Values denoised(const Values& light, const Values& picture, const Evidence& e) {
  Values result = mean_around(light, e.width, e.height, e.emitter);
  const Values around = mean_around(picture, e.width, e.height, e.emitter);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = around[i] > 0 ? result[i] * std::max(0.0, picture[i]) / around[i] : 0;
  return result;
}

// The light's part may be brighter, fall off otherwise across the picture (up to second order), and lie elsewhere (its first and second
// slopes). Where a light moves, the paint under it does not: slopes are those of the light's share of the picture, times the picture. A
// light that is the whole of the picture has a share of 1, and its own slopes stand in.
constexpr int shape_parameters = 11;
std::vector<Values> shape_bases(const Values& light, const Values& picture, int width, int height) {
  const Grid g{light.data(), width, height};
  const auto u = [&](int x) { return 2 * (x + .5) / width - 1; };
  const auto v = [&](int y) { return 2 * (y + .5) / height - 1; };
  const bool alone = total(light) > .999 * total(picture);
  Values share = light;
  for (std::size_t i = 0; i < share.size() && !alone; ++i) share[i] = picture[i] > 0 ? light[i] / picture[i] : 0;
  const Values sx = slope_x({share.data(), width, height}), sy = slope_y({share.data(), width, height});
  std::vector<Values> slopes{sx, sy, slope_x({sx.data(), width, height}), slope_y({sy.data(), width, height}),
                             slope_y({sx.data(), width, height})};
  for (Values& slope : slopes) {
    for (std::size_t i = 0; i < slope.size() && !alone; ++i) slope[i] *= picture[i];
  }
  std::vector<Values> bases{light,
                            each_pixel(g, [&](int x, int y, std::size_t c) { return u(x) * g.at(x, y, c); }),
                            each_pixel(g, [&](int x, int y, std::size_t c) { return v(y) * g.at(x, y, c); }),
                            each_pixel(g, [&](int x, int y, std::size_t c) { return u(x) * u(x) * g.at(x, y, c); }),
                            each_pixel(g, [&](int x, int y, std::size_t c) { return u(x) * v(y) * g.at(x, y, c); }),
                            each_pixel(g, [&](int x, int y, std::size_t c) { return v(y) * v(y) * g.at(x, y, c); })};
  std::move(slopes.begin(), slopes.end(), std::back_inserter(bases));
  return bases;
}

// Solves A x = b for a symmetric positive definite A (n x n, row by row) and gives the diagonal of its inverse; a direction that the data
// do not determine gets 0.
void solve(Values a, const Values& b, Values& x, Values& inverse_diagonal) {
  const std::size_t n = b.size();
  Values scale(n);
  for (std::size_t i = 0; i < n; ++i) scale[i] = a[i * n + i] > 0 ? 1 / std::sqrt(a[i * n + i]) : 0;
  std::vector<Values> columns(n + 1, Values(n));
  for (std::size_t i = 0; i < n; ++i) {
    columns[n][i] = b[i] * scale[i];
    columns[i][i] = 1;
    for (std::size_t j = 0; j < n; ++j) a[i * n + j] *= scale[i] * scale[j];
    a[i * n + i] = a[i * n + i] > 0 ? 1 + 1e-10 : 1;
  }
  for (std::size_t k = 0; k < n; ++k) {  // L D L^T without pivoting: the diagonal is 1 and the matrix positive definite
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      for (Values& column : columns) column[i] -= factor * column[k];
    }
  }
  for (Values& column : columns) {
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t j = i + 1; j < n; ++j) column[i] -= a[i * n + j] * column[j];
      column[i] /= a[i * n + i];
    }
  }
  x.assign(n, 0);
  inverse_diagonal.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = columns[n][i] * scale[i];
    inverse_diagonal[i] = std::max(0.0, columns[i][i]) * scale[i] * scale[i];
  }
}

double chi2_of(const Evidence& e, const Values& weights, const Values& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * (e.reference[i] - picture[i]) * (e.reference[i] - picture[i]);
  return sum;
}

}  // namespace

std::vector<Model> models_for(const Values& base, const Evidence& e, const Picture& ours, const Picture& reference) {
  const int width = static_cast<int>(e.width), height = static_cast<int>(e.height);
  std::vector<Model> models;
  models.push_back(linear_model(Model::Kind::scale, base, 1, [&base] { return std::vector<Values>{base}; }));
  // Noise of our own is noise of our Laplacian too, and would pass for a filter.
  if (e.own_noise < .02) {
    models.push_back(linear_model(Model::Kind::filter, base, 1, [&base, width, height] {
      return std::vector<Values>{laplacian({base.data(), width, height})};
    }));
  }
  models.push_back(gamma_model(base));
  models.push_back(shift_model(base, width, height));
  for (const std::string& name : lights_of(reference)) {
    const Values theirs = layer_values(reference, "light." + name);
    auto light = std::make_shared<Values>(layer_values(ours, "light." + name));
    const bool absent = !(total(*light) > 1e-3 * total(theirs));
    if (absent && !theirs.empty()) *light = denoised(theirs, base, e);
    if (!(total(*light) > 0)) continue;
    models.push_back(linear_model(Model::Kind::light_scale, base, 1, [light] { return std::vector<Values>{*light}; }));
    models.back().light = name;
    models.back().light_absent = absent;
    if (absent) continue;
    models.push_back(linear_model(Model::Kind::light_shape, base, shape_parameters,
                                  [&base, light, width, height] { return shape_bases(*light, base, width, height); }));
    models.back().light = name;
  }
  return models;
}

Model own_shape_model(const Values& base, const Evidence& e, const std::string& light) {
  const int width = static_cast<int>(e.width), height = static_cast<int>(e.height);
  Model model = linear_model(Model::Kind::light_shape, base, shape_parameters,
                             [&base, width, height] { return shape_bases(base, base, width, height); });
  model.light = light;
  return model;
}

Values weights_of(const Evidence& e) {
  Values weights(e.variance.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    // 25: an outlier, as in regions.cpp; there its own variance stands, else one firefly would weigh as much as the quiet pixels around it.
    const double sigma2 = e.variance[i] > 25 * e.around[i] ? e.variance[i] : e.around[i];
    weights[i] = e.emitter[i / 3] || !(sigma2 > 0) ? 0 : 1 / sigma2;
  }
  return weights;
}

Fit fit(const Model& model, const Evidence& e, const Values& weights) {
  const auto n = static_cast<std::size_t>(model.parameters);
  Fit result;
  result.theta.assign(n, 0);
  std::vector<Values> slopes;
  model.predict(result.theta, result.predicted, slopes);
  result.chi2 = result.chi2_before = chi2_of(e, weights, result.predicted);
  const int rounds = model.linear ? 1 : 8;
  for (int round = 0; round < rounds; ++round) {
    Values matrix(n * n), right(n), step, inverse;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = j; k < n; ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * slopes[j][i] * slopes[k][i];
        matrix[j * n + k] = matrix[k * n + j] = sum;
      }
      for (std::size_t i = 0; i < weights.size(); ++i) right[j] += weights[i] * slopes[j][i] * (e.reference[i] - result.predicted[i]);
    }
    solve(std::move(matrix), right, step, inverse);
    Values errors;
    for (double v : inverse) errors.push_back(std::sqrt(v));
    // Half the step until it helps; a linear model's first step always does.
    double fraction = 1;
    bool better = false;
    for (int half = 0; half < 6 && !better; ++half, fraction /= 2) {
      Values theta = result.theta, picture;
      for (std::size_t k = 0; k < n; ++k) theta[k] += fraction * step[k];
      std::vector<Values> next;
      model.predict(theta, picture, next);
      const double chi2 = chi2_of(e, weights, picture);
      better = chi2 < result.chi2;
      if (!better) continue;
      const bool settled = result.chi2 - chi2 < 1e-4 * chi2;
      result.theta = std::move(theta);
      result.predicted = std::move(picture);
      result.errors = errors;
      result.chi2 = chi2;
      slopes = std::move(next);
      if (settled) return result;
    }
    if (!better) break;
  }
  if (result.errors.empty()) result.errors.assign(n, 0);
  return result;
}

}  // namespace etendue::compare_detail
