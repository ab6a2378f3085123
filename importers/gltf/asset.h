// A glTF document that has been read and checked against the schema, and its bytes on demand.
// Files are mapped, so that only what is looked at is read: of a GLB its JSON. tinygltf turns that into its model. It is never given a file
// name, a buffer or an image: buffers are opened here when the first accessor asks for them, from inside the asset's folder only, and
// pictures not at all.
#pragma once

#include "etendue/io.h"
#include "json_text.h"
#include "schema.h"

#include <tiny_gltf.h>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace etendue::gltf {

class Asset {
 public:
  // Errors: what stops everything (unreadable file, broken container or JSON, another major version). All else is in diagnostics().
  static Result<std::unique_ptr<Asset>> open(const std::filesystem::path& file, const ImportOptions& options);
  ~Asset();
  Asset(const Asset&) = delete;
  Asset& operator=(const Asset&) = delete;

  const tinygltf::Model& model() const { return model_; }  // without buffers and images
  // The document itself: extensions are read from here, since tinygltf keeps their integers in 32 bits.
  const nlohmann::json& json() const { return *json_; }
  // The object of an extension of the object at `pointer`, if there is one.
  const nlohmann::json* extension(const std::string& pointer, const char* name) const;
  const std::vector<ExtensionUse>& extensions() const { return schema_.extensions; }
  bool is_used(const std::string& array, std::size_t index) const;  // whether an index points to the element of "/buffers" ...
  bool is_glb() const { return is_glb_; }
  std::size_t binary_size() const { return binary_.size(); }  // of a GLB's binary chunk
  const ImportOptions& options() const { return options_; }
  const std::filesystem::path& folder() const { return folder_; }

  // Bytes of a bufferView: of its buffer, or what EXT_meshopt_compression says that they become. They count as read.
  Result<SharedBytes> view(int index);
  // The bytes that the document's buffer has, as far as anybody holds them; nothing is read yet.
  Result<SharedBytes> buffer(int index);
  // What a data URI says, decoded once. `pointer` is the place of the URI.
  Result<SharedBytes> data_of(const std::string& uri, const std::string& pointer);
  // To be asked before room is made: for bytes that hold what something compressed or encoded becomes (max_decoded and max_memory), or
  // anything else (max_memory). Each limit counts all claims of the asset together.
  Status claim_decoded(std::uint64_t bytes, const std::string& pointer);
  Status claim_memory(std::uint64_t bytes, const std::string& pointer);
  // The JSON as it stands in the file.
  const SharedBytes& document() const { return document_; }

  Where at(const std::string& pointer) const;
  Error failure(std::string code, std::string text, const std::string& pointer) const;
  Error over_limit(const std::string& what, const char* option, std::uint64_t limit, const std::string& pointer) const;
  void error(std::string code, std::string text, const std::string& pointer);
  void error(const Error& error);
  void warning(std::string code, std::string text, const std::string& pointer);
  void note(std::string code, std::string text, const std::string& pointer);

  // Messages so far; at most max_findings errors and as many others, then one that says so.
  Diagnostics take_diagnostics() { return std::move(diagnostics_); }
  void add(Diagnostic diagnostic);
  Stats stats;
  void count_skipped();  // into stats: the bytes of buffers that nobody asked for

  // What the scene has taken up, by its JSON pointer, for Scene::carried.
  void take(const std::string& pointer) { taken_.insert(pointer); }
  bool is_taken(const std::string& pointer) const { return taken_.contains(pointer); }

 private:
  Asset() = default;
  // False: nothing can be read; why not is in the diagnostics.
  bool parse(std::string_view text);
  bool check();
  Error stopped();
  void load_model();
  Result<SharedBytes> map(const std::filesystem::path& file, const std::string& pointer) const;
  Result<SharedBytes> open_buffer(const nlohmann::json& buffer, bool first, const std::string& pointer);
  Result<SharedBytes> decoded_view(const nlohmann::json& meshopt, std::size_t expected, const std::string& view);
  Result<SharedBytes> part_of_buffer(int buffer, std::size_t offset, std::size_t length, const std::string& pointer);

  std::filesystem::path file_, folder_;
  ImportOptions options_;
  SharedBytes document_, binary_;  // of the mapped file; `binary_` is there in a GLB alone
  std::unique_ptr<nlohmann::json> json_;
  tinygltf::Model model_;
  SchemaFindings schema_;
  std::map<int, SharedBytes> buffers_, views_;
  std::map<std::string, SharedBytes> data_;  // of data URIs, by their places
  std::uint64_t decoded_ = 0, memory_ = 0;   // claimed
  std::uint64_t buffer_bytes_read_ = 0;
  std::unordered_set<std::string> taken_;
  std::optional<JsonDocument> text_;  // where each value stands: lines in a .gltf, bytes in a GLB
  bool is_glb_ = false;
  std::size_t json_offset_ = 0;
  Diagnostics diagnostics_;
  std::set<std::string> known_;  // what they say, and where
  std::size_t errors_ = 0, others_ = 0;
};

// A number of an object; `otherwise` where it is absent (or of another type, which the schema's check has reported).
double number_or(const nlohmann::json& object, const char* key, double otherwise);
// The same of an array of numbers, element by element.
double number_or(const nlohmann::json& object, const char* key, std::size_t element, double otherwise);
std::string text_or(const nlohmann::json& object, const char* key, std::string otherwise);

}  // namespace etendue::gltf
