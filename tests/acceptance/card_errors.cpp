// Light of pictures on rectangles against samples of both light and lobe. For each picture and lobe (lambert, or GGX's f0) a line: picture,
// lobe, method, aggregate error (sum of |x - reference| over that of the reference, all channels), that of the worst alpha, this alpha,
// share of the answers that are further off than three times the error told, mean number of closed forms (of moments: of cells),
// microseconds, mean standard error of the reference over the reference. Half of the lights cross the horizon, half of the views have the
// mirror direction inside the light. Arguments: geometries, tolerance, pictures.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "etendue/light_card.h"
#include "etendue/picture.h"
#include "etendue/picture_light.h"
#include "etendue/probe.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr double alphas[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1};

// Both strategies, side^2 jittered samples of each; the balance heuristic divides by the sum of their densities.
struct Sampled {
  Rgb value, error;
};
Sampled sampled(const Emitter& emitter, const ShadingPoint& point, int side, Random& random) {
  const Basis frame = shading_basis(point);
  const auto local = [&](const Vec3d& v) { return Vec3d{dot(frame.tangent, v), dot(frame.bitangent, v), dot(frame.normal, v)}; };
  const Vec3d view = local(point.view);
  constexpr int parts = 4;
  std::array<Rgb, parts> sums;
  for (Rgb& sum : sums) {
    for (int i = 0; i < side * side; ++i) {
      const int column = i % side, row = i / side;
      const auto jittered = [&] { return Vec2d{(column + random.uniform(0, 1)) / side, (row + random.uniform(0, 1)) / side}; };
      const LightSample light = sample_light(emitter, point.position, jittered());
      if (light.pdf > 0) {
        const Vec3d l = local(light.direction);
        sum += brdf_cos(point.brdf, view, l) * light.radiance / (light.pdf + pdf_brdf(point.brdf, view, l));
      }
      const DirectionSample facet = sample_brdf(point.brdf, view, jittered());
      if (!(facet.pdf > 0)) continue;
      const Vec3d world = frame.tangent * facet.direction.x + frame.bitangent * facet.direction.y + frame.normal * facet.direction.z;
      const LightSample met = light_along(emitter, point.position, world);
      if (met.pdf > 0) sum += brdf_cos(point.brdf, view, facet.direction) * met.radiance / (met.pdf + facet.pdf);
    }
    sum = sum / static_cast<double>(side * side);
  }
  Sampled out;
  for (const Rgb& sum : sums) out.value += sum / parts;
  for (int c = 0; c < 3; ++c) {
    double squares = 0;
    for (const Rgb& sum : sums) squares += (sum[c] - out.value[c]) * (sum[c] - out.value[c]);
    out.error[c] = std::sqrt(squares / (parts * (parts - 1)));
  }
  return out;
}

double sum_of(const Rgb& c) { return std::abs(c.x) + std::abs(c.y) + std::abs(c.z); }

struct Subject {
  std::string name;
  std::shared_ptr<const DecodedImage> pixels;
  LightCard card;
  std::shared_ptr<const PictureMoments> moments;
};
Pattern pattern_of(const std::shared_ptr<const DecodedImage>& pixels) {
  return [pixels](Vec2d uv) {
    Texture clamped;
    clamped.wrap_u = clamped.wrap_v = Wrap::clamp;
    const Rgba texel = sample(*pixels, clamped, uv);
    return Rgb{texel.r, texel.g, texel.b};
  };
}
Result<Subject> read(const std::string& file) {
  Result<DecodedImage> image = decode({file, nullptr, "", ""}, Encoding::srgb);
  if (!image) return image.error();
  LightCardBuilder builder(image->width, image->height);
  const Status read = decode_rows({file, nullptr, "", ""}, Encoding::srgb, [&](const ImageRow& row) { builder.add_row(row.rgba); });
  if (!read) return read.error();
  auto pixels = std::make_shared<const DecodedImage>(std::move(*image));
  auto moments = std::make_shared<const PictureMoments>(pattern_of(pixels), pixels->width, pixels->height);
  return Subject{std::filesystem::path(file).stem().string(), std::move(pixels), std::move(builder).finish(), std::move(moments)};
}

Vec3d view_for(const Placement& p, bool mirrored, Random& random) {
  for (;;) {
    Vec3d view = random.direction();
    if (mirrored) {
      const LightSample s = sample_light(p.emitter, p.position, random.square());
      if (!(s.pdf > 0) || !(dot(s.direction, p.normal) > 0)) continue;
      view = p.normal * (2 * dot(p.normal, s.direction)) - s.direction;
    }
    if (dot(view, p.normal) >= 0.05) return view;
  }
}

struct Tally {
  double error = 0, reference = 0, noise = 0;
  int beyond = 0, count = 0;
  double patches = 0, microseconds = 0;

  void add(const Rgb& found, const Rgb& told, const Sampled& expected, int forms, double spent) {
    const double off = sum_of(found - expected.value);
    error += off, reference += sum_of(expected.value), noise += sum_of(expected.error);
    beyond += off > 3 * (sum_of(told) + sum_of(expected.error)) ? 1 : 0;
    ++count, patches += forms, microseconds += spent;
  }
};

void print(std::string_view picture, std::string_view lobe, std::string_view method, std::span<const Tally> by_alpha) {
  Tally all;
  double worst = 0, worst_alpha = 0;
  for (std::size_t a = 0; a < by_alpha.size(); ++a) {
    const Tally& t = by_alpha[a];
    all.error += t.error, all.reference += t.reference, all.noise += t.noise, all.beyond += t.beyond, all.count += t.count;
    all.patches += t.patches, all.microseconds += t.microseconds;
    if (t.reference > 0 && t.error / t.reference > worst) worst = t.error / t.reference, worst_alpha = alphas[a];
  }
  if (all.count == 0) return;
  fmt::print("{} {} {} {:.4f} {:.4f} {} {:.4f} {:.0f} {:.0f} {:.4f}\n", picture, lobe, method, all.error / all.reference, worst,
             worst_alpha, static_cast<double>(all.beyond) / all.count, all.patches / all.count, all.microseconds / all.count,
             all.noise / all.reference);
}

}  // namespace

int main(int argc, char** argv) {
  const int geometries = argc > 1 ? std::atoi(argv[1]) : 100;
  const double tolerance = argc > 2 ? std::atof(argv[2]) : 0.01;
  for (int file = 3; file < argc; ++file) {
    const Result<Subject> picture = read(argv[file]);
    if (!picture) {
      fmt::print(stderr, "{}\n", picture.error().text);
      return 1;
    }
    // Of Lambert, F = 1 and f0 = .04; of moments, patches and each lookup by name. What moments have no answer to is left out of theirs.
    std::vector<std::array<std::array<Tally, std::size(alphas)>, 3>> tallies(2 + card_methods().size());
    Random random(7);
    for (int i = 0; i < geometries; ++i) {
      Placement p = place(Kind::rect, random, i % 2 == 0);
      p.emitter.pattern = pattern_of(picture->pixels);
      std::vector<CardLookups> lookups;
      for (const CardMethod& m : card_methods()) lookups.push_back(m.lookups(p.emitter, picture->card));
      for (std::size_t a = 0; a < std::size(alphas); ++a) {
        const Vec3d view = view_for(p, i % 4 < 2, random);
        for (std::size_t lobe = 0; lobe < 3; ++lobe) {
          if (lobe == 0 && a > 0) continue;
          const double f0 = lobe == 1 ? 1 : 0.04;
          ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{alphas[a], {f0, f0, f0}}};
          if (lobe == 0) point.brdf = Lambert{{1, 1, 1}};
          const Sampled expected = sampled(p.emitter, point, 64, random);
          const auto go = std::chrono::steady_clock::now();
          const auto within = picture_luminance(p.emitter, *picture->moments, point, {tolerance, 0});
          const std::chrono::duration<double, std::micro> passed = std::chrono::steady_clock::now() - go;
          constexpr int evaluations_of_a_cell = 13;
          if (within) {
            const auto cells = static_cast<int>(within->evaluations / evaluations_of_a_cell);
            tallies[1][lobe][a].add(within->value, within->error, expected, cells, passed.count());
          }
          const auto start = std::chrono::steady_clock::now();
          const auto found = by_patches(p.emitter, picture->card, point, {tolerance, 4096});
          const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - start;
          tallies[0][lobe][a].add(found->value, found->error, expected, found->patches, spent.count());
          for (std::size_t m = 0; m < card_methods().size(); ++m) {
            const auto begin = std::chrono::steady_clock::now();
            const auto looked_up = card_methods()[m].luminance(p.emitter, lookups[m], point);
            const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
            if (looked_up) tallies[m + 2][lobe][a].add(*looked_up, {}, expected, 1, taken.count());
          }
        }
      }
    }
    for (std::size_t lobe = 0; lobe < 3; ++lobe) {
      for (std::size_t m = 0; m < tallies.size(); ++m)
        print(picture->name,
              lobe == 0   ? "lambert"
              : lobe == 1 ? "1"
                          : ".04",
              m == 0   ? "patches"
              : m == 1 ? "moments"
                       : card_methods()[m - 2].name,
              tallies[m][lobe]);
    }
  }
}
