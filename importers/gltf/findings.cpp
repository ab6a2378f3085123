#include "findings.h"

#include <fmt/format.h>

namespace etendue::gltf {

std::string pointer_to(const std::string& parent, std::string_view key) {
  std::string pointer = parent + "/";
  for (const char c : key) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

std::string Path::text() const {
  if (parent == nullptr) return {};
  return name.data() == nullptr ? parent->text() + "/" + std::to_string(index) : pointer_to(parent->text(), name);
}

void Findings::add(Severity severity, const char* code, std::string text, const Path& path) {
  if (!is_full(severity)) all_.push_back({severity, code, std::move(text), {"", 0, 0, path.text()}, {}});
}

void Findings::add_at(Severity severity, const char* code, std::string text, std::string pointer) {
  if (!is_full(severity)) all_.push_back({severity, code, std::move(text), {"", 0, 0, std::move(pointer)}, {}});
}

void Findings::error(Error error, const Path& path) {
  if (is_full(Severity::error)) return;
  error.where.pointer = path.text();
  all_.push_back(to_diagnostic(error));
}

Error limit_exceeded(const std::string& what, const char* option, std::uint64_t limit) {
  return {"LIMIT_EXCEEDED",
          fmt::format("{} is over the limit {} = {}", what, option, limit),
          {},
          fmt::format("--limit {0}=NUMBER, or ImportOptions::{0}, sets another", option),
          {}};
}

}  // namespace etendue::gltf
