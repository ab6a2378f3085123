// Shading points as rows of a CSV file.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "etendue/result.h"
#include "etendue/vec.h"

namespace etendue::cli {

struct PointRow {
  Vec3d position, normal, view;  // unit vectors; view: 0 where none is wanted
};

// All rows of "px,py,pz,nx,ny,nz" (with `with_view` also "vx,vy,vz"; a heading of these names may come first), in blocks of up to 4096;
// stops at the first Status that is none. `file`: - is stdin. Errors: POINT_INVALID with file and line, LINE_TOO_LONG, FILE_UNREADABLE.
Status each_block(const std::string& file, bool with_view, const std::function<Status(std::span<const PointRow>)>& take);

// "x,y,z"; finite.
std::optional<Vec3d> parse_vector(std::string_view text);
// "r,g,b", none below 0.
std::optional<Rgb> parse_rgb(std::string_view text);

}  // namespace etendue::cli
