// EULUMDAT (.ldt), as published by A. Stockmar in 1990: one field a line.
#pragma once

#include "etendue/io.h"
#include "importers/photometry/options.h"

#include <memory>
#include <span>
#include <string>

namespace etendue {

// Errors, each with line, column and hint: FILE_EMPTY, NUL_BYTES, ENCODING_INVALID, FILE_TRUNCATED, NUMBER_EXPECTED, NUMBER_RANGE,
// COUNT_INVALID, SYMMETRY_INVALID, ANGLES_NOT_INCREASING, ANGLES_RANGE, HORIZONTAL_RANGE, FLUX_MISSING, LAMP_SET_MISSING,
// CANDELA_NEGATIVE; strict: the code of what a tolerant reading repairs. Allocates at most 8 bytes for each number that the bytes can hold.
Result<PhotometricFile> read_eulumdat(std::span<const std::byte> bytes, const std::string& file, const PhotometricOptions& options = {});

// A scene with one photometric light at the origin, its nadir along -Z and its C0 along +X.
std::unique_ptr<Importer> make_eulumdat_importer();

}  // namespace etendue
