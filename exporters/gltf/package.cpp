#include "package.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>
#include <set>

#include "mapped_file.h"
#include "uri.h"
#include "whole_file.h"

namespace etendue::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_file = std::uint64_t{1} << 40;

fs::path folder_of(const fs::path& file) { return file.parent_path().empty() ? fs::path(".") : file.parent_path(); }

bool same_bytes(const SharedBytes& a, const SharedBytes& b) { return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin()); }

const std::string* relative_uri(const Json& object) {
  const auto uri = object.find("uri");
  if (uri == object.end() || !uri->is_string()) return nullptr;
  const auto* text = uri->get_ptr<const std::string*>();
  return is_data_uri(*text) ? nullptr : text;
}

// RFC 3986: unreserved characters and "/" stand for themselves.
std::string percent_encoded(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("-._~/").find(c) != std::string_view::npos)
      out += c;
    else
      out += fmt::format("%{:02X}", byte);
  }
  return out;
}

// Files of one call. They are written under names of their own and take their places together, the named one last: who ends before that
// leaves what was there before.
class Files {
 public:
  explicit Files(const Document& document, const fs::path& file) : document_(document), file_(file) {}
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() {
    std::error_code ignored;
    for (const fs::path& path : written_) fs::remove(part_of(path), ignored);
  }

  Status write(const fs::path& target, std::span<const std::span<const std::byte>> pieces) {
    std::error_code failure;
    fs::create_directories(folder_of(target), failure);
    if (failure)
      return Error{"FILE_UNWRITABLE", "cannot make the folder: " + failure.message(), {folder_of(target).string(), 0, 0, {}}, {}, {}};
    // Devices and pipes are written to, never replaced.
    const bool is_device = fs::exists(target, failure) && !fs::is_regular_file(target, failure);
    if (Status status = write_file(is_device ? target : part_of(target), pieces); !status) return status;
    written_.push_back(target);
    return Done{};
  }

  // The file that a reference of the source names, at the same place beside the new one. One that is there already stays if it says the
  // same.
  Status copy(const std::string& uri) {
    const fs::path folder = folder_of(document_.scene.file);
    const Result<fs::path> from = file_inside(folder, uri);
    if (!from) return from.error();
    const fs::path to = folder_of(file_) / from->lexically_relative(folder);
    if (to == file_)
      return Error{
          "FILE_UNWRITABLE", fmt::format("\"{}\" would replace a file that it refers to", to.string()), {to.string(), 0, 0, {}}, {}, {}};
    std::error_code ignored;
    if (fs::equivalent(*from, to, ignored) || std::find(written_.begin(), written_.end(), to) != written_.end()) return Done{};
    const Result<SharedBytes> bytes = map_file(*from, largest_file);
    if (!bytes) return bytes.error();
    if (fs::exists(to, ignored)) {
      const Result<SharedBytes> there = map_file(to, largest_file);
      if (there && same_bytes(*there, *bytes)) return Done{};
      return Error{"FILE_UNWRITABLE",
                   fmt::format("\"{}\" is needed beside the file, and another file of that name is there", to.string()),
                   {to.string(), 0, 0, {}},
                   "write into a folder of its own",
                   {}};
    }
    const std::array pieces{bytes->bytes()};
    return write(to, pieces);
  }

  // The named file first.
  Result<std::vector<fs::path>> done() {
    for (const fs::path& path : written_) {
      std::error_code failure;
      if (fs::exists(part_of(path), failure)) fs::rename(part_of(path), path, failure);
      if (failure) return Error{"FILE_UNWRITABLE", "cannot be put in place: " + failure.message(), {path.string(), 0, 0, {}}, {}, {}};
    }
    std::rotate(written_.begin(), std::prev(written_.end()), written_.end());
    return std::exchange(written_, {});
  }

 private:
  static fs::path part_of(const fs::path& path) { return folder_of(path) / ("." + path.filename().string() + ".part"); }

  const Document& document_;
  const fs::path& file_;
  std::vector<fs::path> written_;
};

// Buffers and images have to be there; what else has a `uri` may name anything.
Status copy_all(Document& document, Files& files, Json& value) {
  for (const char* array : {"buffers", "images"}) {
    if (!value.contains(array)) continue;
    for (Json& element : value[array])
      if (const std::string* uri = relative_uri(element))
        if (Status copied = files.copy(*uri); !copied) return copied;
  }
  for_each_object(value, [&](Json& object) {
    const std::string* uri = relative_uri(object);
    if (uri == nullptr) return;
    if (const Status copied = files.copy(*uri); !copied)
      document.losses.add(fmt::format("the file \"{}\" that the document names", *uri), "not copied: " + copied.error().text);
  });
  return Done{};
}

std::string new_text(const Document& document) { return edited(document.text, document.before, document.now); }

std::string plain(const std::string& name) {
  std::string text = name;
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return text.empty() ? "image" : text;
}

// A GLB's binary chunk from the parts of the buffers that are still needed.
class BinaryChunk {
 public:
  // Where it stands in the chunk. Eight bytes suit every accessor.
  std::size_t add(SharedBytes bytes) {
    const std::size_t at = size_;
    size_ += (bytes.size() + 7) / 8 * 8;
    parts_.push_back(std::move(bytes));
    return at;
  }
  std::size_t size() const { return size_; }
  // Without the last part's padding.
  std::size_t length() const { return size_ - (7 - (parts_.back().size() + 7) % 8); }
  // The first `count` bytes, in pieces.
  void append_to(std::vector<std::span<const std::byte>>& pieces, std::size_t count) const {
    static constexpr std::array<std::byte, 8> zeros{};
    for (const SharedBytes& part : parts_) {
      pieces.push_back(part.bytes().first(std::min(count, part.size())));
      count -= pieces.back().size();
      const std::size_t padding = std::min(count, (8 - part.size() % 8) % 8);
      pieces.push_back(std::span(zeros).first(padding));
      count -= padding;
    }
  }

 private:
  std::size_t size_ = 0;
  std::vector<SharedBytes> parts_;
};

// A buffer's bytes without its gaps, and where what stood at an offset stands in the chunk. What stays keeps its offset modulo 8.
class MovedBuffer {
 public:
  MovedBuffer(BinaryChunk& chunk, const SharedBytes& bytes, std::vector<Gap> gaps) {
    std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.begin < b.begin; });
    std::size_t kept = 0;
    for (const Gap& gap : gaps) {
      const std::size_t begin = (gap.begin + 7) / 8 * 8, end = (gap.begin + gap.size) / 8 * 8;
      if (begin < kept || end <= begin || end > bytes.size()) continue;
      keep(chunk, bytes, kept, begin);
      kept = end;
    }
    keep(chunk, bytes, kept, bytes.size());
  }
  std::size_t moved(std::size_t offset) const {
    const auto behind = std::upper_bound(starts_.begin(), starts_.end(), offset, [](std::size_t o, const auto& s) { return o < s.first; });
    const auto& [from, to] = *std::prev(behind);
    return to + (offset - from);
  }

 private:
  void keep(BinaryChunk& chunk, const SharedBytes& bytes, std::size_t begin, std::size_t end) {
    if (begin == 0 || end > begin) starts_.emplace_back(begin, chunk.add(bytes.part(begin, end - begin)));
  }
  std::vector<std::pair<std::size_t, std::size_t>> starts_;  // in the buffer, in the chunk
};

// Gaps that nothing else lies in.
std::vector<Gap> true_gaps(Json& document, const std::vector<Gap>& gaps, std::size_t buffer) {
  std::vector<Gap> out;
  for (const Gap& gap : gaps)
    if (gap.buffer == buffer) out.push_back(gap);
  if (!document.contains("bufferViews")) return out;
  for_each_object(document["bufferViews"], [&](Json& view) {
    const Json* of = index_in(view, "buffer");
    if (of == nullptr || of->get<std::size_t>() != buffer) return;
    const std::size_t begin = view.value("byteOffset", std::size_t{0}), end = begin + view.value("byteLength", std::size_t{0});
    std::erase_if(out, [&](const Gap& gap) { return begin < gap.begin + gap.size && gap.begin < end; });
  });
  return out;
}

Result<SharedBytes> bytes_in_text(const Json& buffer) {
  const std::string uri = buffer.value("uri", "");
  if (!is_data_uri(uri)) return SharedBytes();
  Result<std::vector<std::uint8_t>> data = decode_data_uri(uri);
  if (!data) return data.error();
  return SharedBytes(std::move(*data));
}

// Whether a file is the one that an external buffer of the source lies in, which others may name too.
bool is_named_by_source(const Document& document, const Json& buffer, const fs::path& target) {
  const std::string* uri = relative_uri(buffer);
  if (uri == nullptr) return false;
  const Result<fs::path> file = file_inside(folder_of(document.scene.file), *uri);
  std::error_code ignored;
  return file && fs::equivalent(*file, target, ignored);
}

// What lies in a buffer, where its bytes stand now.
void move_views(Json& document, std::size_t buffer, const MovedBuffer& moved) {
  for_each_object(document["bufferViews"], [&](Json& view) {
    const Json* of = index_in(view, "buffer");
    if (of == nullptr || of->get<std::size_t>() != buffer) return;
    const std::size_t before = view.value("byteOffset", std::size_t{0}), offset = moved.moved(before);
    if (offset != before) view["byteOffset"] = offset;
  });
}

class GlbPackage {
 public:
  GlbPackage(Document& document, Files& files) : document_(document), now_(document.now), files_(files) {}

  Status write(const fs::path& file) {
    if (Status merged = merge_buffers(); !merged) return merged;
    if (Status embedded = embed_images(); !embedded) return embedded;
    if (Status copied = copy_all(document_, files_, now_); !copied) return copied;
    // A first buffer without a URI would be the chunk: one whose bytes nobody has needs another before it.
    if (!has_chunk_ && chunk_.size() == 0 && now_.contains("buffers") && !now_["buffers"][0].contains("uri"))
      chunk_.add(SharedBytes(std::vector<std::uint8_t>(4)));
    if (chunk_.size() > 0) {
      if (!has_chunk_) add_buffer_for_chunk();
      now_["buffers"][0]["byteLength"] = chunk_.length();
    } else if (has_chunk_) {
      remove_empty_buffer();
    }
    return write_chunks(file);
  }

 private:
  // All buffers whose bytes are there become one; the others come behind it.
  Status merge_buffers() {
    if (!now_.contains("buffers")) return Done{};
    const Json old = now_["buffers"];
    const auto& carried = document_.scene.carried.buffers;
    std::vector<std::optional<MovedBuffer>> moved(old.size());
    std::vector<std::size_t> place(old.size());
    Json buffers = Json::array();
    for (std::size_t i = 0; i < old.size(); ++i) {
      const Result<SharedBytes> bytes = i < carried.size() && carried[i] ? carried[i] : bytes_in_text(old[i]);
      if (!bytes) return bytes.error();
      if (!*bytes) continue;
      moved[i].emplace(chunk_, bytes->part(0, std::min(bytes->size(), old[i].value("byteLength", bytes->size()))),
                       true_gaps(now_, document_.gaps, i));
      if (buffers.empty()) {
        buffers.push_back(old[i]);
        buffers[0].erase("uri");
      }
    }
    has_chunk_ = !buffers.empty();
    for (std::size_t i = 0; i < old.size(); ++i)
      if (!moved[i]) place[i] = buffers.size(), buffers.push_back(old[i]);
    now_["buffers"] = std::move(buffers);
    if (!now_.contains("bufferViews")) return Done{};
    for_each_object(now_["bufferViews"], [&](Json& view) {
      const Json* of = index_in(view, "buffer");
      if (of == nullptr || of->get<std::size_t>() >= old.size()) return;
      const auto buffer = of->get<std::size_t>();
      const std::size_t before = view.value("byteOffset", std::size_t{0});
      const std::size_t offset = moved[buffer] ? moved[buffer]->moved(before) : before;
      if (view["buffer"] != place[buffer]) view["buffer"] = place[buffer];
      if (offset != before) view["byteOffset"] = offset;
    });
    return Done{};
  }

  Status embed_images() {
    if (!now_.contains("images")) return Done{};
    for (std::size_t i = 0; i < now_["images"].size(); ++i) {
      Json& image = now_["images"][i];
      const auto made = document_.new_images.find(i);
      const std::string* uri = relative_uri(image);
      if (made == document_.new_images.end() && uri == nullptr) continue;
      const Result<SharedBytes> bytes = made != document_.new_images.end() ? bytes_of(*made->second) : bytes_beside(*uri);
      if (!bytes) return bytes.error();
      const char* type = mime_type_of(*bytes);
      if (type == nullptr && !image.contains("mimeType")) continue;  // of a kind that a GLB cannot name: its file is copied
      image.erase("uri");
      if (type != nullptr) image["mimeType"] = type;
      image["bufferView"] = now_.contains("bufferViews") ? now_["bufferViews"].size() : 0;
      now_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", chunk_.size()}, {"byteLength", bytes->size()}});
      chunk_.add(*bytes);
    }
    return Done{};
  }

  Result<SharedBytes> bytes_beside(const std::string& uri) const {
    const Result<fs::path> file = file_inside(folder_of(document_.scene.file), uri);
    if (!file) return file.error();
    return map_file(*file, largest_file);
  }

  // The chunk is the first buffer's: those that stay outside move on by one.
  void add_buffer_for_chunk() {
    Json buffers = Json::array({{{"byteLength", 0}}});
    if (now_.contains("buffers"))
      for (Json& buffer : now_["buffers"]) buffers.push_back(std::move(buffer));
    const std::size_t images = document_.before.contains("bufferViews") ? document_.before["bufferViews"].size() : 0;
    for (std::size_t i = 0; now_.contains("bufferViews") && i < std::min(images, now_["bufferViews"].size()); ++i)
      for_each_object(now_["bufferViews"][i], [](Json& view) {
        if (const Json* of = index_in(view, "buffer")) view["buffer"] = of->get<std::size_t>() + 1;
      });
    now_["buffers"] = std::move(buffers);
  }

  void remove_empty_buffer() {
    Json& buffers = now_["buffers"];
    buffers.erase(0);
    if (buffers.empty()) now_.erase("buffers");
    if (!now_.contains("bufferViews")) return;
    for_each_object(now_["bufferViews"], [](Json& view) {
      if (const Json* of = index_in(view, "buffer"); of != nullptr && of->get<std::size_t>() > 0)
        view["buffer"] = of->get<std::size_t>() - 1;
    });
  }

  Status write_chunks(const fs::path& file) {
    std::string json = new_text(document_);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t binary = (chunk_.size() > 0 ? chunk_.length() + 3 : 0) / 4 * 4;
    const std::size_t total = 12 + 8 + json.size() + (binary > 0 ? 8 + binary : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
      return Error{"FILE_TOO_LARGE",
                   fmt::format("a GLB holds at most 4 GiB, and this one has {} bytes", total),
                   {file.string(), 0, 0, {}},
                   "write a .gltf",
                   {}};
    std::string head = "glTF" + little_endian(2) + little_endian(total) + little_endian(json.size()) + "JSON" + json;
    if (binary > 0) head += little_endian(binary) + std::string("BIN\0", 4);
    std::vector<std::span<const std::byte>> pieces{std::as_bytes(std::span(head))};
    chunk_.append_to(pieces, binary);
    return files_.write(file, pieces);
  }

  static std::string little_endian(std::size_t value) {
    std::string out;
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 0xFF);
    return out;
  }

  Document& document_;
  Json& now_;
  Files& files_;
  BinaryChunk chunk_;
  bool has_chunk_ = false;
};

}  // namespace

const char* mime_type_of(const SharedBytes& bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 12));
  if (head.starts_with("\x89PNG")) return "image/png";
  if (head.starts_with("\xff\xd8")) return "image/jpeg";
  if (head.size() == 12 && head.starts_with("RIFF") && head.substr(8) == "WEBP") return "image/webp";
  if (head.starts_with("\xabKTX 20")) return "image/ktx2";
  return nullptr;
}

Result<SharedBytes> bytes_of(const ImageRef& image) {
  if (image.embedded) return image.embedded;
  return map_file(image.file, largest_file);
}

Result<std::vector<fs::path>> write_text_file(Document& document, const fs::path& file) {
  Files files(document, file);
  Json& now = document.now;
  const std::string stem = file.stem().string();
  const auto& carried = document.scene.carried.buffers;
  std::set<std::size_t> ours;  // buffers that become files of ours
  for (std::size_t i = 0; now.contains("buffers") && i < now["buffers"].size(); ++i) {
    Json& buffer = now["buffers"][i];
    std::vector<Gap> gaps = true_gaps(now, document.gaps, i);
    Result<SharedBytes> bytes = i < carried.size() && carried[i] ? carried[i] : SharedBytes();
    if (!*bytes && !gaps.empty()) bytes = bytes_in_text(buffer);
    if (!bytes) return bytes.error();
    BinaryChunk chunk;
    const MovedBuffer moved(chunk, bytes->part(0, std::min(bytes->size(), buffer.value("byteLength", bytes->size()))), gaps);
    if (chunk.size() == 0) gaps.clear();  // a buffer has a byte at least
    if (!*bytes || (gaps.empty() && buffer.contains("uri"))) continue;
    std::string name = stem + ".bin";
    if (!ours.empty() || is_named_by_source(document, buffer, folder_of(file) / name)) name = fmt::format("{}_{}.bin", stem, i);
    std::vector<std::span<const std::byte>> pieces;
    if (gaps.empty()) {
      pieces.push_back(bytes->bytes());
    } else {
      move_views(now, i, moved);
      chunk.append_to(pieces, chunk.length());
      buffer["byteLength"] = chunk.length();
    }
    if (Status status = files.write(folder_of(file) / name, pieces); !status) return status.error();
    buffer["uri"] = percent_encoded(name);
    ours.insert(i);
  }
  for (const auto& [place, image] : document.new_images) {
    const Result<SharedBytes> bytes = bytes_of(*image);
    if (!bytes) return bytes.error();
    const char* type = mime_type_of(*bytes);
    const bool is_jpeg = type != nullptr && std::string_view(type) == "image/jpeg";
    const std::string name = fmt::format("{}_files/{}_{}.{}", plain(stem), place, plain(image->name), is_jpeg ? "jpg" : "png");
    const std::array pieces{bytes->bytes()};
    if (Status status = files.write(folder_of(file) / name, pieces); !status) return status.error();
    now["images"][place]["uri"] = percent_encoded(name);
  }
  // What was just written lies beside the new file, not beside the source.
  Json others = now;
  for (const auto& [place, image] : document.new_images) others["images"][place].erase("uri");
  for (const std::size_t i : ours) others["buffers"][i].erase("uri");
  if (Status status = copy_all(document, files, others); !status) return status.error();

  const std::string text = new_text(document);
  const std::array pieces{std::as_bytes(std::span(text))};
  if (Status status = files.write(file, pieces); !status) return status.error();
  return files.done();
}

Result<std::vector<fs::path>> write_binary_file(Document& document, const fs::path& file) {
  Files files(document, file);
  if (Status status = GlbPackage(document, files).write(file); !status) return status.error();
  return files.done();
}

}  // namespace etendue::gltf
