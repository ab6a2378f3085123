// URIs of buffers and images: data URIs, and files inside the asset's folder. Nothing else is ever opened.
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

bool is_data_uri(std::string_view uri);
// RFC 2397, base64 or percent-encoded. Error: INVALID_URI.
Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

// Without decoding: whether decode_data_uri() could, how many bytes it gives at most, its type (lower case, without parameters), and its
// first bytes.
Status check_uri(std::string_view uri);
std::uint64_t most_bytes_of(std::string_view data_uri);
std::string mime_type_of(std::string_view data_uri);
std::vector<std::byte> head_of_data_uri(std::string_view data_uri, std::size_t bytes);

// Without a scheme, an authority, a leading slash, a query or a fragment (RFC 3986).
bool is_relative(std::string_view uri);

// The existing regular file that a relative reference names. Refused: schemes, absolute paths, "..", backslashes, NUL (all after
// percent-decoding), and links that lead out of `folder`. Errors: INVALID_URI, PATH_OUTSIDE_FOLDER, IO_ERROR.
Result<std::filesystem::path> file_inside(const std::filesystem::path& folder, std::string_view uri);

}  // namespace etendue::gltf
