// Writes a scene as Mitsuba 3 XML with its PLY and EXR files in a folder NAME_files beside it. Mapping and losses: README.md beside this
// file.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
std::unique_ptr<Exporter> make_mitsuba_exporter();
}
