// A file's bytes without reading them: pages come from the disk when somebody looks at them.
#pragma once

#include "etendue/bytes.h"
#include "etendue/result.h"

#include <cstdint>
#include <filesystem>

namespace etendue {

// The whole of a regular file, mapped for reading; of anything else (a pipe) its bytes in memory. The mapping goes with the last copy. The
// file must not shrink meanwhile, as with every mapping; replacing it by renaming (write_file) does no harm.
// mapped_file_posix.cpp; a Windows twin (CreateFileMapping, MapViewOfFile) would be mapped_file_windows.cpp.
// Errors: FILE_UNREADABLE, FILE_TOO_LARGE.
Result<SharedBytes> map_file(const std::filesystem::path& file, std::uint64_t max_bytes);

// All of these bytes of a mapping will be looked at soon: the system reads them ahead. Without it, and beyond them, it reads no
// further than asked.
void will_read_all(const SharedBytes& bytes);

}  // namespace etendue
