// The verdict in plain words.
#pragma once

#include "etendue/compare.h"

#include <string>
#include <vector>

namespace etendue::report_detail {

struct Words {
  std::string headline;
  std::vector<std::string> lines;
};
Words in_words(const Comparison& comparison);

}  // namespace etendue::report_detail
