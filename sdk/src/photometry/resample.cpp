// A grid on other angles, with the largest difference that it makes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/intensity_web.h"
#include "etendue/photometric_transform.h"

namespace etendue {
namespace {

bool whole_circle(const IntensityGrid& grid) { return grid.type == WebType::c && grid.symmetry == WebSymmetry::none; }

double horizontal_end(const IntensityGrid& grid) {
  return whole_circle(grid) ? grid.horizontal_deg.front() + 360 : grid.horizontal_deg.back();
}

// The first plane once more where a full circle does not store it.
IntensityGrid closed(IntensityGrid grid) {
  if (!whole_circle(grid) || grid.horizontal_deg.back() == horizontal_end(grid)) return grid;
  grid.horizontal_deg.push_back(horizontal_end(grid));
  for (std::size_t i = 0; i < grid.vertical_deg.size(); ++i) grid.values.push_back(grid.values[i]);
  return grid;
}

std::vector<double> evenly(double first, double last, double step) {
  const auto count = static_cast<int>(std::ceil((last - first) / step - 1e-9));
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(first + i * (last - first) / count);
  angles.push_back(last);
  return angles;
}

// Values between those of a grid, which may have one plane or one angle.
class Bilinear {
 public:
  explicit Bilinear(const IntensityGrid& grid) : grid_(grid), vertical_(grid.vertical_deg), horizontal_(grid.horizontal_deg) {}
  double at(double v, double h) const {
    const AngleAxis::Place i = vertical_.place(v), j = horizontal_.place(h);
    const double near = along(j.interval, i);
    return j.position > 0 ? near + j.position * (along(j.interval + 1, i) - near) : near;
  }

 private:
  double along(std::size_t plane, const AngleAxis::Place& i) const {
    const double* const y = &grid_.values[plane * grid_.vertical_deg.size() + i.interval];
    return i.position > 0 ? y[0] + i.position * (y[1] - y[0]) : y[0];
  }
  const IntensityGrid& grid_;
  AngleAxis vertical_, horizontal_;
};

std::vector<double> together(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

Status spans(const char* what, const std::vector<double>& angles, double first, double last) {
  if (angles.empty() || angles.front() != first || angles.back() != last ||
      std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) { return !(a < b); }) != angles.end())
    return Error{"WEB_INVALID", fmt::format("expected rising {} angles from {} to {} degrees", what, first, last), {}, {}, {}};
  return Done{};
}

}  // namespace

std::vector<double> vertical_steps(const IntensityGrid& grid, double step_deg) {
  return evenly(grid.vertical_deg.front(), grid.vertical_deg.back(), step_deg);
}

std::vector<double> horizontal_steps(const IntensityGrid& grid, double step_deg) {
  if (grid.symmetry == WebSymmetry::rotational) return grid.horizontal_deg;
  return evenly(grid.horizontal_deg.front(), horizontal_end(grid), step_deg);
}

Result<ResampledGrid> resampled(const IntensityGrid& grid, const std::vector<double>& vertical_deg,
                                const std::vector<double>& horizontal_deg) {
  if (grid.vertical_deg.empty() || grid.horizontal_deg.empty() ||
      grid.values.size() != grid.vertical_deg.size() * grid.horizontal_deg.size())
    return Error{"WEB_INVALID", "expected as many values as the angles say", {}, {}, {}};
  const bool one_plane = grid.symmetry == WebSymmetry::rotational;
  if (const Status good = spans("vertical", vertical_deg, grid.vertical_deg.front(), grid.vertical_deg.back()); !good) return good.error();
  if (!one_plane)
    if (const Status good = spans("horizontal", horizontal_deg, grid.horizontal_deg.front(), horizontal_end(grid)); !good)
      return good.error();
  const IntensityGrid whole = closed(grid);
  const Bilinear before(whole);
  ResampledGrid result{{grid.type, grid.symmetry, vertical_deg, one_plane ? grid.horizontal_deg : horizontal_deg, {}}, 0};
  for (const double h : result.grid.horizontal_deg)
    for (const double v : vertical_deg) result.grid.values.push_back(before.at(v, h));
  const Bilinear after(result.grid);
  for (const double h : together(whole.horizontal_deg, result.grid.horizontal_deg))
    for (const double v : together(whole.vertical_deg, vertical_deg))
      result.error = std::max(result.error, std::abs(after.at(v, h) - before.at(v, h)));
  return result;
}

IntensityDistribution with_grid(IntensityDistribution distribution, IntensityGrid grid) {
  if (auto* record = std::get_if<EulumdatRecord>(&distribution.record)) {
    const std::vector<double>& v = grid.vertical_deg;
    const double step = v.size() > 1 ? v[1] - v[0] : 0;
    const auto uneven = std::adjacent_find(v.begin(), v.end(), [&](double a, double b) { return std::abs(b - a - step) > 1e-9; });
    record->gamma_step_deg = uneven == v.end() ? step : 0;
    record->c_deg.clear();
    if (whole_circle(grid) && grid.horizontal_deg.size() > 1 && grid.horizontal_deg.back() == horizontal_end(grid)) {
      grid.horizontal_deg.pop_back();  // EULUMDAT has no plane at 360
      grid.values.resize(grid.values.size() - v.size());
    }
  }
  distribution.grid = std::move(grid);
  return distribution;
}

}  // namespace etendue
