#include "etendue/units.h"
#include "projector.h"

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {
namespace {

// Above this half angle a spot's texture, which lies on a plane in front of it, is stretched too much.
constexpr double widest_spot_rad = 80 * pi / 180;

// Texels along a side so that the ramp is at least 128 of them wide: between texel centres the bilinear form is off by up to (n/128)^-2
// 2e-5 of the axis' value, and at the ramp's inner end, where the slope jumps by 2 / width, one texel ring by up to .2 %.
std::uint32_t spot_texels(const SpotShape& spot) {
  const double ramp = 1 - std::tan(spot.inner_rad) / std::tan(spot.outer_rad);
  const double needed = 2 * 128 / std::max(ramp, 1e-9);
  return needed <= 1024 ? 1024 : 2048;
}

// The texel value for f >= 0 with which bilinear interpolation has the mean of f: the trapezium rule is h^2 / 12 (f_xx + f_yy) too large,
// with second differences over texels h apart. Without it a spot's edge, where f is convex, is too bright everywhere.
template <class F>
double mean_keeping(const F& f, double x, double y, double h) {
  const double centre = f(x, y);
  const double second_differences = f(x - h, y) + f(x + h, y) + f(x, y - h) + f(x, y + h) - 4 * centre;
  return std::max(0.0, centre - second_differences / 12);
}

// A hemisphere as five faces of a cube: one ahead, four around, whose "up" is the light's axis, so that all four show the same picture.
Status write_wide_spot(Writer& writer, const LightEntry& entry, const SpotShape& spot) {
  constexpr std::uint32_t texels = 512;
  const auto falloff_of = [&](double along, double x, double y) { return spot_falloff(spot, along / std::sqrt(1 + x * x + y * y)); };
  Result<std::string> ahead = writer.assets.add_picture(texels, texels, tabulate(texels, texels, 1, 1, [&](double x, double y) {
                                                          return projector_value(entry.resolved.rgb * falloff_of(1, x, y), x, y);
                                                        }));
  if (!ahead) return ahead.error();
  Result<std::string> around = writer.assets.add_picture(texels, texels, tabulate(texels, texels, 1, 1, [&](double x, double y) {
                                                           return projector_value(entry.resolved.rgb * falloff_of(y, x, y), x, y);
                                                         }));
  if (!around) return around.error();
  const Transform& frame = entry.light.transform;
  const Vec3d axis = -frame.columns[2];
  add_projector(writer, entry.id + "_ahead", *ahead, pi / 2, facing_forward(frame));
  int face = 0;
  for (const Vec3d& forward : {frame.columns[0], frame.columns[1], -frame.columns[0], -frame.columns[1]}) {
    add_projector(writer, entry.id + "_side" + std::to_string(face++), *around, pi / 2,
                  {{cross(axis, forward), axis, forward}, frame.translation});
  }
  return Done{};
}

// Our own emitter (emitters.py), without a cone or a pyramid yet.
pugi::xml_node add_lamp(Writer& writer, const LightEntry& entry) {
  pugi::xml_node lamp = add_plugin(writer.root, "emitter", "etendue_lamp", entry.id);
  add_rgb(lamp, "intensity", entry.resolved.rgb);
  add_window(lamp, entry.light);
  add_matrix(lamp, "to_world", entry.light.transform.rigid());
  return lamp;
}

}  // namespace

// The squared linear ramp in the cosine between the outer and the inner cone.
double spot_falloff(const SpotShape& spot, double cosine) {
  const double outer = std::cos(spot.outer_rad), inner = std::cos(spot.inner_rad);
  if (cosine <= outer) return 0;
  if (cosine >= inner) return 1;
  const double ramp = (cosine - outer) / (inner - outer);
  return ramp * ramp;
}

Rgb projector_value(const Rgb& intensity, double x, double y) {
  const double cosine = 1 / std::sqrt(1 + x * x + y * y);
  return intensity * (cosine * cosine * cosine / pi);
}

pugi::xml_node add_clamped_bitmap(pugi::xml_node parent, const char* name, const std::string& file) {
  pugi::xml_node bitmap = add_plugin(parent, "texture", "bitmap", {}, name);
  add_string(bitmap, "filename", file);
  add_string(bitmap, "wrap_mode", "clamp");
  return bitmap;
}

void put_texels_on_edges(pugi::xml_node bitmap, std::uint32_t texels) {
  const double n = texels;
  pugi::xml_node transform = bitmap.append_child("transform");
  transform.append_attribute("name") = "to_uv";
  for (const auto& [step, value] : {std::pair("scale", (n - 1) / n), std::pair("translate", 0.5 / n)}) {
    pugi::xml_node node = transform.append_child(step);
    node.append_attribute("x") = text_of(value).c_str();
    node.append_attribute("y") = text_of(value).c_str();
  }
}

pugi::xml_node add_projector(Writer& writer, const std::string& id, const std::string& file, double fov_rad, const Transform& to_world) {
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "projector", id);
  add_clamped_bitmap(emitter, "irradiance", file);
  add_float(emitter, "fov", fov_rad * 180 / pi);
  add_string(emitter, "fov_axis", "x");
  add_matrix(emitter, "to_world", to_world);
  return emitter;
}

Status write_point(Writer& writer, const LightEntry& entry) {
  if (writer.parts == MitsubaParts::with_plugins && has_window(entry.light)) {
    add_lamp(writer, entry);
    return Done{};
  }
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "point", entry.id);
  add_point(emitter, "position", entry.light.transform.translation);
  add_rgb(emitter, "intensity", entry.resolved.rgb);
  return Done{};
}

// Mitsuba's own ramp is linear in the angle; it is narrowed to nothing, and a texture over the plane ahead has ours:
// u = 1/2 + x / (2 tan outer), v = 1/2 + y / (2 tan outer). The pattern is round, so its orientation does not matter.
Status write_spot(Writer& writer, const LightEntry& entry, const SpotShape& spot) {
  if (writer.parts == MitsubaParts::with_plugins) {
    pugi::xml_node lamp = add_lamp(writer, entry);
    add_float(lamp, "cone_inner", spot.inner_rad * 180 / pi);
    add_float(lamp, "cone_outer", spot.outer_rad * 180 / pi);
    return Done{};
  }
  if (spot.outer_rad > widest_spot_rad) return write_wide_spot(writer, entry, spot);
  const bool sharp = spot.outer_rad - spot.inner_rad < 1e-9;
  std::string file;
  if (!sharp) {
    const std::uint32_t texels = spot_texels(spot);
    const double extent = std::tan(spot.outer_rad);
    const auto falloff = [&](double x, double y) { return spot_falloff(spot, 1 / std::sqrt(1 + x * x + y * y)); };
    Result<std::string> texture =
        writer.assets.add_picture(texels, texels, tabulate(texels, texels, extent, extent, [&](double x, double y) {
                                    const double f = mean_keeping(falloff, x, y, 2 * extent / texels);
                                    return Rgb{f, f, f};
                                  }));
    if (!texture) return texture.error();
    file = *texture;
    const double ramp_texels = texels / 2.0 * (1 - std::tan(spot.inner_rad) / extent);
    if (ramp_texels < 16) {
      writer.losses.add(name_for_losses(entry.light) + ": penumbra of " + text_of((spot.outer_rad - spot.inner_rad) * 180 / pi) + " deg",
                        "tabulated with " + text_of(std::ceil(ramp_texels)) + " texels: blurred by half a texel at either end");
    }
  }
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "spot", entry.id);
  add_rgb(emitter, "intensity", entry.resolved.rgb);
  if (!sharp) add_boolean(add_clamped_bitmap(emitter, "texture", file), "raw", true);
  const double cutoff_deg = spot.outer_rad * 180 / pi;
  add_float(emitter, "cutoff_angle", cutoff_deg);
  add_float(emitter, "beam_width", cutoff_deg * (1 - 1e-6));
  add_matrix(emitter, "to_world", facing_forward(entry.light.transform));
  return Done{};
}

// The projector takes its height from the picture's shape, so width : height has to be tan(width / 2) : tan(height / 2): the best fraction
// with up to 1024 texels a side, off by about 1e-6.
Status write_frustum(Writer& writer, const LightEntry& entry, const FrustumShape& frustum) {
  if (writer.parts == MitsubaParts::with_plugins) {
    pugi::xml_node lamp = add_lamp(writer, entry);
    add_float(lamp, "width", frustum.width_rad * 180 / pi);
    add_float(lamp, "height", frustum.height_rad * 180 / pi);
    return Done{};
  }
  const double x_extent = std::tan(frustum.width_rad / 2), y_extent = std::tan(frustum.height_rad / 2);
  const double ratio = std::max(x_extent, y_extent) / std::min(x_extent, y_extent);
  constexpr std::uint32_t most = 1024, fewest = 256;
  std::uint32_t small = fewest, large = 0;
  double best = 1e30;
  const auto limit = static_cast<std::uint32_t>(std::max(16.0, most / ratio));
  for (std::uint32_t s = std::min(fewest, limit); s <= limit; ++s) {
    const auto l = static_cast<std::uint32_t>(std::lround(std::min(s * ratio, 1e6)));
    const double error = std::abs(l / (s * ratio) - 1);
    if (error < best) best = error, small = s, large = l;
  }
  if (large > 16384) return unsupported("light '" + entry.light.name + "' is a frustum of extreme proportions", entry.light.source);
  const bool wide = x_extent >= y_extent;
  const std::uint32_t width = wide ? large : small, height = wide ? small : large;
  Result<std::string> file = writer.assets.add_picture(width, height, tabulate(width, height, x_extent, y_extent, [&](double x, double y) {
                                                         return projector_value(entry.resolved.rgb, x, y);
                                                       }));
  if (!file) return file.error();
  add_projector(writer, entry.id, *file, frustum.width_rad, facing_forward(entry.light.transform));
  // cos^3 between texel centres h apart is off by up to 3 h^2 / 8 of the axis' value, and half a texel inside the edge by its slope.
  const double h = 2 * std::max(x_extent / width, y_extent / height);
  if (3 * h * h / 8 > 1e-3) {
    writer.losses.add(name_for_losses(entry.light) + ": frustum", "its intensity is tabulated too coarsely towards the edge: up to " +
                                                                      text_of(std::round(3 * h * h / 8 * 1e4) / 100) +
                                                                      " % of the axis' value");
  }
  return Done{};
}

// A sun of angular radius a as a disk of radius D tan a at distance D: on a facing plane E = pi L sin^2 a, as of the cone of that angle. D
// is 1e5 times the scene, so that a point at its edge sees the sun's centre 1e-5 rad off and E 2e-5 off.
Status write_distant(Writer& writer, const LightEntry& entry, const DistantShape& distant) {
  const Transform& frame = entry.light.transform;
  if (distant.diameter_rad == 0) {
    pugi::xml_node emitter = add_plugin(writer.root, "emitter", "directional", entry.id);
    add_vector(emitter, "direction", -frame.columns[2]);
    add_rgb(emitter, "irradiance", entry.resolved.rgb);
    return Done{};
  }
  const double distance = 1e5 * writer.extent_m;
  Transform disk = facing_forward(frame);
  disk.translation = (writer.bounds.min + writer.bounds.max) * 0.5 + frame.columns[2] * distance;
  const double radius = distance * std::tan(distant.diameter_rad / 2);
  pugi::xml_node shape = add_plugin(writer.root, "shape", "disk", entry.id);
  add_matrix(shape, "to_world", scaled(disk, {radius, radius, 1}));
  add_rgb(add_plugin(shape, "emitter", "area"), "radiance", entry.resolved.rgb);
  return Done{};
}

}  // namespace etendue::mitsuba
