// Colours of temperatures, temperatures of colours, sRGB: ours and the peers' formulas, each with its error against the double functions.
#include "peers.h"
#include "units_rows.h"

#include "etendue/batch.h"
#include "etendue/srgb.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue::bench {
namespace {

// What the contenders read and write; they refer to it as long as the program lives.
struct Buffers {
  std::vector<float> kelvin, x, y, encoded, a, b, c;
  std::vector<Vec2f> xy;
  std::vector<Vec3f> rgb;
  std::vector<Chromaticity> exact_xy;
  std::vector<ColourTemperature> temperature;
};
Buffers& buffers() {
  static Buffers all = [] {
    Buffers made;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const double part = static_cast<double>(i) / batch_size;
      made.kelvin.push_back(static_cast<float>(1700 * std::pow(14.5, part)));
      made.exact_xy.push_back(*to_chromaticity(ColourTemperature{made.kelvin.back(), 0.02 * std::sin(97 * part)}));
      made.x.push_back(static_cast<float>(made.exact_xy.back().x));
      made.y.push_back(static_cast<float>(made.exact_xy.back().y));
      made.xy.push_back({made.x.back(), made.y.back()});
      made.encoded.push_back(static_cast<float>(part));
    }
    for (std::vector<float>* out : {&made.a, &made.b, &made.c}) out->resize(batch_size);
    made.rgb.resize(batch_size);
    made.temperature.resize(batch_size);
    return made;
  }();
  return all;
}

// Temperatures of a domain in equal ratios.
std::vector<float> ratios(double low, double high, std::size_t count = 1000) {
  std::vector<float> all;
  for (std::size_t i = 0; i < count; ++i)
    all.push_back(static_cast<float>(low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1))));
  all.back() = static_cast<float>(high);
  return all;
}

using XyPeer = void (*)(const float*, float*, float*, std::size_t);
using RgbPeer = void (*)(const float*, float*, float*, float*, std::size_t);
using TemperaturePeer = void (*)(const float*, const float*, float*, std::size_t);

std::string error_of_xy(XyPeer peer, double low, double high) {
  const std::vector<float> kelvin = ratios(low, high);
  std::vector<float> x(kelvin.size()), y(kelvin.size());
  peer(kelvin.data(), x.data(), y.data(), kelvin.size());
  double worst = 0;
  for (std::size_t i = 0; i < kelvin.size(); ++i) worst = std::max(worst, difference_uv1976({x[i], y[i]}, *planckian(kelvin[i])));
  return fmt::format("{:.1e} in (u', v'), {} K to {} K", worst, low, high);
}
std::string error_of_rgb(RgbPeer peer, double low, double high, bool encoded) {
  const std::vector<float> kelvin = ratios(low, high);
  std::vector<float> r(kelvin.size()), g(kelvin.size()), b(kelvin.size());
  peer(kelvin.data(), r.data(), g.data(), b.data(), kelvin.size());
  double worst = 0;
  for (std::size_t i = 0; i < kelvin.size(); ++i) {
    Rgb made{r[i], g[i], b[i]};
    if (encoded) made = {srgb_to_linear(made.x / 255), srgb_to_linear(made.y / 255), srgb_to_linear(made.z / 255)};
    worst = std::max(worst, difference_uv1976(to_chromaticity(made), *planckian(kelvin[i])));
  }
  return fmt::format("{:.1e} in (u', v'), {} K to {} K", worst, low, high);
}
void ours_xy(const float* kelvin, float* x, float* y, std::size_t count) {
  std::vector<Vec2f> xy(count);
  (void)planckian({kelvin, count}, xy, {});
  for (std::size_t i = 0; i < count; ++i) x[i] = xy[i].x, y[i] = xy[i].y;
}
void ours_rgb(const float* kelvin, float* r, float* g, float* b, std::size_t count) {
  std::vector<Vec3f> rgb(count);
  (void)planckian_rgb({kelvin, count}, rgb, {});
  for (std::size_t i = 0; i < count; ++i) r[i] = rgb[i].x, g[i] = rgb[i].y, b[i] = rgb[i].z;
}
void ours_temperature(const float* x, const float* y, float* kelvin, std::size_t count) {
  std::vector<Vec2f> xy(count);
  for (std::size_t i = 0; i < count; ++i) xy[i] = {x[i], y[i]};
  (void)fit_colour_temperature(xy, {kelvin, count}, 0);
}

// Largest errors over three regions; where a peer answers nothing below its own domain, its answer counts.
struct Region {
  double low, high, duv;
};
constexpr Region regions[] = {{2000, 12500, 0}, {1667, 25000, 0.02}, {1000, 40000, 0.02}};
template <class Temperature>
std::string error_over_regions(Temperature temperature) {
  std::string text;
  for (const Region& region : regions) {
    double worst = 0;
    for (const float kelvin : ratios(region.low, region.high, 200))
      for (int step = -4; step <= 4; ++step) {
        const Chromaticity xy = *to_chromaticity(ColourTemperature{kelvin, region.duv * step / 4});
        worst = std::max(worst, std::abs(temperature(xy) - kelvin));
      }
    text += fmt::format("{}{:.2g} K", text.empty() ? "" : ", ", worst);
  }
  return text + " (2000-12500 K on the locus; 1667-25000 K, 1000-40000 K within Duv .02)";
}
std::string error_of_temperature(TemperaturePeer peer) {
  return error_over_regions([peer](const Chromaticity& c) {
    const float x = static_cast<float>(c.x), y = static_cast<float>(c.y);
    float kelvin = 0;
    peer(&x, &y, &kelvin, 1);
    return static_cast<double>(kelvin);
  });
}

void add_xy(Bench& bench) {
  Buffers& b = buffers();
  Task& task = bench.task("blackbody to xy", batch_size);
  add_bare_multiply(task, b.kelvin, b.a);
  task.contender("etendue planckian()", Kind::ours, error_of_xy(ours_xy, 800, 100000), [&b] {
    static std::vector<Vec2f> out(batch_size);
    (void)planckian(b.kelvin, out, {});
    keep(out.data());
  });
  const auto peer = [&](const char* name, XyPeer run, double low, double high, const char* note) {
    task.contender(
        name, Kind::peer, error_of_xy(run, low, high),
        [&b, run] {
          run(b.kelvin.data(), b.a.data(), b.b.data(), batch_size);
          keep(b.a.data());
        },
        note);
  };
  peer("Krystek 1985", krystek_xy, 1000, 15000, "a rougher mode of ours would save less than .02 ns");
  peer("Kang 2002", kang_xy, 1667, 25000, "");
}

void add_rgb(Bench& bench) {
  Buffers& b = buffers();
  Task& task = bench.task("blackbody to linear RGB", batch_size);
  add_bare_multiply(task, b.kelvin, b.a);
  task.contender("etendue planckian_rgb()", Kind::ours, error_of_rgb(ours_rgb, 800, 100000, false), [&b] {
    (void)planckian_rgb(b.kelvin, b.rgb, {});
    keep(b.rgb.data());
  });
  const auto peer = [&](const char* name, RgbPeer run, double low, double high, bool encoded) {
    task.contender(name, Kind::peer, error_of_rgb(run, low, high, encoded), [&b, run] {
      run(b.kelvin.data(), b.a.data(), b.b.data(), b.c.data(), batch_size);
      keep(b.a.data());
    });
  };
  peer("Krystek 1985, as Filament and Godot", krystek_rgb, 1000, 15000, false);
  peer("Kang 2002, as MaterialX", kang_rgb, 1667, 25000, false);
  peer("Helland 2012 (its sRGB, not yet linear)", helland_srgb, 1000, 40000, true);
}

void add_temperature(Bench& bench) {
  Buffers& b = buffers();
  Task& task = bench.task("xy to temperature, CCT", batch_size);
  add_bare_multiply(task, b.x, b.a);
  const std::string exact = error_over_regions([](const Chromaticity& xy) {
    ColourTemperature found;
    (void)to_colour_temperature({&xy, 1}, {&found, 1}, {});
    return found.kelvin;
  });
  task.contender("etendue to_colour_temperature(), with Duv", Kind::ours, exact, [&b] {
    (void)to_colour_temperature(b.exact_xy, b.temperature, {});
    keep(b.temperature.data());
  });
  task.contender("etendue fit_colour_temperature()", Kind::ours, error_of_temperature(ours_temperature), [&b] {
    (void)fit_colour_temperature(b.xy, b.a, 0);
    keep(b.a.data());
  });
  const auto peer = [&](const char* name, TemperaturePeer run, const char* note) {
    task.contender(
        name, Kind::peer, error_of_temperature(run),
        [&b, run] {
          run(b.x.data(), b.y.data(), b.a.data(), batch_size);
          keep(b.a.data());
        },
        note);
  };
  peer("McCamy 1992", mccamy,
       "nobody needs it: beside the locus it is thousands of kelvin off and answers outside its domain; a picture of 8 million pixels "
       "takes 2 ms more with ours");
  peer("Hernandez-Andres 1999", hernandez_andres, "answered by fit_colour_temperature()");
  peer("Robertson 1968", robertson, "");
}

void add_srgb(Bench& bench) {
  Buffers& b = buffers();
  using Transfer = void (*)(const float*, float*, std::size_t);
  const auto error_of = [&b](Transfer run, double (*exact)(double)) {
    run(b.encoded.data(), b.a.data(), batch_size);
    double worst = 0;
    for (std::size_t i = 0; i < batch_size; ++i) worst = std::max(worst, std::abs(b.a[i] - exact(b.encoded[i])));
    return fmt::format("{:.1e} from 0 to 1", worst);
  };
  const auto add = [&](const char* name, Transfer ours, Transfer library, double (*exact)(double)) {
    Task& task = bench.task(name, batch_size);
    add_bare_multiply(task, b.encoded, b.a);
    for (const auto& [who, kind, run] : {std::tuple{"etendue", Kind::ours, ours}, {"C library's power, vectorised", Kind::peer, library}})
      task.contender(who, kind, error_of(run, exact), [&b, run = run] {
        run(b.encoded.data(), b.a.data(), batch_size);
        keep(b.a.data());
      });
  };
  add(
      "sRGB to linear", [](const float* in, float* out, std::size_t n) { (void)srgb_to_linear(std::span(in, n), std::span(out, n)); },
      library_srgb_to_linear, [](double v) { return srgb_to_linear(v); });
  add(
      "linear to sRGB", [](const float* in, float* out, std::size_t n) { (void)linear_to_srgb(std::span(in, n), std::span(out, n)); },
      library_linear_to_srgb, [](double v) { return linear_to_srgb(v); });
}

}  // namespace

void colour_rows(Bench& bench) {
  add_xy(bench);
  add_rgb(bench);
  add_temperature(bench);
  add_srgb(bench);
}

}  // namespace etendue::bench
