#include "asset.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "container.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

using Json = nlohmann::json;

// tinygltf may ask these for files: there are none, and no path is expanded.
template <class Callbacks>
Callbacks no_files() {
  Callbacks callbacks{};
  callbacks.FileExists = [](const std::string&, void*) { return false; };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; };
  // Since tinygltf 2.9, which refuses callbacks without it.
  if constexpr (requires { callbacks.GetFileSizeInBytes; })
    callbacks.GetFileSizeInBytes = [](std::size_t*, std::string*, const std::string&, void*) { return false; };
  return callbacks;
}
bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) { return true; }

constexpr std::size_t max_json_bytes = std::size_t{1} << 29;

// What the schema asks of an object by the value of its "type".
void check_conditional(const Json& objects, const std::string& pointer, const char* type, const char* needed, Asset& asset) {
  if (!objects.is_array()) return;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Json& object = objects[i];
    if (object.is_object() && object.contains("type") && object["type"] == type && !object.contains(needed))
      asset.error("UNDEFINED_PROPERTY", fmt::format("expected the property \"{}\" of the type \"{}\", which is missing", needed, type),
                  pointer + "/" + std::to_string(i));
  }
}

std::vector<std::string> tokens_of(const std::string& pointer) {
  std::vector<std::string> tokens;
  for (Json::json_pointer rest(pointer); !rest.empty(); rest.pop_back()) tokens.push_back(rest.back());
  std::reverse(tokens.begin(), tokens.end());
  return tokens;
}

}  // namespace

Asset::~Asset() = default;

Result<std::unique_ptr<Asset>> Asset::open(const std::filesystem::path& file, const ImportOptions& options) {
  std::unique_ptr<Asset> asset(new Asset);
  asset->file_ = file;
  asset->folder_ = file.parent_path();
  asset->options_ = options;
  auto bytes = read_file(file, options.max_bytes);
  if (!bytes) return bytes.error();
  asset->bytes_ = std::move(*bytes);
  asset->stats.bytes_read += asset->bytes_.size();

  auto container = open_container(asset->bytes_);
  if (!container) {
    container.error().where.file = file.string();
    return container.error();
  }
  asset->binary_ = container->binary;
  if (auto parsed = asset->parse(container->json, !is_glb(asset->bytes_)); !parsed) return parsed.error();
  if (auto version = asset->check_version(); !version) return version.error();

  SchemaFindings findings = check_schema(*asset->json_, options.max_items);
  for (Diagnostic& diagnostic : findings.diagnostics) {
    diagnostic.where = asset->at(diagnostic.where.pointer);
    asset->add(std::move(diagnostic));
  }
  asset->extensions_ = std::move(findings.extensions);
  asset->load_model();
  return asset;
}

Status Asset::parse(std::string_view text, bool is_text_file) {
  if (text.size() > max_json_bytes)
    return failure("LIMIT_EXCEEDED", fmt::format("{} bytes of JSON are over the limit of {}", text.size(), max_json_bytes), "");
  JsonLimits limits;
  limits.max_depth = options_.max_depth;
  auto document = JsonDocument::parse(text, file_.string(), limits);
  if (!document) {
    if (!is_text_file) document.error().where = {file_.string(), 0, 0, document.error().where.pointer};
    return document.error();
  }
  for (const JsonValue& duplicate : document->duplicate_keys())
    add({Severity::error,
         "DUPLICATE_PROPERTY",
         fmt::format("the member \"{}\" stands here a second time", duplicate.key()),
         is_text_file ? duplicate.where_key() : Where{file_.string(), 0, 0, duplicate.pointer()},
         {}});
  if (is_text_file) text_ = std::move(*document);
  try {
    json_ = std::make_unique<Json>(Json::parse(text.begin(), text.end()));
  } catch (const Json::exception& e) {
    return failure("INVALID_JSON", e.what(), "");
  }
  if (!json_->is_object()) return failure("TYPE_MISMATCH", "expected a JSON object at the root", "");
  return Done{};
}

Status Asset::check_version() const {
  const auto asset = json_->find("asset");
  if (asset == json_->end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
    return failure("UNDEFINED_PROPERTY", "expected asset.version, as every glTF has it", "/asset");
  for (const char* key : {"version", "minVersion"}) {
    if (!asset->contains(key) || !(*asset)[key].is_string()) continue;
    const auto version = (*asset)[key].get<std::string>();
    const bool minimum = std::strcmp(key, "minVersion") == 0;
    if (minimum ? version != "2.0" : !version.starts_with("2."))
      return failure(minimum ? "UNKNOWN_ASSET_MINOR_VERSION" : "UNKNOWN_ASSET_MAJOR_VERSION",
                     fmt::format("expected {}, found \"{}\"", minimum ? "\"2.0\"" : "version 2.x", version), pointer_to("/asset", key));
  }
  return Done{};
}

void Asset::load_model() {
  const Json& root = *json_;
  if (root.contains("cameras")) {
    check_conditional(root["cameras"], "/cameras", "perspective", "perspective", *this);
    check_conditional(root["cameras"], "/cameras", "orthographic", "orthographic", *this);
  }
  const Json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (root.contains(lights)) check_conditional(root.at(lights), lights.to_string(), "spot", "spot", *this);

  Json structure = root;
  for (const char* bytes : {"buffers", "images", "extensions", "animations", "skins", "extras"}) structure.erase(bytes);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(no_files<tinygltf::FsCallbacks>());
  loader.SetImageLoader(ignore_image, nullptr);
  std::string problems, remarks;
  bool loaded = false;
  try {
    const std::string text = structure.dump();
    loaded =
        loader.LoadASCIIFromString(&model_, &problems, &remarks, text.data(), static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE);
  } catch (const std::exception& e) {
    problems = e.what();
  }
  if (loaded) return;
  while (!problems.empty() && problems.back() == '\n') problems.pop_back();
  model_ = {};
  error("INVALID_GLTF", "the document cannot be read: " + problems, "");
}

const Json* Asset::extension(const std::string& pointer, const char* name) const {
  const Json::json_pointer place(pointer + "/extensions/" + name);
  return json_->contains(place) && json_->at(place).is_object() ? &json_->at(place) : nullptr;
}

// The place of the value, or of the nearest one around it where something is missing.
Where Asset::at(const std::string& pointer) const {
  Where where{file_.string(), 0, 0, pointer};
  if (!text_) return where;
  JsonValue value = text_->root();
  for (const std::string& token : tokens_of(pointer)) {
    const JsonValue next = value.is(JsonKind::array) ? value.element(std::strtoull(token.c_str(), nullptr, 10)) : value.find(token);
    if (!next) break;
    value = next;
  }
  const Where found = value.where();
  where.line = found.line;
  where.column = found.column;
  return where;
}

Error Asset::failure(std::string code, std::string text, const std::string& pointer) const {
  return {std::move(code), std::move(text), at(pointer), {}, {}};
}

void Asset::add(Diagnostic diagnostic) {
  std::size_t& count = diagnostic.severity == Severity::error ? errors_ : others_;
  if (++count > max_findings + 1) return;
  if (count == max_findings + 1)
    diagnostic = {diagnostic.severity, "TOO_MANY_ISSUES", "there is more of this kind, which is not listed", {}, {}};
  diagnostics_.add(std::move(diagnostic));
}

void Asset::error(std::string code, std::string text, const std::string& pointer) {
  add({Severity::error, std::move(code), std::move(text), at(pointer), {}});
}
void Asset::error(const Error& error) { add(to_diagnostic(error)); }
void Asset::warning(std::string code, std::string text, const std::string& pointer) {
  add({Severity::warning, std::move(code), std::move(text), at(pointer), {}});
}
void Asset::note(std::string code, std::string text, const std::string& pointer) {
  add({Severity::note, std::move(code), std::move(text), at(pointer), {}});
}

Result<std::span<const std::byte>> Asset::view(int index) {
  const std::string pointer = fmt::format("/bufferViews/{}", index);
  if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size())
    return failure("UNRESOLVED_REFERENCE", fmt::format("there is no bufferView {}", index), pointer);
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  auto bytes = buffer(view.buffer);
  if (!bytes) return bytes.error();
  if (view.byteOffset > bytes->size() || view.byteLength > bytes->size() - view.byteOffset)
    return failure("BUFFER_VIEW_TOO_LONG",
                   fmt::format("{} bytes from byte {} on go beyond buffer {} of {} bytes", view.byteLength, view.byteOffset, view.buffer,
                               bytes->size()),
                   pointer);
  return bytes->subspan(view.byteOffset, view.byteLength);
}

Result<std::span<const std::byte>> Asset::buffer(int index) {
  if (const auto found = loaded_.find(index); found != loaded_.end()) return std::span<const std::byte>(found->second);
  const std::string pointer = fmt::format("/buffers/{}", index);
  const Json::json_pointer place(pointer);
  if (index < 0 || !json_->contains(place) || !json_->at(place).is_object())
    return failure("UNRESOLVED_REFERENCE", fmt::format("there is no buffer {}", index), pointer);
  const Json& buffer = json_->at(place);
  const double authored_length = number_or(buffer, "byteLength", 0);
  if (!(authored_length >= 1 && authored_length <= static_cast<double>(options_.max_bytes)))
    return failure("LIMIT_EXCEEDED", fmt::format("byteLength {} is outside 1 to {}", authored_length, options_.max_bytes), pointer);
  const auto byte_length = static_cast<std::uint64_t>(authored_length);

  if (!buffer.contains("uri")) {
    if (index != 0 || !binary_)
      return failure("BUFFER_MISSING_GLB_DATA", "a buffer without uri stands for the binary chunk of a GLB, and there is none", pointer);
    if (binary_->size() < byte_length)
      return failure("BUFFER_GLB_CHUNK_TOO_SMALL",
                     fmt::format("expected {} bytes in the binary chunk, found {}", byte_length, binary_->size()), pointer);
    return binary_->first(byte_length);
  }
  const Json& uri = buffer["uri"];
  auto bytes = load_buffer(uri.is_string() ? uri.get<std::string>() : std::string(), byte_length, pointer);
  if (!bytes) return bytes.error();
  return std::span<const std::byte>(loaded_.emplace(index, std::move(*bytes)).first->second);
}

Result<std::vector<std::byte>> Asset::load_buffer(const std::string& uri, std::uint64_t byte_length, const std::string& pointer) {
  std::vector<std::byte> bytes;
  if (is_data_uri(uri)) {
    auto data = decode_data_uri(uri, options_.max_bytes);
    if (!data) return failure(data.error().code, data.error().text, pointer + "/uri");
    bytes.resize(data->bytes.size());
    if (!bytes.empty()) std::memcpy(bytes.data(), data->bytes.data(), bytes.size());
  } else {
    auto path = file_inside(folder_, uri);
    if (!path) return failure(path.error().code, path.error().text, pointer + "/uri");
    auto content = read_file(*path, options_.max_bytes);
    if (!content) return failure(content.error().code, content.error().text, pointer + "/uri");
    bytes = std::move(*content);
    stats.bytes_read += bytes.size();
  }
  if (bytes.size() < byte_length)
    return failure("BUFFER_BYTE_LENGTH_MISMATCH", fmt::format("expected {} bytes, found {}", byte_length, bytes.size()), pointer);
  bytes.resize(byte_length);
  return bytes;
}

double number_or(const Json& object, const char* key, double otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : otherwise;
}

double number_or(const Json& object, const char* key, std::size_t element, double otherwise) {
  const auto found = object.find(key);
  const bool there = found != object.end() && found->is_array() && element < found->size() && (*found)[element].is_number();
  return there ? (*found)[element].get<double>() : otherwise;
}

std::string text_or(const Json& object, const char* key, std::string otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::move(otherwise);
}

}  // namespace etendue::gltf
