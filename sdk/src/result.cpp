#include "etendue/result.h"

#include <algorithm>

namespace etendue {
namespace {

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::note:
      return "note";
    case Severity::warning:
      return "warning";
    case Severity::error:
      break;
  }
  return "error";
}

}  // namespace

std::string to_string(const Where& where) {
  std::string text = where.file;
  if (where.line > 0) {
    text += (text.empty() ? "line " : ":") + std::to_string(where.line);
    if (where.column > 0) text += ":" + std::to_string(where.column);
  } else if (where.offset >= 0) {
    text += (text.empty() ? "(byte " : " (byte ") + std::to_string(where.offset) + ")";
  }
  return text;
}

std::string to_string(const Diagnostic& diagnostic) {
  std::string text = to_string(diagnostic.where);
  if (!text.empty()) text += ": ";
  text += name_of(diagnostic.severity);
  text += ": " + diagnostic.text;
  if (!diagnostic.code.empty()) text += " [" + diagnostic.code + "]";
  if (!diagnostic.where.pointer.empty()) text += "\n  at " + diagnostic.where.pointer;
  if (!diagnostic.hint.empty()) text += "\n  hint: " + diagnostic.hint;
  return text;
}

Diagnostic to_diagnostic(const Error& error) { return {Severity::error, error.code, error.text, error.where, error.hint}; }

void Diagnostics::note(std::string code, std::string text, Where where) {
  add({Severity::note, std::move(code), std::move(text), std::move(where), {}});
}
void Diagnostics::warning(std::string code, std::string text, Where where) {
  add({Severity::warning, std::move(code), std::move(text), std::move(where), {}});
}
void Diagnostics::error(std::string code, std::string text, Where where) {
  add({Severity::error, std::move(code), std::move(text), std::move(where), {}});
}
void Diagnostics::append(const Diagnostics& other) { all_.insert(all_.end(), other.all_.begin(), other.all_.end()); }
bool Diagnostics::has_errors() const {
  return std::any_of(all_.begin(), all_.end(), [](const Diagnostic& d) { return d.severity == Severity::error; });
}

}  // namespace etendue
