// One pass over an LM-63 file: the record's parts in the order in which they stand.
#pragma once

#include "importers/photometry/numbers.h"

#include <array>
#include <optional>

namespace etendue::ies {

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const PhotometricOptions& options, Diagnostics& diagnostics);

  // Everything into the distribution; false: error() says why not.
  bool read(IntensityDistribution& out);
  const Error& error() const { return error_; }

 private:
  // labels.cpp: the version, the keywords, TILT
  bool read_version(IesRecord& record);
  bool read_labels(IesRecord& record, std::string_view& tilt);
  bool read_label(IesRecord& record, std::string_view line);
  bool read_tilt(IesRecord& record, std::string_view tilt);
  bool read_tilt_records(photometric::NumberReader& numbers, const photometric::Reporter& reporter, LampTilt& tilt);
  bool read_tilt_file(LampTilt& tilt, std::string_view place);
  bool require_keywords(const IesRecord& record);

  // numbers.cpp: the two records of numbers
  struct Counts {
    std::size_t verticals = 0, horizontals = 0;
  };
  bool read_first_record(IesRecord& record, IntensityGrid& grid, Counts& counts);
  bool read_second_record(IesRecord& record);
  bool review_factors(const IesRecord& record, const char* third);

  // grid.cpp: angles and candelas
  bool read_angles(std::vector<double>& angles, std::size_t count, const char* kind);
  bool judge_vertical(const IntensityGrid& grid, const char* place);
  bool judge_horizontal(IntensityGrid& grid, IesVersion version, const char* place);
  bool judge_horizontal_c(IntensityGrid& grid, IesVersion version, const char* place);
  bool read_values(IntensityGrid& grid, const IesRecord& record);
  bool judge_negative(IntensityGrid& grid, const char* begin);
  bool review_tail();

  bool begin_record();
  bool fail(Error error);
  bool fail(const char* code, std::string text, const char* p, std::string hint);
  bool repair(const char* code, std::string text, const char* p, std::string hint = {});

  std::string_view text_;
  std::string file_;
  const PhotometricOptions& options_;
  photometric::Reporter reporter_;
  photometric::NumberReader numbers_;
  Error error_;
  bool shared_line_reported_ = false;
  const char* second_line_ = nullptr;  // where the header's rest begins if it shares the version's line
};

}  // namespace etendue::ies
