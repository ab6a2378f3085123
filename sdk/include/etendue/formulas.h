// The formula behind every conversion: as text that a calculator can evaluate, with its symbols, its convention and its source.
#pragma once

#include "etendue/camera.h"
#include "etendue/convert.h"

#include <span>

namespace etendue {

// quantity = factor x own, where own is the quantity that a shape emits by (light_units.h): its intensity or its luminance.
// Factors are written with + - * / ^ ( ) , pi, sin, cos, atan, atan2, hypot, of the symbols of symbols_of(); angles are radians.
struct Formula {
  std::string_view shape;    // as in a rig file: "sphere"
  std::string_view variant;  // caps of a tube, flux convention or falloff of a spot; "" where there is one alone
  Dimension quantity;
  std::string_view factor;
  std::string_view why;
  std::string_view source;
};
// One for each shape, variant and quantity that the shape knows.
std::span<const Formula> formulas();
// Null where the shape does not know the quantity.
const Formula* find_formula(const Shape& shape, const Conventions& conventions, Dimension quantity);
// "intensity" of punctual lights and lines, else "luminance".
std::string_view own_quantity_of(std::string_view shape);

struct Symbol {
  std::string name;
  double value;
  std::string_view unit;  // "m", "rad"; "" for a pure number
};

struct Explanation {
  std::string formula;  // "luminance = flux / (4*pi^2*radius^2)"
  std::vector<Symbol> symbols;
  std::vector<std::string> notes;  // why it is so, conventions, sources: one sentence each
};
// Of a conversion that convert() makes; its errors.
Result<Explanation> explain(const AnyQuantity& given, Dimension wanted, const LightSetup& setup);
// Of ev100() or, without ISO, ev_s(); their errors.
Result<Explanation> explain(const CameraSettings& camera);

// Lines for people: the formula, its symbols, its notes.
std::string to_string(const Explanation& explanation);

}  // namespace etendue
