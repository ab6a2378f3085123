#include "reader.h"

#include <fmt/format.h>

namespace etendue::eulumdat {

Reader::Reader(std::string_view text, const std::string& file, const PhotometricOptions& options, Diagnostics& diagnostics)
    : text_(text),
      file_(file),
      options_(options),
      reporter_(text, file, options.mode == PhotometricMode::strict, diagnostics),
      numbers_(text.data(), text.data() + text.size(), photometric::Comma::decimal) {}

bool Reader::fail(Error error) {
  error_ = std::move(error);
  return false;
}
bool Reader::fail(const char* code, std::string text, const char* p, std::string hint) {
  return fail(reporter_.error(code, std::move(text), p, std::move(hint)));
}
bool Reader::repair(const char* code, std::string text, const char* p, std::string hint) {
  return reporter_.repair(code, std::move(text), p, std::move(hint)) || fail(reporter_.failure());
}

bool Reader::text_line(std::string& out, const char* what) {
  const char* p = numbers_.position();
  if (p == numbers_.end())
    return fail("FILE_TRUNCATED", fmt::format("expected {}, found the end of the file", what), p,
                "the file is incomplete, or is no EULUMDAT file");
  field_ = p;
  out = photometric::to_utf8(photometric::trimmed(photometric::take_line(p, numbers_.end())));
  numbers_.move_to(p);
  return true;
}

bool Reader::number_line(double& out, const char* what, Blank blank) {
  const char* p = numbers_.position();
  if (p == numbers_.end())
    return fail("FILE_TRUNCATED", fmt::format("expected {}, found the end of the file", what), p,
                "the file is incomplete, or is no EULUMDAT file");
  field_ = p;
  const std::string_view line = photometric::trimmed(photometric::take_line(p, numbers_.end()));
  numbers_.move_to(p);
  if (line.empty() && blank == Blank::zero) {
    out = 0;
    return repair("FIELD_BLANK", fmt::format("expected {}, found a blank line; read as 0", what), field_);
  }
  photometric::NumberReader one(line.data(), line.data() + line.size(), photometric::Comma::decimal);
  if (!one.read(out) || !one.at_end())
    return fail("NUMBER_EXPECTED", fmt::format("expected {}, found \"{}\"", what, photometric::to_utf8(line.substr(0, 40))), field_,
                "EULUMDAT has one field a line: a line before may be missing or too many");
  return !one.comma_was_decimal() || note_comma();
}

bool Reader::note_comma() {
  if (comma_reported_) return true;
  comma_reported_ = true;
  return repair("DECIMAL_COMMA", "decimal commas were read as points", field_);
}

bool Reader::count_line(std::size_t& out, const char* what, std::size_t least, std::size_t most) {
  double number = 0;
  if (!number_line(number, what)) return false;
  if (!(number >= static_cast<double>(least) && number <= static_cast<double>(most)) ||
      number != static_cast<double>(static_cast<std::size_t>(number)))
    return fail("COUNT_INVALID", fmt::format("expected {} as a whole number from {} to {}, found {}", what, least, most, number), field_,
                "a line before may be missing or too many");
  out = static_cast<std::size_t>(number);
  return true;
}

bool Reader::read(IntensityDistribution& out) {
  EulumdatRecord record;
  Table table;
  if (!read_header(record, table)) return false;
  if (options_.mode != PhotometricMode::header_only) {
    if (!photometric::review_lines(reporter_, text_, text_.size())) return fail(reporter_.failure());
    std::vector<double> c_deg;
    if (!read_table(record, table, out, c_deg)) return false;
    record.c_deg = std::move(c_deg);
  }
  out.file = file_;
  out.lamp_set = options_.lamp_set;
  out.record = std::move(record);
  return true;
}

}  // namespace etendue::eulumdat
