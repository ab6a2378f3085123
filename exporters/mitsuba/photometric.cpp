// Photometric lights as up to six projectors, one for each lit face of a cube about the light.
#include "etendue/eval.h"
#include "etendue/intensity_web.h"
#include "projector.h"

#include <algorithm>

namespace etendue::mitsuba {
namespace {

// Left, up and forward of a face in the light's own frame; left x up = forward.
struct Face {
  Vec3d left, up, forward;
  const char* name;
};
constexpr Face faces[] = {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}, "nadir"}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, "zenith"},
                          {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, "c0"},      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, "c90"},
                          {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}, "c180"},  {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, "c270"}};

double cosine_at(double x, double y) { return 1 / std::sqrt(1 + x * x + y * y); }
double intensity_at(const IntensityWeb& web, const Face& face, double x, double y) {
  return web.towards(face.left * x + face.up * y + face.forward);
}

// pi t of one face, row by row.
class FaceTable {
 public:
  FaceTable(const IntensityWeb& web, const Face& face, int texels) : texels_(texels) {
    values_.reserve(static_cast<std::size_t>(texels) * static_cast<std::size_t>(texels));
    for (int row = 0; row < texels; ++row) {
      for (int column = 0; column < texels; ++column) {
        const double x = centre(column), y = centre(row), cosine = cosine_at(x, y);
        values_.push_back(intensity_at(web, face, x, y) * cosine * cosine * cosine);
      }
    }
  }

  // Bilinear interpolation, clamped at the border, sends the texels' sum over all of the face: d omega = cos^3 dx dy.
  double flux() const {
    double sum = 0;
    for (const double value : values_) sum += value;
    return sum * 4 / (static_cast<double>(texels_) * texels_);
  }

  // Largest difference in cd half-way between texels, where bilinear interpolation is furthest off, and on the border.
  double error(const IntensityWeb& web, const Face& face) const {
    double worst = 0;
    for (int row = 0; row <= texels_; ++row) {
      for (int column = 0; column <= texels_; ++column) {
        const double x = 1 - 2.0 * column / texels_, y = 1 - 2.0 * row / texels_, cosine = cosine_at(x, y);
        const double sent = (at(row - 1, column - 1) + at(row - 1, column) + at(row, column - 1) + at(row, column)) / 4;
        worst = std::max(worst, std::abs(sent / (cosine * cosine * cosine) - intensity_at(web, face, x, y)));
      }
    }
    return worst;
  }

  std::vector<float> texture(const Rgb& rgb) const {
    std::vector<float> pixels;
    pixels.reserve(values_.size() * 3);
    for (const double value : values_)
      for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<float>(rgb[c] * value / pi));
    return pixels;
  }

 private:
  double centre(int i) const { return 1 - 2 * (i + 0.5) / texels_; }
  double at(int row, int column) const {
    return values_[static_cast<std::size_t>(std::clamp(row, 0, texels_ - 1)) * static_cast<std::size_t>(texels_) +
                   static_cast<std::size_t>(std::clamp(column, 0, texels_ - 1))];
  }
  int texels_;
  std::vector<double> values_;
};

// The smallest faces whose light is off by at most .5 % of the peak anywhere, up to 1024 texels. Where a table ends brightly, its edge is
// blurred by a texel of any size: more of them are no better.
struct Cube {
  int texels = 0;
  double error_cd = 0, flux_lm = 0;
  std::vector<FaceTable> tables;
};
Cube cube_of(const IntensityWeb& web) {
  constexpr double wanted = 5e-3;
  constexpr int fewest = 128, most = 1024;
  Cube cube;
  double coarser_cd = HUGE_VAL;
  for (int texels = fewest; texels <= most; texels *= 2) {
    cube = {texels, 0, 0, {}};
    for (const Face& face : faces) {
      const FaceTable& table = cube.tables.emplace_back(web, face, texels);
      cube.flux_lm += table.flux();
      cube.error_cd = std::max(cube.error_cd, table.error(web, face));
    }
    if (cube.error_cd <= wanted * web.max_cd() || cube.error_cd > 0.9 * coarser_cd) break;
    coarser_cd = cube.error_cd;
  }
  return cube;
}

}  // namespace

Status write_photometric(Writer& writer, const LightEntry& entry) {
  if (!std::get<PhotometricShape>(entry.light.shape).distribution)
    return unsupported("light '" + entry.light.name + "' names a photometric file that was not read", entry.light.source);
  const Result<eval::Emitter> emitter = eval::emitter_of(entry.light);
  if (!emitter) return emitter.error();
  const auto& punctual = std::get<eval::PunctualEmitter>(emitter->shape);
  const IntensityWeb& web = *std::get<eval::ProfileShape>(punctual.shape).web;
  if (!(web.flux_lm() > 0)) return Done{};
  const Cube cube = cube_of(web);
  if (!(cube.flux_lm > 0))
    return unsupported("light '" + entry.light.name + "' has a beam narrower than the texels of a cube about it", entry.light.source);
  // Texels are samples, not means: the whole is brought back to its flux.
  const double correction = web.flux_lm() / cube.flux_lm;
  const Transform& frame = entry.light.transform;
  for (std::size_t i = 0; i < cube.tables.size(); ++i) {
    const FaceTable& table = cube.tables[i];
    const Face& face = faces[i];
    if (!(table.flux() > 0)) continue;
    const auto texels = static_cast<std::uint32_t>(cube.texels);
    Result<std::string> file = writer.assets.add_picture(texels, texels, table.texture(punctual.intensity * correction));
    if (!file) return file.error();
    const Transform to_world{{frame.vector(face.left), frame.vector(face.up), frame.vector(face.forward)}, frame.translation};
    pugi::xml_node projector = add_projector(writer, entry.id + "_" + face.name, *file, pi / 2, to_world);
    add_float(projector, "sampling_weight", table.flux() / cube.flux_lm);
  }
  const double off = cube.error_cd * correction + web.max_cd() * std::abs(correction - 1);
  writer.losses.add(name_for_losses(entry.light) + ": photometric web",
                    "six faces of " + std::to_string(cube.texels) + " texels a side: off by up to " +
                        text_of(std::round(1e5 * off / web.max_cd()) / 1e3) + " % of the peak, its flux is kept");
  return Done{};
}

}  // namespace etendue::mitsuba
