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
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

// RFC 4648, section 4; the padding may be missing.
std::optional<std::vector<std::uint8_t>> base64_decoded(std::string_view text) {
  for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFFFFu;
    count += 6;
    if (count >= 8) {
      count -= 8;
      out.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return out;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  return uri.size() >= scheme.size() && std::equal(scheme.begin(), scheme.end(), uri.begin(),
                                                   [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

Result<DataUri> decode_data_uri(std::string_view uri, std::uint64_t max_bytes) {
  const std::size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos)
    return uri_error("INVALID_URI", fmt::format("expected data:TYPE;base64,..., found \"{}\"", shown(uri)));
  const std::string_view head = uri.substr(5, comma - 5), payload = uri.substr(comma + 1);
  if (!head.ends_with(";base64"))
    return uri_error("INVALID_URI", fmt::format("expected a data URI in base64, found \"{}\"", shown(uri.substr(0, comma))));
  if (payload.size() / 4 * 3 > max_bytes)
    return uri_error("LIMIT_EXCEEDED",
                     fmt::format("a data URI of about {} bytes is over the limit of {}", payload.size() / 4 * 3, max_bytes));
  auto bytes = base64_decoded(payload);
  if (!bytes) return uri_error("INVALID_BASE64", "the data URI is not valid base64");
  DataUri result{std::string(head.substr(0, head.find(';'))), std::move(*bytes)};
  std::transform(result.mime_type.begin(), result.mime_type.end(), result.mime_type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
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
  if (failure) return uri_error("FILE_MISSING", fmt::format("the asset's folder cannot be resolved: {}", failure.message()));
  const fs::path found = fs::canonical(root / relative, failure);
  if (failure) return uri_error("FILE_MISSING", fmt::format("\"{}\" cannot be found: {}", shown(*decoded), failure.message()));
  // Both are free of links and dots now: inside means that the folder's parts are the first parts of the file's.
  if (std::mismatch(root.begin(), root.end(), found.begin(), found.end()).first != root.end()) return outside();
  if (!fs::is_regular_file(found, failure)) return uri_error("FILE_MISSING", fmt::format("\"{}\" is not a regular file", shown(*decoded)));
  // Not the canonical form: messages and exported scenes should name the file as the user knows it.
  return folder / relative;
}

}  // namespace etendue::gltf
