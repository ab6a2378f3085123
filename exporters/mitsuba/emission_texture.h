// Light that varies over its surface: Mitsuba samples the unit square of the picture and looks up the place of the surface that has these
// coordinates. So the coordinates have to lie inside it, without a transform.
#pragma once

#include "writer.h"

namespace etendue::mitsuba {

// Moves the mesh's uv into the unit square of a picture that holds texture x radiance, repeated as often as the mesh looks it up, and adds
// that picture as `parent`'s radiance. Error: EXPORT_UNSUPPORTED where that would be more than 2^26 texels.
Status add_textured_radiance(Writer& writer, pugi::xml_node parent, Mesh& mesh, const Texture& texture, const Rgb& radiance,
                             const std::string& owner);

// uv over the enclosing rectangle of a planar light: u from +X to -X, v from +Y to -Y, so that the picture is upright for who looks at the
// light.
void set_planar_uvs(Mesh& mesh);

}  // namespace etendue::mitsuba
