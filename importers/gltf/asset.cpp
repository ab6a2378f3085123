#include "asset.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "container.h"
#include "mapped_file.h"
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

// A GLB's header and those of its two chunks.
constexpr std::size_t glb_overhead = 12 + 8 + 8;

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
  const auto bytes = map_file(file, options.max_bytes);
  if (!bytes) return bytes.error();
  auto container = open_container(bytes->bytes());
  if (!container) {
    container.error().where.file = file.string();
    return container.error();
  }
  const auto part = [&](const void* first, std::size_t size) {
    return bytes->part(static_cast<std::size_t>(static_cast<const std::uint8_t*>(first) - bytes->data()), size);
  };
  asset->document_ = part(container->json.data(), container->json.size());
  if (container->binary) asset->binary_ = part(container->binary->data(), container->binary->size());
  const bool glb = is_glb(bytes->bytes());
  asset->stats.bytes_read = asset->document_.size() + (glb ? glb_overhead : 0);
  will_read_all(asset->document_);
  if (auto parsed = asset->parse(container->json, !glb); !parsed) return parsed.error();
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

  // What tinygltf is to make its model of: the other members are read from the document, or have bytes behind them.
  std::string text = "{";
  for (const char* key :
       {"asset", "accessors", "bufferViews", "cameras", "materials", "meshes", "nodes", "samplers", "scene", "scenes", "textures"}) {
    const auto member = root.find(key);
    if (member != root.end()) text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", key, member->dump());
  }
  text += '}';
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(no_files<tinygltf::FsCallbacks>());
  loader.SetImageLoader(ignore_image, nullptr);
  std::string problems, remarks;
  bool loaded = false;
  try {
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

Result<SharedBytes> Asset::view(int index) {
  if (const auto found = views_.find(index); found != views_.end()) return found->second;
  const std::string pointer = fmt::format("/bufferViews/{}", index);
  if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size())
    return failure("UNRESOLVED_REFERENCE", fmt::format("there is no bufferView {}", index), pointer);
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  auto bytes = part_of_buffer(view.buffer, view.byteOffset, view.byteLength, pointer);
  if (bytes) views_.emplace(index, *bytes);
  return bytes;
}

Result<SharedBytes> Asset::part_of_buffer(int index, std::size_t offset, std::size_t length, const std::string& pointer) {
  const auto bytes = buffer(index);
  if (!bytes) return bytes.error();
  if (offset > bytes->size() || length > bytes->size() - offset)
    return failure("BUFFER_VIEW_TOO_LONG",
                   fmt::format("{} bytes from byte {} on go beyond buffer {} of {} bytes", length, offset, index, bytes->size()), pointer);
  const SharedBytes part = bytes->part(offset, length);
  will_read_all(part);
  buffer_bytes_read_ += length;
  if (!is_data_uri(text_or((*json_)["buffers"][static_cast<std::size_t>(index)], "uri", ""))) stats.bytes_read += length;
  return part;
}

Result<SharedBytes> Asset::buffer(int index) {
  if (const auto found = buffers_.find(index); found != buffers_.end()) return found->second;
  const std::string pointer = fmt::format("/buffers/{}", index);
  const Json::json_pointer place(pointer);
  if (index < 0 || !json_->contains(place) || !json_->at(place).is_object())
    return failure("UNRESOLVED_REFERENCE", fmt::format("there is no buffer {}", index), pointer);
  auto bytes = open_buffer(json_->at(place), index == 0, pointer);
  if (bytes) buffers_.emplace(index, *bytes);
  return bytes;
}

Result<SharedBytes> Asset::open_buffer(const Json& buffer, bool first, const std::string& pointer) {
  const double authored_length = number_or(buffer, "byteLength", 0);
  if (!(authored_length >= 1 && authored_length <= static_cast<double>(options_.max_bytes)))
    return failure("LIMIT_EXCEEDED", fmt::format("byteLength {} is outside 1 to {}", authored_length, options_.max_bytes), pointer);
  const auto byte_length = static_cast<std::uint64_t>(authored_length);

  if (!buffer.contains("uri")) {
    if (!first || !binary_)
      return failure("BUFFER_MISSING_GLB_DATA", "a buffer without uri stands for the binary chunk of a GLB, and there is none", pointer);
    if (binary_.size() < byte_length)
      return failure("BUFFER_GLB_CHUNK_TOO_SMALL",
                     fmt::format("expected {} bytes in the binary chunk, found {}", byte_length, binary_.size()), pointer);
    return binary_.part(0, byte_length);
  }
  const std::string uri = text_or(buffer, "uri", "");
  SharedBytes bytes;
  if (is_data_uri(uri)) {
    auto data = decode_data_uri(uri, options_.max_bytes);
    if (!data) return failure(data.error().code, data.error().text, pointer + "/uri");
    bytes = SharedBytes(std::move(data->bytes));
  } else {
    const auto path = file_inside(folder_, uri);
    if (!path) return failure(path.error().code, path.error().text, pointer + "/uri");
    auto mapped = map_file(*path, options_.max_bytes);
    if (!mapped) return mapped.error();
    bytes = std::move(*mapped);
  }
  if (bytes.size() < byte_length)
    return failure("BUFFER_BYTE_LENGTH_MISMATCH", fmt::format("expected {} bytes, found {}", byte_length, bytes.size()), pointer);
  return bytes.part(0, byte_length);
}

void Asset::count_skipped() {
  const auto buffers = json_->find("buffers");
  if (buffers == json_->end() || !buffers->is_array()) return;
  double authored = 0;
  for (const Json& buffer : *buffers)
    if (buffer.is_object()) authored += std::max(0.0, number_or(buffer, "byteLength", 0));
  const double skipped = authored - static_cast<double>(buffer_bytes_read_);
  stats.skipped_bytes = skipped > 0 ? static_cast<std::uint64_t>(std::min(skipped, 9007199254740992.0)) : 0;
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
