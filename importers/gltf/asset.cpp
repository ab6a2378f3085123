#include "asset.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "check_document.h"
#include "container.h"
#include "mapped_file.h"
#include "meshopt.h"
#include "repairs.h"
#include "structure.h"
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

// What a JSON text becomes in memory, in bytes a byte and a value: the document, and where its values stand.
constexpr std::uint64_t memory_per_byte = 32, memory_per_value = 256;

bool is_named_glb(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".glb";
}

// Of a place that counts lines and columns from 1.
std::size_t offset_in(std::string_view text, const Where& where) {
  std::size_t line_start = 0;
  for (int line = 1; line < where.line; ++line) line_start = std::min(text.size(), text.find('\n', line_start) + 1);
  return line_start + static_cast<std::size_t>(std::max(where.column - 1, 0));
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
  const auto bytes = asset->map(file, "");
  if (!bytes) return bytes.error();
  std::vector<Diagnostic> faults;
  const auto container = open_container(bytes->bytes(), is_named_glb(file), faults);
  for (Diagnostic& fault : faults) {
    fault.where.file = file.string();
    asset->add(std::move(fault));
  }
  if (!container) return asset->stopped();
  const auto part = [&](const void* first, std::size_t size) {
    return bytes->part(static_cast<std::size_t>(static_cast<const std::uint8_t*>(first) - bytes->data()), size);
  };
  asset->document_ = part(container->json.data(), container->json.size());
  if (container->binary) asset->binary_ = part(container->binary->data(), container->binary->size());
  asset->is_glb_ = container->is_glb;
  asset->json_offset_ = container->json_offset;
  asset->stats.bytes_read = asset->document_.size() + (container->is_glb ? glb_overhead : 0);
  will_read_all(asset->document_);
  if (!asset->parse(container->json)) return asset->stopped();
  if (!asset->check()) return asset->stopped();
  asset->load_model();
  return asset;
}

bool Asset::check() {
  Findings findings;
  const bool readable = check_version(*json_, findings);
  if (readable) schema_ = check_document(*json_, is_glb_, options_, findings);
  for (Diagnostic& diagnostic : findings.take()) {
    diagnostic.where = at(diagnostic.where.pointer);
    add(std::move(diagnostic));
  }
  return readable;
}

// The first error, the others as its notes.
Error Asset::stopped() {
  Error first{"READ_FAILED", "the file cannot be read", {file_.string(), 0, 0, ""}, {}, {}};
  bool found = false;
  for (const Diagnostic& diagnostic : diagnostics_.all()) {
    if (found || diagnostic.severity != Severity::error) {
      first.notes.push_back(diagnostic);
    } else {
      first = {diagnostic.code, diagnostic.text, diagnostic.where, diagnostic.hint, std::move(first.notes)};
      found = true;
    }
  }
  return first;
}

bool Asset::parse(std::string_view text) {
  const auto fail_as = [&](Error problem, const Where& where) {
    problem.where = where;
    problem.where.file = file_.string();
    if (is_glb_) {
      problem.where.offset = static_cast<std::int64_t>(json_offset_ + offset_in(text, where));
      problem.where.line = problem.where.column = 0;
    }
    error(problem);
    return false;
  };
  const auto fail = [&](const char* code, std::string problem, const Where& where) {
    return fail_as({code, std::move(problem), {}, {}, {}}, where);
  };
  const Where begin{{}, 1, 1, {}};
  if (text.size() > options_.max_memory / memory_per_byte)
    return fail_as(limit_exceeded(fmt::format("the memory for {} bytes of JSON", text.size()), "max_memory", options_.max_memory), begin);
  memory_ = memory_per_byte * text.size();
  if (text.starts_with("\xEF\xBB\xBF")) fail("INVALID_JSON", "expected UTF-8 without a byte order mark", begin);
  JsonLimits limits;
  limits.max_depth = options_.max_depth;
  limits.max_values = std::min<std::uint64_t>(limits.max_values, options_.max_memory / memory_per_value);
  auto document = JsonDocument::parse(text, file_.string(), limits);
  if (!document) {
    const Error& problem = document.error();
    if (problem.code == "JSON_TOO_DEEP")
      return fail_as(limit_exceeded("the nesting", "max_depth", static_cast<unsigned>(options_.max_depth)), problem.where);
    if (problem.code == "JSON_TOO_LARGE")
      return fail_as(limit_exceeded("the memory for " + problem.text, "max_memory", options_.max_memory), problem.where);
    return fail(problem.text.starts_with("number overflow") ? "VALUE_NOT_IN_RANGE" : "INVALID_JSON", problem.text, problem.where);
  }
  text_ = std::move(*document);
  for (const JsonValue& duplicate : text_->duplicate_keys())
    fail("DUPLICATE_PROPERTY", fmt::format("the member \"{}\" stands here a second time", duplicate.key()), duplicate.where_key());
  try {
    json_ = std::make_unique<Json>(Json::parse(text.begin(), text.end()));
  } catch (const Json::exception& e) {
    return fail("INVALID_JSON", e.what(), begin);
  }
  if (!json_->is_object()) return fail("TYPE_MISMATCH", "expected an object", text_->root().where());
  return true;
}

void Asset::load_model() {
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(no_files<tinygltf::FsCallbacks>());
  loader.SetImageLoader(ignore_image, nullptr);
  std::string problems, remarks;
  bool loaded = false;
  try {
    const std::string text = structure_of(*json_);
    loaded =
        loader.LoadASCIIFromString(&model_, &problems, &remarks, text.data(), static_cast<unsigned>(text.size()), "", tinygltf::NO_REQUIRE);
  } catch (const std::exception& e) {
    problems = e.what();
  }
  if (loaded) return remove_stand_ins(*json_, model_);
  while (!problems.empty() && problems.back() == '\n') problems.pop_back();
  model_ = {};
  if (errors_ == 0) error("INVALID_GLTF", "the document cannot be read: " + problems, "");  // else it is said already
}

const Json* Asset::extension(const std::string& pointer, const char* name) const {
  const Json::json_pointer place(pointer + "/extensions/" + name);
  return json_->contains(place) && json_->at(place).is_object() ? &json_->at(place) : nullptr;
}

bool Asset::is_used(const std::string& array, std::size_t index) const {
  const auto found = schema_.used.find(array);
  return found != schema_.used.end() && index < found->second.size() && found->second[index];
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
  if (is_glb_) {
    where.offset = static_cast<std::int64_t>(json_offset_ + value.offset());
    return where;
  }
  const Where found = value.where();
  where.line = found.line;
  where.column = found.column;
  return where;
}

Error Asset::failure(std::string code, std::string text, const std::string& pointer) const {
  return {std::move(code), std::move(text), at(pointer), {}, {}};
}

Error Asset::over_limit(const std::string& what, const char* option, std::uint64_t limit, const std::string& pointer) const {
  Error error = limit_exceeded(what, option, limit);
  error.where = at(pointer);
  return error;
}

Status Asset::claim_memory(std::uint64_t bytes, const std::string& pointer) {
  if (memory_ > options_.max_memory || bytes > options_.max_memory - memory_)
    return over_limit(fmt::format("{} bytes more in memory", bytes), "max_memory", options_.max_memory, pointer);
  memory_ += bytes;
  return Done{};
}

Status Asset::claim_decoded(std::uint64_t bytes, const std::string& pointer) {
  if (bytes > options_.max_decoded - decoded_)
    return over_limit(fmt::format("decoding {} bytes more", bytes), "max_decoded", options_.max_decoded, pointer);
  decoded_ += bytes;
  return claim_memory(bytes, pointer);
}

Result<SharedBytes> Asset::map(const std::filesystem::path& file, const std::string& pointer) const {
  auto bytes = map_file(file, options_.max_bytes);
  if (bytes) return bytes;
  if (bytes.error().code == "FILE_TOO_LARGE")
    return over_limit(fmt::format("the size of \"{}\"", file.string()), "max_bytes", options_.max_bytes, pointer);
  Error error = bytes.error();
  if (!pointer.empty()) error.where = at(pointer);
  return error;
}

Result<SharedBytes> Asset::data_of(const std::string& uri, const std::string& pointer) {
  if (const auto found = data_.find(pointer); found != data_.end()) return found->second;
  if (auto room = claim_decoded(most_bytes_of(uri), pointer); !room) return room.error();
  auto bytes = decode_data_uri(uri);
  if (!bytes) return failure(bytes.error().code, bytes.error().text, pointer);
  return data_.emplace(pointer, SharedBytes(std::move(*bytes))).first->second;
}

void Asset::add(Diagnostic diagnostic) {
  // What a check of the document has found is found again where it is in the way of reading.
  if (!known_.insert(diagnostic.code + diagnostic.where.pointer + "@" + std::to_string(diagnostic.where.offset)).second &&
      !diagnostic.where.pointer.empty())
    return;
  if (diagnostic.severity == Severity::error && options_.tolerant) {
    if (const char* repair = repair_of(diagnostic.code)) {
      diagnostic.severity = Severity::warning;
      diagnostic.text += fmt::format("; repaired: {}", repair);
    }
  }
  std::size_t& count = diagnostic.severity == Severity::error ? errors_ : others_;
  if (++count > max_findings + 1) return;
  if (count == max_findings + 1)
    diagnostic = {diagnostic.severity, "TOO_MANY_ISSUES", "there is more of this kind, which is not listed", {}, {}};
  diagnostics_.add(std::move(diagnostic));
}

void Asset::error(std::string code, std::string text, const std::string& pointer) {
  if (errors_ > max_findings) return;  // not listed any more: its place is not looked for
  add({Severity::error, std::move(code), std::move(text), at(pointer), {}});
}
void Asset::error(const Error& error) { add(to_diagnostic(error)); }
void Asset::warning(std::string code, std::string text, const std::string& pointer) {
  if (others_ > max_findings) return;  // not listed any more: its place is not looked for
  add({Severity::warning, std::move(code), std::move(text), at(pointer), {}});
}
void Asset::note(std::string code, std::string text, const std::string& pointer) {
  if (others_ > max_findings) return;  // not listed any more: its place is not looked for
  add({Severity::note, std::move(code), std::move(text), at(pointer), {}});
}

Result<SharedBytes> Asset::view(int index) {
  if (const auto found = views_.find(index); found != views_.end()) return found->second;
  const std::string pointer = fmt::format("/bufferViews/{}", index);
  if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size())
    return failure("UNRESOLVED_REFERENCE", fmt::format("there is no bufferView {}", index), pointer);
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
  const Json* meshopt = meshopt_is_built() ? extension(pointer, "EXT_meshopt_compression") : nullptr;
  auto bytes = meshopt != nullptr ? decoded_view(*meshopt, view.byteLength, pointer)
                                  : part_of_buffer(view.buffer, view.byteOffset, view.byteLength, pointer);
  if (bytes) views_.emplace(index, *bytes);
  return bytes;
}

Result<SharedBytes> Asset::decoded_view(const Json& meshopt, std::size_t expected, const std::string& view) {
  const std::string pointer = view + "/extensions/EXT_meshopt_compression";
  const auto whole = [&](const char* key, double otherwise) { return std::clamp(number_or(meshopt, key, otherwise), -1.0, 2147483647.0); };
  const double offset = whole("byteOffset", 0), length = whole("byteLength", 0);
  if (!(offset >= 0 && length >= 1)) return failure("MESHOPT_INVALID", "expected the place of the compressed bytes", pointer);
  const auto source =
      part_of_buffer(static_cast<int>(whole("buffer", -1)), static_cast<std::size_t>(offset), static_cast<std::size_t>(length), pointer);
  if (!source) return source.error();
  auto bytes = decode_meshopt(*this, meshopt, *source, pointer);
  if (bytes && bytes->size() != expected)
    return failure("MESHOPT_INVALID", fmt::format("expected {} bytes, as the bufferView says, found {}", expected, bytes->size()), pointer);
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
  if (!(authored_length >= 1)) return failure("VALUE_NOT_IN_RANGE", "expected a byteLength of 1 or more", pointer);
  if (authored_length > static_cast<double>(options_.max_bytes))
    return over_limit(fmt::format("byteLength {}", authored_length), "max_bytes", options_.max_bytes, pointer);
  const auto byte_length = static_cast<std::uint64_t>(authored_length);

  if (!buffer.contains("uri")) {
    if (!first || !binary_)
      return failure("BUFFER_MISSING_GLB_DATA", "a buffer without uri stands for the binary chunk of a GLB, and there is none", pointer);
    if (binary_.size() < byte_length)
      return failure("BUFFER_BYTE_LENGTH_MISMATCH",
                     fmt::format("expected {} bytes in the binary chunk, found {}", byte_length, binary_.size()), pointer);
    return binary_.part(0, byte_length);
  }
  const std::string uri = text_or(buffer, "uri", "");
  SharedBytes bytes;
  if (is_data_uri(uri)) {
    auto data = data_of(uri, pointer + "/uri");
    if (!data) return data.error();
    bytes = std::move(*data);
  } else {
    const auto path = file_inside(folder_, uri);
    if (!path) return failure(path.error().code, path.error().text, pointer + "/uri");
    auto mapped = map(*path, pointer + "/uri");
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
