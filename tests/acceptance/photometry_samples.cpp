// Chi-square of the directions that are drawn from webs: closed forms of each type, smooth, narrow and with zeros, and every photometric
// file that standard input names, a line each; each with all interpolants. Prints a line of JSON for each: for the script `photometry`.
//
//     photometry_samples SAMPLES < FILES
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "etendue/web_sampler.h"
#include "importers/eulumdat/eulumdat.h"
#include "importers/ies/ies.h"
#include "photometry_builder.h"

namespace {

using namespace etendue;

// Where a direction falls on the whole sphere of its web's own angles: the polar angle from the web's pole (0 to 180 deg) and the azimuth
// about it (-180 to 180 deg).
struct OwnPlace {
  double polar_deg, azimuth_deg;
};
OwnPlace place_of(const IntensityWeb& web, const Vec3d& direction) {
  const WebAngles own = angles_of(web.type(), direction, web.frame());
  if (web.type() == WebType::b) return {own.horizontal_deg + 90, own.vertical_deg};
  if (web.type() == WebType::a) return {own.vertical_deg + 90, own.horizontal_deg};
  return {own.vertical_deg, own.horizontal_deg > 180 ? own.horizontal_deg - 360 : own.horizontal_deg};
}
double candelas_at(const IntensityWeb& web, const OwnPlace& p) {
  if (web.type() == WebType::b) return web.at_own_angles({p.azimuth_deg, p.polar_deg - 90});
  if (web.type() == WebType::a) return web.at_own_angles({p.polar_deg - 90, p.azimuth_deg});
  return web.at_own_angles({p.polar_deg, p.azimuth_deg});
}

void sort_and_thin(std::vector<double>& x) {
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return b - a < 1e-9; }), x.end());
}

// Borders of pieces in which the web is smooth: its nodes, wherever a symmetry may mirror them to, and equal parts between them.
std::vector<double> pieces_of(const std::vector<double>& nodes, double from, double to, std::size_t wanted) {
  std::vector<double> borders{from, to};
  for (const double x : nodes)
    for (const double image : {x, -x, 180 - x, x - 180, 360 - x, x - 360})
      if (image > from && image < to) borders.push_back(image);
  sort_and_thin(borders);
  const std::size_t parts = std::clamp<std::size_t>(wanted / borders.size(), 1, 16);
  std::vector<double> finer;
  for (std::size_t i = 0; i + 1 < borders.size(); ++i)
    for (std::size_t k = 0; k < parts; ++k)
      finer.push_back(borders[i] + (borders[i + 1] - borders[i]) * static_cast<double>(k) / static_cast<double>(parts));
  finer.push_back(to);
  return finer;
}

// The flux of the pieces i, i + 1 of the polar angle between pieces j, j + 1 of the azimuth: linear in the azimuth, so its middle is exact;
// along the polar angle Gauss's rule of four points, which is exact to rounding over the few degrees of a piece.
double flux_of_piece(const IntensityWeb& web, double from_deg, double to_deg, double azimuth_from_deg, double azimuth_to_deg) {
  constexpr double x[] = {0.33998104358485626, 0.86113631159405258}, weight[] = {0.65214515486254614, 0.34785484513745386};
  const double middle = 0.5 * (from_deg + to_deg), half = 0.5 * (to_deg - from_deg), azimuth = 0.5 * (azimuth_from_deg + azimuth_to_deg);
  double sum = 0;
  for (int k = 0; k < 2; ++k)
    for (const double polar : {middle - half * x[k], middle + half * x[k]})
      sum += weight[k] * candelas_at(web, {polar, azimuth}) * std::sin(polar * pi / 180);
  return sum * half * (azimuth_to_deg - azimuth_from_deg) * (pi / 180) * (pi / 180);
}

// Bins of about equal flux: slabs of the polar angle, each cut along the azimuth as its own flux wants it.
struct Bins {
  std::vector<double> slab_ends;                 // upper ends
  std::vector<std::vector<double>> sector_ends;  // of each slab
  std::vector<std::size_t> first;                // bin of each slab
  std::vector<double> flux;                      // of each bin
  double total = 0;

  std::size_t bin_of(const OwnPlace& p) const {
    const auto index = [](const std::vector<double>& ends, double x) {
      return std::min(static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), x) - ends.begin()), ends.size() - 1);
    };
    const std::size_t slab = index(slab_ends, p.polar_deg);
    return first[slab] + index(sector_ends[slab], p.azimuth_deg);
  }
};

Bins bins_of(const IntensityWeb& web) {
  constexpr double slabs = 40, sectors = 25;
  const std::vector<double> polar = pieces_of(web.polar().nodes(), 0, 180, 600), azimuth = pieces_of(web.azimuth().nodes(), -180, 180, 200);
  const std::size_t rows = polar.size() - 1, columns = azimuth.size() - 1;
  std::vector<double> flux(rows * columns), of_row(rows);
  Bins bins;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j)
      of_row[i] += flux[i * columns + j] = flux_of_piece(web, polar[i], polar[i + 1], azimuth[j], azimuth[j + 1]);
    bins.total += of_row[i];
  }
  double in_slab = 0;
  std::vector<double> of_column(columns);
  for (std::size_t i = 0; i < rows; ++i) {
    in_slab += of_row[i];
    for (std::size_t j = 0; j < columns; ++j) of_column[j] += flux[i * columns + j];
    if (in_slab < bins.total / slabs && i + 1 < rows) continue;
    bins.slab_ends.push_back(polar[i + 1]);
    bins.first.push_back(bins.flux.size());
    std::vector<double>& ends = bins.sector_ends.emplace_back();
    double in_sector = 0;
    for (std::size_t j = 0; j < columns; ++j) {
      in_sector += of_column[j];
      if (in_sector < in_slab / sectors && j + 1 < columns) continue;
      ends.push_back(azimuth[j + 1]);
      bins.flux.push_back(in_sector);
      in_sector = 0;
    }
    std::fill(of_column.begin(), of_column.end(), 0.0);
    in_slab = 0;
  }
  return bins;
}

nlohmann::json tested(const std::string& name, const IntensityWeb& web, int samples) {
  const Bins bins = bins_of(web);
  std::vector<double> found(bins.flux.size());
  const WebSampler sampler(web);
  static std::uint64_t seed = 0;
  std::mt19937_64 random(++seed);  // its own: tests are independent
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  // Of f / pdf over the flux, with f as the sampler states it and as the web is evaluated in the direction: both have no variance.
  double stated_off = 0, sum_of_squares = 0;
  int in_the_dark = 0;
  std::vector<Vec2d> u(4096);
  std::vector<WebSampler::Sample> drawn(u.size());
  for (int left = samples; left > 0; left -= static_cast<int>(u.size())) {
    for (Vec2d& v : u) {
      v.x = uniform();
      v.y = uniform();
    }
    if (!sampler.sample(u, drawn)) std::abort();
    for (const WebSampler::Sample& s : std::span(drawn).first(static_cast<std::size_t>(std::min(left, static_cast<int>(u.size()))))) {
      const double off = web.towards(s.direction) / s.pdf / web.flux_lm() - 1;
      in_the_dark += s.pdf > 0 ? 0 : 1;
      stated_off = std::max(stated_off, std::abs(s.cd / s.pdf / web.flux_lm() - 1));
      sum_of_squares += off * off;
      ++found[bins.bin_of(place_of(web, s.direction))];
    }
  }
  // Bins that expect too few to be normal are one.
  double statistic = 0, rest = 0, rest_found = 0;
  int freedom = -1;
  const auto add = [&](double expected, double count) {
    statistic += (count - expected) * (count - expected) / expected;
    ++freedom;
  };
  for (std::size_t b = 0; b < bins.flux.size(); ++b) {
    const double expected = bins.flux[b] / bins.total * samples;
    if (expected >= 20) {
      add(expected, found[b]);
    } else {
      rest += expected;
      rest_found += found[b];
    }
  }
  if (rest >= 1) add(rest, rest_found);
  constexpr const char* names[] = {"linear", "cosine", "cubic"};
  return {{"web", name},
          {"type", std::string(name_of(web.type()))},
          {"interpolation", names[static_cast<int>(web.interpolation())]},
          {"statistic", statistic},
          {"freedom", freedom},
          {"in_the_dark", in_the_dark + (rest < 1 ? rest_found > 20 : 0)},
          {"flux_of_bins", std::abs(bins.total / web.flux_lm() - 1)},
          {"stated_off", stated_off},
          {"deviation", std::sqrt(sum_of_squares / samples)}};
}

void test_all(const std::string& name, const IntensityDistribution& distribution, int samples) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cosine, Interpolation::cubic}) {
    const Result<IntensityWeb> web = IntensityWeb::of(distribution, interpolation);
    if (web && web->flux_lm() > 0) std::cout << tested(name, *web, samples).dump() << std::endl;
  }
}

double smooth(const Vec3d& u) { return 1000 + 300 * u.x - 200 * u.y * u.z - 400 * u.z + 100 * u.x * u.x; }
// Half its peak 3 degrees from the axis one way and 5 degrees the other, 1e-20 of it at 25 degrees.
double narrow(const Vec3d& u) {
  const double x = u.x / std::sin(3 * pi / 180), y = u.y / std::sin(5 * pi / 180);
  return u.z < 0 ? 1e5 * std::pow(0.5, x * x + y * y) : 0;
}
double with_zeros(const Vec3d& u) { return std::max(0.0, 500 * std::sin(7 * u.x) * std::sin(5 * u.y) - 300 * u.z); }

void test_closed_forms(int samples) {
  using test::steps;
  const std::vector<double> gamma = steps(0, 180, 2.5), around = steps(-90, 90, 2.5), half = steps(0, 90, 2.5);
  const std::vector<double> beam{0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9, 10, 12, 14, 17, 20, 25, 90};
  std::vector<double> beam_both_ways(beam.rbegin(), beam.rend() - 1);
  for (double& x : beam_both_ways) x = -x;
  beam_both_ways.insert(beam_both_ways.end(), beam.begin(), beam.end());
  const auto of = [&](WebType type, WebSymmetry symmetry, const std::vector<double>& v, const std::vector<double>& h, const auto& form) {
    return test::distribution_of(type, symmetry, v, h, form);
  };
  test_all("smooth", of(WebType::c, WebSymmetry::none, gamma, steps(0, 345, 15), smooth), samples);
  test_all("narrow", of(WebType::c, WebSymmetry::quadrant, beam, steps(0, 90, 7.5), narrow), samples);
  test_all("with zeros", of(WebType::c, WebSymmetry::none, gamma, steps(0, 355, 5), with_zeros), samples);
  for (const WebType type : {WebType::a, WebType::b}) {
    test_all("smooth", of(type, WebSymmetry::none, around, around, smooth), samples);
    test_all("narrow", of(type, WebSymmetry::none, beam_both_ways, beam_both_ways, narrow), samples);
    test_all("with zeros", of(type, WebSymmetry::lateral_and_vertical, half, half, with_zeros), samples);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int samples = argc > 1 ? std::atoi(argv[1]) : 10'000'000;
  test_closed_forms(samples);
  for (std::string name; std::getline(std::cin, name);) {
    const Result<std::vector<std::byte>> bytes = read_file(name, std::size_t{1} << 30);
    if (!bytes) continue;
    const Result<PhotometricFile> file = name.ends_with(".ldt") ? read_eulumdat(*bytes, name) : read_ies(*bytes, name);
    if (file) test_all(name, file->distribution, samples);
  }
}
