#include "uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace etendue::gltf {
namespace {

Error uri_error(const char* code, std::string text) { return {code, std::move(text), {}, {}, {}}; }

// For messages: data URIs may be megabytes long, and control characters have no business in a terminal.
std::string shown(std::string_view uri) {
  std::string text(uri.substr(0, 80));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return uri.size() > 80 ? text + "..." : text;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

// RFC 3986, 3.1: a letter, then letters, digits, "+", "-", ".", then ":". Windows' drive letters match as well.
bool has_scheme(std::string_view text) {
  if (text.empty() || std::isalpha(static_cast<unsigned char>(text[0])) == 0) return false;
  const auto end =
      std::find_if(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '+' && c != '-' && c != '.'; });
  return end != text.end() && *end == ':';
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // RFC 4648, section 5: safe in URIs
  if (c == '/' || c == '_') return 63;
  return -1;
}

// RFC 4648: four digits to three bytes, the last ones padded, or the padding left out. The number of digits; none if it is not so.
std::optional<std::size_t> base64_digits(std::string_view text) {
  std::size_t size = text.size();
  for (int i = 0; i < 2 && size > 0 && text[size - 1] == '='; ++i) --size;
  if (size % 4 == 1 || (size != text.size() && text.size() % 4 != 0)) return std::nullopt;
  if (!std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), [](char c) { return base64_digit(c) >= 0; }))
    return std::nullopt;
  return size;
}

// Of digits that base64_digits() has counted.
std::vector<std::uint8_t> base64_decoded(std::string_view digits) {
  std::vector<std::uint8_t> out;
  out.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : digits) {
    bits = (bits << 6 | static_cast<std::uint32_t>(base64_digit(c))) & 0xFFFFFFu;
    count += 6;
    if (count >= 8) {
      count -= 8;
      out.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return out;
}

struct DataParts {
  std::string_view head, payload;
  bool is_base64 = false;
};
std::optional<DataParts> data_parts(std::string_view uri) {
  constexpr std::string_view suffix = ";base64";
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
  DataParts parts{uri.substr(5, comma - 5), uri.substr(comma + 1)};
  parts.is_base64 = parts.head.ends_with(suffix);
  if (parts.is_base64) parts.head.remove_suffix(suffix.size());
  return parts;
}

// "=", "+" and "/" may come percent-encoded.
std::optional<std::string> unescaped(std::string_view payload) {
  return payload.find('%') == std::string_view::npos ? std::nullopt : percent_decoded(payload);
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(),
                                                   [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

std::string mime_type_of(std::string_view uri) {
  const auto parts = data_parts(uri);
  std::string type(parts ? parts->head.substr(0, parts->head.find(';')) : "");
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return type;
}

Status check_uri(std::string_view uri) {
  if (!is_data_uri(uri)) {
    // RFC 3986, 4.2: a colon in the first segment ends a scheme.
    const std::size_t mark = uri.find_first_of(":/?#");
    const bool is_broken = mark != std::string_view::npos && uri[mark] == ':' && !has_scheme(uri);
    if (is_broken || uri.find('\0') != std::string_view::npos)
      return uri_error("INVALID_URI", fmt::format("expected a relative reference, found \"{}\"", shown(uri)));
    return Done{};
  }
  const auto parts = data_parts(uri);
  if (!parts) return uri_error("INVALID_URI", fmt::format("expected data:TYPE;base64,..., found \"{}\"", shown(uri)));
  const auto text = unescaped(parts->payload);
  if (parts->is_base64 && !base64_digits(text ? std::string_view(*text) : parts->payload))
    return uri_error("INVALID_URI", "the data URI is not valid base64");
  return Done{};
}

std::uint64_t most_bytes_of(std::string_view uri) {
  const auto parts = data_parts(uri);
  if (!parts) return 0;
  return parts->is_base64 ? (parts->payload.size() + 3) / 4 * 3 : parts->payload.size();
}

Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
  if (auto form = check_uri(uri); !form) return form.error();
  const auto parts = data_parts(uri);
  if (!parts) return uri_error("INVALID_URI", "expected a data URI");
  const auto text = unescaped(parts->payload);
  const std::string_view payload = text ? std::string_view(*text) : parts->payload;
  if (parts->is_base64) return base64_decoded(payload.substr(0, base64_digits(payload).value_or(0)));
  return std::vector<std::uint8_t>(payload.begin(), payload.end());
}

std::vector<std::byte> head_of_data_uri(std::string_view uri, std::size_t bytes) {
  const std::size_t comma = uri.find(',');
  // Three letters (a percent-encoded one) to a digit, four digits to three bytes.
  const std::string_view begin = comma == std::string_view::npos ? uri : uri.substr(0, comma + 1);
  std::string_view payload = uri.substr(begin.size(), (bytes + 2) / 3 * 12);
  payload = payload.substr(0, payload.size() / 4 * 4);
  const auto data = decode_data_uri(std::string(begin) + std::string(payload));
  std::vector<std::byte> head;
  if (data)
    for (std::size_t i = 0; i < std::min(bytes, data->size()); ++i) head.push_back(static_cast<std::byte>((*data)[i]));
  return head;
}

bool is_relative(std::string_view uri) {
  return !has_scheme(uri) && !uri.starts_with('/') && uri.find_first_of("?#") == std::string_view::npos;
}

Result<std::filesystem::path> file_inside(const std::filesystem::path& folder, std::string_view uri) {
  namespace fs = std::filesystem;
  const auto decoded = percent_decoded(uri);
  if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos)
    return uri_error("INVALID_URI", fmt::format("expected a relative reference to a file, found \"{}\"", shown(uri)));
  const auto outside = [&] {
    return uri_error("PATH_OUTSIDE_FOLDER", fmt::format("expected a file inside the asset's folder, found \"{}\"", shown(*decoded)));
  };
  const fs::path relative(std::u8string(decoded->begin(), decoded->end()));
  const bool climbs = std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
  if (has_scheme(*decoded) || has_scheme(uri) || decoded->front() == '/' || decoded->find('\\') != std::string::npos ||
      relative.has_root_path() || climbs)
    return outside();

  std::error_code failure;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, failure);
  if (failure) return uri_error("IO_ERROR", fmt::format("the asset's folder cannot be resolved: {}", failure.message()));
  const fs::path found = fs::canonical(root / relative, failure);
  if (failure) return uri_error("IO_ERROR", fmt::format("\"{}\" cannot be found: {}", shown(*decoded), failure.message()));
  // Both are free of links and dots now: inside means that the folder's parts are the first parts of the file's.
  if (std::mismatch(root.begin(), root.end(), found.begin(), found.end()).first != root.end()) return outside();
  if (!fs::is_regular_file(found, failure)) return uri_error("IO_ERROR", fmt::format("\"{}\" is not a regular file", shown(*decoded)));
  // Not the canonical form: messages and exported scenes should name the file as the user knows it.
  return folder / relative;
}

}  // namespace etendue::gltf
