// Luminous intensity towards many directions at once, in float, on the best instruction set that the machine has.
#pragma once

#include "etendue/batch.h"
#include "etendue/intensity_web.h"

#include <memory>
#include <span>

namespace etendue {

// IntensityWeb::towards() and at() of the same (float) directions and angles, within 2e-6 of the web's peak and what a turn of 1e-4 degrees
// of polar angle and azimuth changes: where a table ends brightly, that much of the edge is on one side or the other. Linear interpolation
// runs in vectors; the others are evaluated one by one, in double.
class WebBatch {
 public:
  // Keeps a reference: the web must outlive it. 4 bytes a node of the table and 16 an angle beside it.
  explicit WebBatch(const IntensityWeb& web);

  // cd towards (x, y, z) of any length from 1e-6 to 1e15; others and NaN become `where_none`, and their number is returned. Errors:
  // BATCH_SIZES_DIFFER.
  BatchOutcome towards(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::span<float> cd,
                       float where_none) const;

  // The same from angles, C and gamma from -720 to 720 degrees: IntensityWeb::at() within the same bound. Webs of type C run in vectors.
  BatchOutcome at(std::span<const float> c_deg, std::span<const float> gamma_deg, std::span<float> cd, float where_none) const;

  struct Table;  // the web's, in float

 private:
  const IntensityWeb* web_;
  std::shared_ptr<const Table> table_;  // null: one by one
};

}  // namespace etendue
