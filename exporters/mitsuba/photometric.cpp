// Photometric lights: a textured spot where all light goes into a cone, else up to six projectors, one for each lit face of a cube about
// the light; or, where Mitsuba has our own emitter, the web itself.
#include "etendue/eval.h"
#include "etendue/photometric_bake.h"
#include "projector.h"
#include "web_spot.h"

#include <algorithm>
#include <optional>

namespace etendue::mitsuba {
namespace {

// Pictures are chosen so that light is off by at most this share of the peak anywhere, where a size from the fewest to the most texels can.
constexpr double wanted = 5e-3;
constexpr std::uint32_t fewest_texels = 128, most_texels = 1024;

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + text_of(value);
  return text;
}

bool mirrors(WebSymmetry s, WebSymmetry one) { return s == one || s == WebSymmetry::lateral_and_vertical; }

// emitters.py says what its parameters mean.
Status write_plugin(Writer& writer, const LightEntry& entry, const IntensityWeb& web, const std::optional<SpotShape>& cone,
                    const Rgb& factor) {
  const std::vector<double>& polar = web.polar().nodes();
  std::vector<double> azimuth = web.azimuth().nodes();
  if (azimuth.empty()) azimuth = {0};
  std::vector<float> table;
  table.reserve(polar.size() * azimuth.size() * 3);
  for (std::size_t j = 0; j < azimuth.size(); ++j)
    for (std::size_t i = 0; i < polar.size(); ++i)
      for (int c = 0; c < 3; ++c) table.push_back(static_cast<float>(factor[c] * web.node(j, i)));
  Result<std::string> file =
      writer.assets.add_picture(static_cast<std::uint32_t>(polar.size()), static_cast<std::uint32_t>(azimuth.size()), std::move(table));
  if (!file) return file.error();
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "etendue_web", entry.id);
  const bool type_a = web.type() == WebType::a;
  constexpr double never = 1e9;
  add_string(emitter, "filename", *file);
  add_string(emitter, "polar", numbers(polar));
  add_string(emitter, "azimuth", numbers(azimuth));
  add_string(emitter, "type", std::string(name_of(web.type())));
  add_float(emitter, "turn", web.frame().turn_deg);
  add_boolean(emitter, "clockwise", web.frame().clockwise);
  add_float(emitter, "half", web.type() == WebType::c && web.copies() > 1 ? 180 : never);
  add_float(emitter, "quarter", web.symmetry() == WebSymmetry::quadrant ? 90 : never);
  add_boolean(emitter, "mirror_polar", mirrors(web.symmetry(), type_a ? WebSymmetry::vertical : WebSymmetry::lateral));
  add_boolean(emitter, "mirror_azimuth", mirrors(web.symmetry(), type_a ? WebSymmetry::lateral : WebSymmetry::vertical));
  add_float(emitter, "cone_inner", cone ? cone->inner_rad * 180 / pi : 180);
  add_float(emitter, "cone_outer", cone ? cone->outer_rad * 180 / pi : 180);
  add_window(emitter, entry.light);
  add_matrix(emitter, "to_world", entry.light.transform.rigid());
  return Done{};
}

void report(Writer& writer, const LightEntry& entry, const std::string& what, double error_cd, const IntensityWeb& web) {
  const double percent = std::ceil(1e5 * error_cd / web.max_cd()) / 1e3;
  writer.losses.add(name_for_losses(entry.light) + ": photometric web",
                    what + ": off by up to " + text_of(percent) + " % of the peak, its flux is kept");
}

// Columns and rows of a face's picture run as Mitsuba's projector wants them; it sends pi t / cos^3 for a value of t, and texels hold I
// cos^3.
Status write_cube(Writer& writer, const LightEntry& entry, const IntensityWeb& web, const Rgb& factor, const WebBake& cube) {
  const Transform& frame = entry.light.transform;
  const std::size_t texels = std::size_t{cube.width} * cube.height;
  for (std::uint32_t i = 0; i < cube.pictures; ++i) {
    const double flux = cube.flux_of_picture(i);
    if (!(flux > 0)) continue;
    std::vector<float> rgb;
    rgb.reserve(texels * 3);
    for (const float value : std::span(cube.values).subspan(i * texels, texels))
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(factor[c] * value / pi));
    Result<std::string> file = writer.assets.add_picture(cube.width, cube.height, std::move(rgb));
    if (!file) return file.error();
    const CubeFace& face = cube_faces()[i];
    const Transform to_world{{frame.vector(face.left), frame.vector(face.up), frame.vector(face.forward)}, frame.translation};
    pugi::xml_node projector = add_projector(writer, entry.id + "_" + face.name, *file, pi / 2, to_world);
    put_texels_on_edges(projector.child("texture"), cube.width);
    add_float(projector, "sampling_weight", flux / cube.flux_lm);
  }
  report(writer, entry, "six faces of " + std::to_string(cube.width) + " texels a side", cube.error_cd, web);
  return Done{};
}

Status write_spot(Writer& writer, const LightEntry& entry, const IntensityWeb& web, const Rgb& factor, const WebSpot& spot) {
  std::vector<float> rgb;
  rgb.reserve(spot.shares.size() * 3);
  for (const float share : spot.shares)
    for (int c = 0; c < 3; ++c) rgb.push_back(share);
  Result<std::string> file = writer.assets.add_picture(spot.texels, spot.texels, std::move(rgb));
  if (!file) return file.error();
  pugi::xml_node emitter = add_plugin(writer.root, "emitter", "spot", entry.id);
  add_rgb(emitter, "intensity", factor * spot.peak_cd);
  pugi::xml_node bitmap = add_clamped_bitmap(emitter, "texture", *file);
  add_boolean(bitmap, "raw", true);
  put_texels_on_edges(bitmap, spot.texels);
  const double cutoff_deg = spot.outer_rad * 180 / pi;
  add_float(emitter, "cutoff_angle", cutoff_deg);
  add_float(emitter, "beam_width", cutoff_deg * (1 - 1e-6));
  add_matrix(emitter, "to_world", facing_forward(entry.light.transform));
  report(writer, entry,
         "one spot of " + text_of(std::round(100 * cutoff_deg) / 100) + " deg with " + std::to_string(spot.texels) + " texels a side",
         spot.error_cd, web);
  return Done{};
}

}  // namespace

Status write_photometric(Writer& writer, const LightEntry& entry) {
  if (!std::get<PhotometricShape>(entry.light.shape).distribution)
    return unsupported("light '" + entry.light.name + "' names a photometric file that was not read", entry.light.source);
  const Result<eval::Emitter> emitter = eval::emitter_of(entry.light);
  if (!emitter) return emitter.error();
  const auto& punctual = std::get<eval::PunctualEmitter>(emitter->shape);
  const auto& profile = std::get<eval::ProfileShape>(punctual.shape);
  const IntensityWeb& web = *profile.web;
  if (!(web.flux_lm() > 0)) return Done{};
  if (writer.parts == MitsubaParts::with_plugins) return write_plugin(writer, entry, web, profile.cone, punctual.intensity);

  WebShade cone;
  ShadedWeb shaded{web};
  if (profile.cone) {
    cone = {[spot = *profile.cone](const Vec3d& d) { return spot_falloff(spot, -d.z); }, eval::flux_lm(profile)};
    if (!(cone.flux_lm > 0)) return Done{};
    shaded.shade = &cone;
    shaded.outer_rad = profile.cone->outer_rad;
  }
  const double wanted_cd = wanted * web.max_cd();
  const std::optional<WebSpot> spot = web_spot(shaded, wanted_cd, fewest_texels, most_texels);
  if (spot && spot->error_cd <= wanted_cd) return write_spot(writer, entry, web, punctual.intensity, *spot);
  const Result<WebBake> cube = bake_within(web, BakeLayout::cube, wanted_cd, fewest_texels, most_texels, shaded.shade);
  if (spot && !(cube && cube->error_cd < spot->error_cd)) return write_spot(writer, entry, web, punctual.intensity, *spot);
  if (!cube)
    return unsupported("light '" + entry.light.name + "' has a beam narrower than the texels of a cube about it", entry.light.source);
  return write_cube(writer, entry, web, punctual.intensity, *cube);
}

}  // namespace etendue::mitsuba
