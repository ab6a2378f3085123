// Textures as Mitsuba's `bitmap`: one wrap mode, no factor, one meaning a file.
#pragma once

#include "writer.h"

namespace etendue::mitsuba {

// texture x factor as a colour. An sRGB PNG or JPEG without factor is passed on as it is, anything else becomes a linear float picture.
Status add_colour_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, const Rgb& factor,
                          const std::string& owner);
// One channel (0 red ... 3 alpha) x factor, for a scalar parameter.
Status add_grey_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, int channel, double factor,
                        const std::string& owner);
// 2 x - 1 is the normal; its x and y are multiplied by `scale`.
Status add_normal_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, double scale,
                          const std::string& owner);
// 1 where alpha x factor >= cutoff, else 0.
Status add_cutout_texture(Writer& writer, pugi::xml_node parent, const char* name, const Texture& texture, double factor, double cutoff,
                          const std::string& owner);

}  // namespace etendue::mitsuba
