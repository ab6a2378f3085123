// What can go wrong, and where: Result<T>, Error and Diagnostics.
// No function of the SDK throws across its interface, prints, or aborts: it returns one of these.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

// A place in an input. Lines and columns count from 1, columns in bytes; 0 means unknown. Binary files have an offset instead.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  std::string pointer;       // RFC 6901 JSON pointer; of an error about a parameter of a call, its name: "/radius"; else ""
  std::int64_t offset = -1;  // in bytes from the beginning of the file; -1: unknown
};

// "file:line:column" or "file (byte offset)", shortened to what is known.
std::string to_string(const Where& where);

enum class Severity { note, warning, error };

// One message about one place. `code` is a stable upper-case name (Khronos' validator's where it has one).
struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;
  std::string text;  // what was expected, what was found
  Where where;
  std::string hint;  // what to do about it, if there is something
};

// "file:line:column: error: text [CODE]" and the pointer and hint, if any, on lines of their own.
std::string to_string(const Diagnostic& diagnostic);

// Why a call gave no result. `notes` lead the reader from the symptom to the cause.
struct Error {
  std::string code;
  std::string text;
  Where where;
  std::string hint;
  std::vector<Diagnostic> notes;
};

Diagnostic to_diagnostic(const Error& error);

// Messages in the order in which they were met.
class Diagnostics {
 public:
  void add(Diagnostic diagnostic) { all_.push_back(std::move(diagnostic)); }
  void note(std::string code, std::string text, Where where = {});
  void warning(std::string code, std::string text, Where where = {});
  void error(std::string code, std::string text, Where where = {});
  void append(const Diagnostics& other);

  const std::vector<Diagnostic>& all() const { return all_; }
  bool has_errors() const;

 private:
  std::vector<Diagnostic> all_;
};

// A value or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  // Only if ok().
  T& value() { return *std::get_if<0>(&state_); }
  const T& value() const { return *std::get_if<0>(&state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  // Only if not ok().
  Error& error() { return *std::get_if<1>(&state_); }
  const Error& error() const { return *std::get_if<1>(&state_); }

 private:
  std::variant<T, Error> state_;
};

// Done, or the reason why not.
struct Done {};
using Status = Result<Done>;

}  // namespace etendue
