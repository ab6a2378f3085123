// Errors of the published diffuse methods by the common protocol, and the figures that others' implementations gave by it.
#pragma once

#include "etendue/published.h"
#include "eval_protocol.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::eval::protocol {

inline constexpr std::size_t sample_count = 2000;
struct Sample {
  Placement placement;
  double exact;
};
inline const std::vector<Sample>& samples(Kind kind, bool above) {
  static std::map<std::pair<Kind, bool>, std::vector<Sample>> made;
  std::vector<Sample>& s = made[{kind, above}];
  if (s.empty()) {
    Random random(2014 + 2 * static_cast<std::uint64_t>(kind) + (above ? 1 : 0));
    for (std::size_t i = 0; i < sample_count; ++i) {
      const Placement p = place(kind, random, above);
      s.push_back({p, lux_at(p.emitter, p.position, p.normal)});
    }
  }
  return s;
}

struct Errors {
  struct Mean {
    double value, deviation;  // deviation of one sample
  };
  std::vector<double> relative, absolute;  // ascending
  double p99() const { return relative[relative.size() * 99 / 100]; }
  static Mean mean(const std::vector<double>& x) {
    double sum = 0, squares = 0;
    for (const double v : x) sum += v, squares += v * v;
    const double n = static_cast<double>(x.size()), value = sum / n;
    return {value, std::sqrt(std::max(squares / n - value * value, 0.0))};
  }
};
// Of a method that takes the shape.
inline Errors errors_of(const DiffuseMethod& method, Kind kind, bool above) {
  Errors e;
  for (const auto& [p, exact] : samples(kind, above)) {
    const double error = std::abs(method.illuminance(p.emitter, p.position, p.normal).value() - exact);
    e.absolute.push_back(error);
    e.relative.push_back(error / exact);
  }
  std::sort(e.absolute.begin(), e.absolute.end());
  std::sort(e.relative.begin(), e.relative.end());
  return e;
}

// As printed, with the half unit of its last digit.
struct Figure {
  const char* text;
  double value, half_unit;
  Figure(const char* t) : text(t), value(std::stod(t)) {  // NOLINT(google-explicit-constructor): rows of a table
    const std::string s = t;
    const std::size_t exponent = s.find('e'), point = s.find('.');
    const std::size_t decimals = point == std::string::npos ? 0 : std::min(exponent, s.size()) - point - 1;
    const int power = exponent == std::string::npos ? 0 : std::stoi(s.substr(exponent + 1));
    half_unit = 0.5 * std::pow(10.0, power - static_cast<int>(decimals));
  }
};
struct Row {
  std::string_view name;
  Kind kind;
  bool above;
  Figure relative, absolute, p99, highest;
  bool rounding = false;  // of single precision, mostly: in double ours may be any smaller
};

// 2000 configurations each, of other seeds, in single precision.
inline const std::vector<Row>& figures() {
  using enum Kind;
  static const std::vector<Row> rows{
      {"frostbite-12", rect, true, ".034", ".0079", ".22", ".42"},
      {"frostbite-12", rect, false, "1.08", ".025", "11.9", "1.6"},
      {"frostbite-12-mended", rect, true, ".034", ".0079", ".22", ".42"},
      {"frostbite-12-mended", rect, false, "1.08", ".025", "11.9", "1.6"},
      {"frostbite-e1-mended", rect, true, "3.7e-5", "1.9e-7", "7e-4", "5e-6", true},
      {"frostbite-e1-mended", rect, false, ".47", ".017", "1", ".60"},
      {"frostbite-e2", rect, true, ".195", ".0188", ".89", ".54"},
      {"frostbite-e2", rect, false, "4.1", ".124", "44", "1.9"},
      {"drobot-point", rect, true, ".150", ".0167", ".74", ".54"},
      {"drobot-point", rect, false, "1.82", ".080", "15", "1.5"},
      {"drobot-point-horizon", rect, false, ".59", ".038", "1.7", "1.2"},
      {"hill-heitz-acos", rect, true, "1.1e-6", "2e-8", "1e-5", "8e-7", true},
      {"hill-heitz-acos", rect, false, "2.4e-6", "3e-8", "2e-5", "6e-7", true},
      {"hill-heitz-rational", rect, true, "2.4e-6", "5e-8", "3e-5", "1e-6", true},
      {"hill-heitz-rational", rect, false, "8.5e-6", "9e-8", "8e-5", "1e-6", true},
      {"hill-heitz-quadratic", rect, true, ".011", "5e-4", ".12", ".008"},
      {"hill-heitz-quadratic", rect, false, ".040", "8e-4", ".42", ".010"},
      {"hill-heitz-absolute-table", rect, true, "2e-4", "5e-6", ".002", ".003"},
      {"hill-heitz-absolute-table", rect, false, ".25", ".005", "1", ".17"},
      {"hill-heitz-cheap", rect, true, ".023", ".0034", ".15", ".15"},
      {"hill-heitz-cheap", rect, false, ".43", ".024", "1.2", ".44"},
      {"frostbite-7", sphere, true, "1e-7", "3e-8", "4e-7", "8e-7", true},
      {"frostbite-7", sphere, false, "2e-6", "5e-8", "2e-5", "8e-7", true},
      {"frostbite-7-mended", sphere, true, "1e-7", "3e-8", "4e-7", "8e-7", true},
      {"frostbite-7-mended", sphere, false, "2e-6", "5e-8", "2e-5", "8e-7", true},
      {"frostbite-10", sphere, true, "6e-7", "1e-7", "3e-7", "1e-4"},
      {"frostbite-10", sphere, false, "1.4e-6", "3e-8", "2e-5", "4e-7", true},
      {"frostbite-8", disk, true, ".137", ".05", ".72", "2.6"},
      {"frostbite-8", disk, false, ".59", ".18", "6.1", "3.0"},
      {"frostbite-10", disk, true, ".138", ".054", ".73", "2.8"},
      {"frostbite-10", disk, false, ".58", ".20", "3.6", "3.0"},
      {"frostbite-13", capsule, true, ".037", ".0021", ".22", ".25"},
      {"frostbite-13", capsule, false, ".47", ".0054", "3.2", ".15"},
      {"frostbite-13-mended", capsule, true, ".037", ".0021", ".22", ".25"},
      {"frostbite-13-mended", capsule, false, ".47", ".0054", "3.2", ".15"},
  };
  return rows;
}

}  // namespace etendue::eval::protocol
