// What one unit of a program's amount is in ours. Shapes are in metres here.
#pragma once

#include "etendue/dialect.h"

namespace etendue {

// Which of our quantities a shape's amount becomes: cd on the axis, cd/m2, lx on a plane facing it, cd across a line.
Emission::Given natural_quantity(const Shape& shape);

// The natural quantity for an amount of 1 (of "EV": for 1 cd/m2), radiometric for Blender.
Result<double> natural_per_amount(Dialect dialect, const StatedLight& stated_in_metres);

// Light that is flux / pi / area: area of what emits, in m2.
Result<double> area_of_stated(const Shape& shape);

// Exposure values count as luminances, and USD's exposure is a factor.
double linear_amount(const StatedLight& stated);
double stated_amount(double linear, const DialectForm& form);

// 1 but for USD, where it must be given, and Unreal.
Result<double> metres_per_unit(Dialect dialect, const Shape& shape, const DialectForm& form);
Shape scaled_shape(const Shape& shape, double factor);

// The unit asked for, or the usual one.
Result<std::string> unit_of(Dialect dialect, const Shape& shape, std::string_view asked_for);

// What a program does that our lights do not, or the other way round, whatever the amount.
void add_differences(Dialect dialect, const Light& light, LossReport& losses);

}  // namespace etendue
