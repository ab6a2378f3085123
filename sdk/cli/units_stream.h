// Rows of quantities, converted one by one at the pace of reading and printing them.
#pragma once

#include <cstdio>
#include <map>

#include "etendue/unit_names.h"
#include "units.h"

namespace etendue::cli {

// CSV: "1200,lm" (or "1200 lm", "15 klx @ 2 m") in, "value,unit,error" out. JSON lines: {"value": 1200, "unit": "lm"} or a text such as
// "15 klx @ 2 m" in; {"value": .., "unit": ".."} or {"error": {"code": .., "text": ..}} out.
class RowConverter {
 public:
  RowConverter(Target target, LightSetup setup, const UnitsOptions& options);

  // One line, without its end; appends one.
  void csv(std::string_view line, std::string& out);
  void json(std::string_view line, std::string& out);

  std::size_t rows = 0, refused = 0;

 private:
  // The value in the target's unit, by the shortest way; nothing where the long way has to be gone.
  std::optional<double> quickly(double value, std::string_view unit);
  const Conversion* conversion_from(std::string_view spelling);
  Result<Answer> slowly(std::string_view text, Diagnostics& told) const;

  Target target_;
  LightSetup setup_;
  const UnitsOptions& options_;
  std::string csv_tail_, json_tail_;                                   // behind a value: its unit, which has a few letters
  std::map<const NamedUnit*, std::optional<Conversion>> conversions_;  // made when a unit is first met; nothing where it has none
  std::string last_spelling_;
  const Conversion* last_ = nullptr;  // of that spelling
};

// All of `in` to `out`, whole blocks at a time. Errors: LINE_TOO_LONG (1 MiB), FILE_UNREADABLE, FILE_UNWRITABLE, CANCELLED.
Status convert_rows(RowConverter& rows, bool json_lines, std::FILE* in, std::FILE* out);

}  // namespace etendue::cli
