// What a difference looks like: the hypotheses that explain it.
#pragma once

#include "evidence.h"
#include "regions.h"

#include <string>
#include <vector>

namespace etendue::compare_detail {

// For the pictures as wholes (evidence of light ""); `threshold_z` as in Comparison. Only to be asked where a difference is significant.
std::vector<Finding> find_causes(const Evidence& evidence, const Picture& ours, const Picture& reference, double threshold_z,
                                 double max_difference);

// For a single light's layers.
std::vector<Finding> find_light_cause(const Evidence& evidence, const std::string& light, double threshold_z, double max_difference);

// The region that differs most, for what no hypothesis explains.
Finding worst_region(const std::vector<RegionDifference>& regions, double pixel_excess_rel);

}  // namespace etendue::compare_detail
