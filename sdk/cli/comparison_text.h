// A comparison in a reader's words and as JSON; shared by `compare` and `validate`.
#pragma once

#include <string>

#include "etendue/compare.h"
#include "session.h"

namespace etendue::cli {

Json to_json(const Comparison& comparison);
std::string table_of(const Comparison& comparison);  // the verdict, the worst regions, what was found
int exit_status_of(Verdict verdict);

// "0.2%" or "0.002" -> 0.002. Error USAGE.
Result<double> parse_fraction(const std::string& text);

}  // namespace etendue::cli
