// URIs of buffers and images: data URIs, and files inside the asset's folder. Nothing else is ever opened.
#pragma once

#include "etendue/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

struct DataUri {
  std::string mime_type;  // lower case, without parameters
  std::vector<std::uint8_t> bytes;
};
bool is_data_uri(std::string_view uri);
// RFC 2397 with ;base64. Errors: INVALID_URI, INVALID_BASE64, LIMIT_EXCEEDED.
Result<DataUri> decode_data_uri(std::string_view uri, std::uint64_t max_bytes);

// The existing regular file that a relative reference names. Refused: schemes, absolute paths, "..", backslashes, NUL (all after
// percent-decoding), and links that lead out of `folder`. Errors: INVALID_URI, PATH_OUTSIDE_FOLDER, FILE_MISSING.
Result<std::filesystem::path> file_inside(const std::filesystem::path& folder, std::string_view uri);

}  // namespace etendue::gltf
