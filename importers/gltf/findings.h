// What the checks of a document find: messages whose place is a JSON pointer. The asset knows its line, and may ask for less.
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

// A place in a document while it is walked: the way back to the root. It becomes text where something is found.
struct Path {
  const Path* parent = nullptr;
  std::string_view name;  // of a member; null data: an element of an array
  std::size_t index = 0;

  Path operator/(std::string_view key) const { return {this, key, 0}; }
  Path operator/(std::size_t element) const { return {this, {}, element}; }
  std::string text() const;  // RFC 6901
};

// Appends a token to a JSON pointer, escaped as RFC 6901 wants it.
std::string pointer_to(const std::string& parent, std::string_view key);

// Beyond this many of a severity the rest is counted, not listed.
constexpr std::size_t max_findings = 1000;

class Findings {
 public:
  void error(const char* code, std::string text, const Path& path) { add(Severity::error, code, std::move(text), path); }
  void error(Error error, const Path& path);
  void warning(const char* code, std::string text, const Path& path) { add(Severity::warning, code, std::move(text), path); }
  void note(const char* code, std::string text, const Path& path) { add(Severity::note, code, std::move(text), path); }
  void note_at(const char* code, std::string text, std::string pointer) {
    add_at(Severity::note, code, std::move(text), std::move(pointer));
  }

  std::vector<Diagnostic> take() { return std::move(all_); }
  bool has_errors() const { return counts_[static_cast<int>(Severity::error)] > 0; }

 private:
  void add(Severity severity, const char* code, std::string text, const Path& path);
  void add_at(Severity severity, const char* code, std::string text, std::string pointer);
  bool is_full(Severity severity) { return ++counts_[static_cast<int>(severity)] > max_findings; }

  std::vector<Diagnostic> all_;
  std::size_t counts_[3] = {};
};

// The error LIMIT_EXCEEDED, somewhere: `what` is over a limit of ImportOptions, which its text and its hint name.
Error limit_exceeded(const std::string& what, const char* option, std::uint64_t limit);

}  // namespace etendue::gltf
