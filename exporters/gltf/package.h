// A document with its buffers and pictures as files.
#pragma once

#include "document.h"

namespace etendue::gltf {

// .gltf: the JSON text; files that it names are copied to the same places beside it, new pictures and the binary chunk of a GLB become
// files of their own.
Result<std::vector<std::filesystem::path>> write_text_file(Document& document, const std::filesystem::path& file);
// .glb: all buffers and pictures in one binary chunk. Other files that the document names are copied beside it.
Result<std::vector<std::filesystem::path>> write_binary_file(Document& document, const std::filesystem::path& file);

// A picture as it is stored, and "image/png" or what else its first bytes say; null: of a kind that glTF has no name for.
Result<SharedBytes> bytes_of(const ImageRef& image);
const char* mime_type_of(const SharedBytes& bytes);

}  // namespace etendue::gltf
