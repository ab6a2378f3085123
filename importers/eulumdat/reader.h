// One pass over an EULUMDAT file.
#pragma once

#include "importers/photometry/numbers.h"

namespace etendue::eulumdat {

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, const PhotometricOptions& options, Diagnostics& diagnostics);

  // Everything into the distribution; false: error() says why not.
  bool read(IntensityDistribution& out);
  const Error& error() const { return error_; }

 private:
  // What the first lines say of the table.
  struct Table {
    int symmetry = 0;
    std::size_t planes = 0, gammas = 0;  // Mc, Ng
    std::size_t first = 0, stored = 0;   // planes that are stored, from the first one on
  };

  // header.cpp
  bool read_header(EulumdatRecord& record, Table& table);
  bool read_counts(EulumdatRecord& record, Table& table);
  bool read_luminaire(EulumdatRecord& record);
  bool read_lamp_sets(EulumdatRecord& record);
  bool read_lamp_set(LampSet& set);
  bool read_direct_ratios(EulumdatRecord& record);
  bool find_stored_planes(Table& table, const char* place);

  // table.cpp
  bool read_table(const EulumdatRecord& record, const Table& table, IntensityDistribution& out, std::vector<double>& c_deg);
  bool read_numbers(std::span<double> out, const char* what);
  bool judge_angles(const std::vector<double>& angles, double highest, const char* what, const char* begin);
  bool judge_steps(const EulumdatRecord& record, const std::vector<double>& c_deg, const std::vector<double>& gamma_deg, const char* place);
  bool choose_planes(const Table& table, const std::vector<double>& c_deg, IntensityGrid& grid, const char* place);
  bool judge_values(IntensityGrid& grid, double factor, const char* begin);
  bool review_tail();

  // The next line as text, or as a number; blank lines are 0 where that says nothing of the light.
  enum class Blank { refused, zero };
  bool text_line(std::string& out, const char* what);
  bool number_line(double& out, const char* what, Blank blank = Blank::refused);
  bool count_line(std::size_t& out, const char* what, std::size_t least, std::size_t most);
  bool note_comma();

  bool fail(Error error);
  bool fail(const char* code, std::string text, const char* p, std::string hint);
  bool repair(const char* code, std::string text, const char* p, std::string hint = {});

  std::string_view text_;
  std::string file_;
  const PhotometricOptions& options_;
  photometric::Reporter reporter_;
  photometric::NumberReader numbers_;
  Error error_;
  const char* field_ = nullptr;  // the line that was read last
  bool comma_reported_ = false;
};

}  // namespace etendue::eulumdat
