// Numbers one after the other, whatever separates them.
#pragma once

#include "importers/photometry/scanner.h"

#include <span>

namespace etendue::photometric {

// LM-63 separates by commas too; EULUMDAT may write them for decimal points.
enum class Comma { separates, decimal };

class NumberReader {
 public:
  NumberReader(const char* p, const char* end, Comma comma) : p_(p), end_(end), comma_(comma) {}

  // Fills all of `out`. False: number failed_at() is missing or none; token() is where it should stand.
  bool read(std::span<double> out);
  bool read(double& one) { return read(std::span(&one, 1)); }

  std::size_t failed_at() const { return failed_at_; }
  const char* token() const { return token_; }  // of the last number, or of what is none
  const char* position() const { return p_; }
  const char* end() const { return end_; }
  void move_to(const char* p) { p_ = p; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - p_); }
  bool comma_was_decimal() const { return comma_was_decimal_; }

  void skip_separators();
  bool at_end() const { return p_ == end_; }
  // Whether a line ends between here and the next number.
  bool line_ends_here() const;
  // Why read() failed: FILE_TRUNCATED, NUMBER_EXPECTED or NUMBER_RANGE.
  Error failure(const Reporter& reporter, const std::string& expected) const;

 private:
  bool separates(char c) const;
  bool read_with_comma(double& value);

  const char* p_;
  const char* end_;
  const char* token_ = nullptr;
  Comma comma_;
  std::size_t failed_at_ = 0;
  bool comma_was_decimal_ = false;
};

}  // namespace etendue::photometric
