#include "reader.h"

namespace etendue::ies {

Reader::Reader(std::string_view text, const std::string& file, const PhotometricOptions& options, Diagnostics& diagnostics)
    : text_(text),
      file_(file),
      options_(options),
      reporter_(text, file, options.mode == PhotometricMode::strict, diagnostics),
      numbers_(text.data(), text.data() + text.size(), photometric::Comma::separates) {}

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

// A new record begins on a new line.
bool Reader::begin_record() {
  const char* const here = numbers_.position();
  const bool at_line_start = here == text_.data() || photometric::is_eol(here[-1]);
  if (shared_line_reported_ || at_line_start || numbers_.line_ends_here()) return true;
  shared_line_reported_ = true;
  numbers_.skip_separators();
  return repair("RECORD_SHARES_LINE", "expected a new record to begin on a new line; read by the counts", numbers_.position());
}

bool Reader::read(IntensityDistribution& out) {
  IesRecord record;
  std::string_view tilt;
  Counts counts;
  if (!read_version(record) || !read_labels(record, tilt) || !require_keywords(record) || !read_tilt(record, tilt)) return false;
  if (!read_first_record(record, out.grid, counts) || !read_second_record(record)) return false;
  if (options_.mode != PhotometricMode::header_only) {
    const std::size_t longest = record.version <= IesVersion::lm_63_1995   ? 132
                                : record.version == IesVersion::lm_63_2002 ? 254
                                                                           : text_.size();
    if (!photometric::review_lines(reporter_, text_, longest)) return fail(reporter_.failure());
    if (!begin_record() || !read_angles(out.grid.vertical_deg, counts.verticals, "vertical")) return false;
    if (!judge_vertical(out.grid, numbers_.token())) return false;
    if (!begin_record() || !read_angles(out.grid.horizontal_deg, counts.horizontals, "horizontal")) return false;
    if (!judge_horizontal(out.grid, record.version, numbers_.token())) return false;
    if (!read_values(out.grid, record) || !review_tail()) return false;
  }
  out.file = file_;
  out.record = std::move(record);
  return true;
}

}  // namespace etendue::ies
