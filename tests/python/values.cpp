// What the C++ library says, bit for bit: "name[:setting...] argument... = result...", numbers in hexadecimal.
// tests/python/test_same_numbers.py asks the Python module for the same.
#include "etendue/camera.h"
#include "etendue/colour.h"
#include "etendue/convert.h"

#include <cstdio>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace {

using namespace etendue;

void print(std::string_view name, std::initializer_list<double> arguments, std::initializer_list<double> results) {
  std::printf("%s", std::string(name).c_str());
  for (const double x : arguments) std::printf(" %a", x);
  std::printf(" =");
  for (const double x : results) std::printf(" %a", x);
  std::printf("\n");
}

void temperatures() {
  for (double t = 501; t < 100000; t *= 1.037) {
    const Chromaticity xy = *planckian(t);
    print("planckian", {t}, {xy.x, xy.y});
    print("mired_of", {t}, {*mired_of(t)});
    print("shifted_by_mired", {t, -5}, {*shifted_by_mired(t, -5)});
    const Rgb rgb = to_rgb(xy);
    print("to_rgb", {xy.x, xy.y}, {rgb.x, rgb.y, rgb.z});
    const Chromaticity back = to_chromaticity(rgb);
    print("chromaticity_of_rgb", {rgb.x, rgb.y, rgb.z}, {back.x, back.y});
    for (const double duv : {-0.03, 0.0, 0.0123}) {
      const Chromaticity beside = *to_chromaticity(ColourTemperature{t, duv});
      print("to_chromaticity", {t, duv}, {beside.x, beside.y});
      if (const Result<ColourTemperature> found = to_colour_temperature(beside))
        print("to_colour_temperature", {beside.x, beside.y}, {found->kelvin, found->duv});
    }
    if (t > 4000 && t < 25000) {
      const Chromaticity d = *etendue::daylight(t);
      print("daylight", {t}, {d.x, d.y});
    }
  }
}

void exposures() {
  for (const Calibration& c : calibrations())
    for (double ev = -9.7; ev < 22; ev += 1.3) {
      const std::string of(c.name);
      const double l = luminance_of_ev100(ev, c);
      print("luminance_of_ev100:" + of, {ev}, {l});
      print("exposure_of_ev100:" + of, {ev}, {exposure_of_ev100(ev, c)});
      print("ev100_of_luminance:" + of, {l}, {*ev100_of_luminance(l, c)});
    }
}

// Each shape that test_same_numbers.py knows by the same name and sizes, between the SI units of what it knows.
void conversions() {
  const std::initializer_list<std::pair<const char*, Shape>> shapes = {
      {"point", PointShape{}},
      {"spot", SpotShape{*parse_si("17 deg", Dimension::angle), *parse_si("31.4 deg", Dimension::angle)}},
      {"frustum", FrustumShape{*parse_si("60 deg", Dimension::angle), *parse_si("41 deg", Dimension::angle)}},
      {"sphere", SphereShape{0.15}},
      {"disk", DiskShape{0.37}},
      {"rect", RectShape{0.6, 1.3}},
      {"tube", TubeShape{1.2, 0.013, Caps::flat}},
      {"line", LineShape{1.7}},
      {"distant", DistantShape{*parse_si("0.533 deg", Dimension::angle)}},
      {"environment", EnvironmentShape{}}};
  const std::initializer_list<std::pair<const char*, Dimension>> units = {{"lm", Dimension::luminous_flux},
                                                                          {"cd", Dimension::luminous_intensity},
                                                                          {"nit", Dimension::luminance},
                                                                          {"lx", Dimension::illuminance},
                                                                          {"EV", Dimension::exposure_value}};
  for (const auto& [name, shape] : shapes) {
    LightSetup setup;
    setup.shape = shape;
    setup.given_distance_m = setup.wanted_distance_m = 3;
    for (const auto& [from, given] : units)
      for (const auto& [to, wanted] : units) {
        const Result<Conversion> conversion = Conversion::between(given, wanted, setup);
        if (!conversion) continue;
        for (double x = 0.017; x < 20; x *= 1.9) print(std::string("convert:") + name + ":" + from + ":" + to, {x}, {*(*conversion)(x)});
      }
  }
}

void texts() {
  for (const char* text : {"1500 lm", "20 knit", "7.3 in", "47.3 deg", "137 mired", "3.7 fc", "1.1 fL", "-3.3 EV"}) {
    std::printf("quantity %s", text);
    std::printf(" = %a\n", parse_quantity(text)->si);
  }
}

}  // namespace

int main() {
  temperatures();
  exposures();
  conversions();
  texts();
}
