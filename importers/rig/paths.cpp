#include "reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace etendue::rig {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_path = 4096;

std::string lower_extension(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// Formats of floating-point pixels are linear, all others hold sRGB-encoded bytes.
Encoding usual_encoding(const std::string& file) {
  const std::string extension = lower_extension(file);
  const bool linear = extension == ".exr" || extension == ".hdr" || extension == ".pfm";
  return linear ? Encoding::linear : Encoding::srgb;
}

// Why a name is refused before the disk is asked, or nullptr.
const char* refusal(const std::string& name) {
  if (name.empty()) return "a file name that is not empty";
  if (name.size() > longest_path) return "a file name of at most 4096 bytes";
  if (name.find('\\') != std::string::npos) return "a file name with / between its folders";
  if (name.find(':') != std::string::npos) return "a file name, no URI and no drive";
  const fs::path path(name);
  if (path.is_absolute() || path.has_root_path()) return "a file name relative to the rig's folder";
  if (std::find(path.begin(), path.end(), fs::path("..")) != path.end()) return "a file name without \"..\"";
  return nullptr;
}

// Whether `file` is inside `folder` once links are followed.
bool is_inside(const fs::path& folder, const fs::path& file) {
  std::error_code ignored;
  const fs::path real_folder = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, ignored);
  const fs::path real_file = fs::weakly_canonical(file, ignored);
  const auto [in_folder, in_file] = std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end());
  return in_folder == real_folder.end() && in_file != real_file.end();
}

std::optional<std::uint32_t> image_of(Reader& reader, JsonValue value) {
  const std::optional<fs::path> path = read_path(reader, value, has(reader.options.need, Need::images));
  if (!path) return {};
  const std::string file = path->generic_string();
  std::vector<ImageRef>& images = reader.scene.images;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (images[i].file == file) return static_cast<std::uint32_t>(i);
  images.push_back({file, {}, "", std::string(value.string())});
  return static_cast<std::uint32_t>(images.size() - 1);
}

void read_wrap(Reader& reader, JsonValue value, Texture& texture) {
  if (!value) return;
  const Choices<Wrap> wraps = {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}};
  const bool pair = value.is(JsonKind::array) && value.size() == 2;
  const JsonValue u = pair ? value.element(0) : value;
  const JsonValue v = pair ? value.element(1) : value;
  texture.wrap_u = read_choice(u, wraps, reader.diagnostics).value_or(Wrap::repeat);
  texture.wrap_v = pair ? read_choice(v, wraps, reader.diagnostics).value_or(Wrap::repeat) : texture.wrap_u;
}

void read_uv_transform(Reader& reader, JsonValue value, Texture& texture) {
  constexpr double unlimited = std::numeric_limits<double>::max();
  const std::optional<std::vector<double>> n = read_numbers(value, 6, -unlimited, unlimited, reader.diagnostics);
  for (std::size_t i = 0; n && i < 6; ++i) texture.uv_transform[i / 3][i % 3] = (*n)[i];
}

}  // namespace

std::optional<fs::path> read_path(Reader& reader, JsonValue value, bool must_exist) {
  const std::optional<std::string> name = read_string(value, reader.diagnostics);
  if (!name) return {};
  if (const char* expected = refusal(*name)) {
    fail(reader.diagnostics, value, "PATH_REFUSED", fmt::format("expected {}, found \"{}\"", expected, name->substr(0, 200)));
    return {};
  }
  const fs::path file = reader.folder / *name;
  if (!is_inside(reader.folder, file)) {
    fail(reader.diagnostics, value, "PATH_REFUSED",
         fmt::format("expected a file inside the rig's folder; a link leads \"{}\" out of it", *name));
    return {};
  }
  std::error_code ignored;
  if (must_exist && !fs::is_regular_file(file, ignored)) {
    fail(reader.diagnostics, value, "FILE_MISSING", fmt::format("expected a file beside the rig, found none named \"{}\"", *name));
    return {};
  }
  return file;
}

std::optional<std::uint32_t> read_image(Reader& reader, JsonValue file) { return image_of(reader, file); }

std::optional<Texture> read_texture(Reader& reader, JsonValue value) {
  if (!value) return {};
  Texture texture;
  JsonValue file = value;
  if (!value.is(JsonKind::string)) {
    Fields fields(value, reader.diagnostics);
    file = fields.require("file");
    const JsonValue encoding = fields.find("encoding");
    texture.encoding = read_choice<Encoding>(encoding, {{"linear", Encoding::linear}, {"srgb", Encoding::srgb}}, reader.diagnostics)
                           .value_or(usual_encoding(std::string(file.string())));
    read_wrap(reader, fields.find("wrap"), texture);
    texture.nearest = read_boolean(fields.find("nearest"), reader.diagnostics).value_or(false);
    read_uv_transform(reader, fields.find("uv_transform"), texture);
    texture.uv_set = static_cast<int>(read_number(fields.find("uv_set"), 0, 255, reader.diagnostics).value_or(0));
    fields.finish();
  } else {
    texture.encoding = usual_encoding(std::string(file.string()));
  }
  const std::optional<std::uint32_t> image = image_of(reader, file);
  if (!image) return {};
  texture.image = *image;
  return texture;
}

std::optional<std::uint32_t> read_reference(Reader& reader, JsonValue value, const std::vector<std::string>& names, std::string_view what) {
  if (!value) return {};
  if (value.is(JsonKind::number)) {
    if (value.is_integer() && value.number() >= 0 && value.number() < static_cast<double>(names.size())) {
      return static_cast<std::uint32_t>(value.number());
    }
    fail(reader.diagnostics, value, "REFERENCE_UNKNOWN",
         fmt::format("expected the position of one of {} {}s, found {}", names.size(), what, value.number()));
    return {};
  }
  const std::optional<std::string> name = read_string(value, reader.diagnostics);
  if (!name) return {};
  const auto first = std::find(names.begin(), names.end(), *name);
  if (first == names.end() || name->empty()) {
    const std::vector<std::string_view> known(names.begin(), names.end());
    fail(reader.diagnostics, value, "REFERENCE_UNKNOWN", fmt::format("expected the name of a {}, found \"{}\"", what, name->substr(0, 200)),
         nearest_hint(*name, known));
    return {};
  }
  if (std::find(first + 1, names.end(), *name) != names.end()) {
    fail(reader.diagnostics, value, "REFERENCE_AMBIGUOUS",
         fmt::format("expected the name of one {}, found several named \"{}\"", what, *name),
         "give its position, a number from 0, or make the names differ");
    return {};
  }
  return static_cast<std::uint32_t>(first - names.begin());
}

}  // namespace etendue::rig
