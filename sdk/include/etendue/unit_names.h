// Units by how they are written: "klx", "cd/m2", "mired".
#pragma once

#include "etendue/units.h"

#include <span>

namespace etendue {

// What one unit is in SI: times / over, two factors, so that decimal submultiples are divisions and round once. A reciprocal unit (mired)
// is times / x.
struct NamedUnit {
  Dimension dimension{};
  double times = 1, over = 1;
  bool reciprocal = false;

  double to_si(double x) const { return reciprocal ? times / x : x * times / over; }
  double from_si(double si) const { return reciprocal ? times / si : si * over / times; }
  friend bool operator==(const NamedUnit&, const NamedUnit&) = default;
};

// "lm", "klm", "nit"; case counts. UNIT_UNKNOWN, with the nearest spellings in its hint.
Result<NamedUnit> unit_named(std::string_view spelling);
// The same without the words: null where there is none. Some 5 ns.
const NamedUnit* find_unit(std::string_view spelling);

// Every unit once, for lists: its symbol, the SI prefixes that it takes (a letter each), what it is called, what it measures.
struct UnitSpelling {
  std::string_view symbol, prefixes, name;
  NamedUnit unit;
};
std::span<const UnitSpelling> unit_spellings();

}  // namespace etendue
