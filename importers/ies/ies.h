// IES LM-63: 1986, 1991, 1995, 2002 and 2019, web types A, B and C.
#pragma once

#include "etendue/io.h"
#include "importers/photometry/options.h"

#include <memory>
#include <span>
#include <string>

namespace etendue {

// Errors, each with line, column and hint: FILE_EMPTY, NUL_BYTES, ENCODING_INVALID, TILT_MISSING, HEADER_TOO_LONG, FILE_TRUNCATED,
// NUMBER_EXPECTED, NUMBER_RANGE, COUNT_INVALID, PHOTOMETRIC_TYPE, UNITS_INVALID, BALLAST_RECORD_MISSING, ANGLES_NOT_INCREASING,
// ANGLES_RANGE, HORIZONTAL_RANGE, CANDELA_NEGATIVE; strict: the code of what a tolerant reading repairs.
// Allocates at most 8 bytes for each number that the bytes can hold, and 64 bytes for each line of the header.
Result<PhotometricFile> read_ies(std::span<const std::byte> bytes, const std::string& file, const PhotometricOptions& options = {});

// A scene with one photometric light at the origin, its nadir along -Z and its C0 along +X.
std::unique_ptr<Importer> make_ies_importer();

}  // namespace etendue
