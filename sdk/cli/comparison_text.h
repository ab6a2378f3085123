// A comparison in a reader's words and as JSON; shared by `compare` and `validate`.
#pragma once

#include <string>
#include <vector>

#include "etendue/compare.h"
#include "session.h"

namespace etendue::cli {

Json to_json(const Comparison& comparison);
std::string table_of(const Comparison& comparison);  // the verdict, the worst regions, what was found
int exit_status_of(Verdict verdict);

// One line for each effect, naming what shares it: "materials 'a', 'b' and 12 more: ...".
std::vector<std::string> grouped(const std::vector<Loss>& losses);

// "0.2%" or "0.002" -> 0.002. Error USAGE.
Result<double> parse_fraction(const std::string& text);

}  // namespace etendue::cli
