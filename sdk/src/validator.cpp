#include "validator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// Far above the rounding of quaternions written with seven digits, far below anything visible.
constexpr double rigid_tolerance = 1e-6;

}  // namespace

void Validator::about(const char* kind, std::size_t index, const std::string& name, const std::string& source) {
  subject_ = name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} \"{}\"", kind, name);
  source_ = source;
}

Where Validator::where() const { return {scene_.file, 0, 0, source_}; }
void Validator::error(const char* code, const std::string& text) { diagnostics_.error(code, subject_ + ": " + text, where()); }
void Validator::warning(const char* code, const std::string& text) { diagnostics_.warning(code, subject_ + ": " + text, where()); }
void Validator::append(const Error& error) {
  Diagnostic diagnostic = to_diagnostic(error);
  diagnostic.where = where();
  diagnostics_.add(std::move(diagnostic));
}

bool Validator::finite(const char* what, const Transform& t) {
  for (const Vec3d& v : {t.columns[0], t.columns[1], t.columns[2], t.translation}) {
    if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
    error("NUMBER_INVALID", fmt::format("expected a {} of finite numbers, found {} {} {}", what, v.x, v.y, v.z));
    return false;
  }
  return true;
}

bool Validator::rigid(const Transform& t) {
  if (!finite("transform", t)) return false;
  double off = std::fabs(t.determinant() - 1);
  for (int i = 0; i < 3; ++i) {
    off = std::max(off, std::fabs(dot(t.columns[i], t.columns[i]) - 1));
    off = std::max(off, std::fabs(dot(t.columns[i], t.columns[(i + 1) % 3])));
  }
  if (off <= rigid_tolerance) return true;
  error("TRANSFORM_NOT_RIGID", fmt::format("expected a rotation and a translation, found scaling, shear or mirroring of {:.3g}", off));
  return false;
}

bool Validator::between(const char* what, double value, double low, double high) {
  if (value >= low && value <= high) return true;
  error("VALUE_OUT_OF_RANGE", fmt::format("expected {} between {} and {}, found {}", what, low, high, value));
  return false;
}

bool Validator::above(const char* what, double value, double low) {
  if (value > low && std::isfinite(value)) return true;
  error("VALUE_OUT_OF_RANGE", fmt::format("expected a finite {} greater than {}, found {}", what, low, value));
  return false;
}

bool Validator::colour(const char* what, const Rgb& c, double high) {
  const auto in_range = [high](double x) { return x >= 0 && x <= high && std::isfinite(x); };
  if (in_range(c.x) && in_range(c.y) && in_range(c.z)) return true;
  error("VALUE_OUT_OF_RANGE", fmt::format("expected {} between 0 and {} in each channel, found {} {} {}", what, high, c.x, c.y, c.z));
  return false;
}

bool Validator::index(const char* what, std::uint32_t value, std::size_t count) {
  if (value < count) return true;
  error("INDEX_OUT_OF_RANGE", fmt::format("expected {} below {}, found {}", what, count, value));
  return false;
}

bool Validator::texture(const char* what, const Texture& texture) {
  bool well = index(what, texture.image, scene_.images.size());
  for (const auto& row : texture.uv_transform)
    for (const double number : row)
      if (!std::isfinite(number)) {
        error("NUMBER_INVALID", fmt::format("expected a finite uv transform of {}", what));
        return false;
      }
  return well;
}

}  // namespace etendue
