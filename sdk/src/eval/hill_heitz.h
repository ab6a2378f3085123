// The first table of linearly transformed cosines, which Hill and Heitz tell the faults of.
#pragma once

#include "etendue/ltc.h"

namespace etendue::eval {

// 64 x 64 nodes over sqrt(alpha) and the angle of the view, each the inverse matrix in the frame of the normal divided by its last term, so
// that four are left to read between the nodes. They are those of ltc_table().
TransformedCosine four_term_cosine(double alpha, double cosine);

}  // namespace etendue::eval
