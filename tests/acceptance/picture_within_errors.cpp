// picture_luminance over random rectangles with a picture: what was asked against what was kept. For each tolerance a line: tolerance,
// configurations, those without an answer, those whose answer nothing is known of, answers that were off by more than asked, by more than
// told, the worst error in units of the tolerance, mean cells, mean microseconds of this thread. Half of the lights cross the horizon, half
// of the views have the mirror direction inside the light; surfaces are Lambert, GGX of f0 .04 and alpha from .05 and a standard material
// in turns. The truth is the same light asked for a fiftieth; what that has no answer to is counted as unanswered. Its independence is
// tests/acceptance/cards' own (samples).
//   picture_within_errors CONFIGURATIONS SEED PICTURE
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "etendue/picture.h"
#include "etendue/picture_light.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

double microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

ShadingPoint point_for(const Placement& p, int turn, Random& random) {
  Vec3d view = random.direction();
  while (dot(view, p.normal) < 0.05) view = random.direction();
  for (int attempt = 0; turn % 4 < 2 && attempt < 50; ++attempt) {
    const LightSample s = sample_light(p.emitter, p.position, random.square());
    const double cosine = dot(s.direction, p.normal);
    if (!(s.pdf > 0 && cosine > 0.05)) continue;
    view = p.normal * (2 * cosine) - s.direction;
    break;
  }
  const double alpha = random.log_uniform(0.05, 1), roughness = random.uniform(0.3, 1);
  const std::array<Brdf, 3> surfaces{Lambert{{1, 1, 1}}, GgxLobe{alpha}, Standard{{0.7, 0.4, 0.2}, 0.2, roughness}};
  return {p.position, p.normal, p.normal, view, surfaces[static_cast<std::size_t>(turn / 4 % 3)]};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int configurations = std::atoi(argv[1]), seed = std::atoi(argv[2]);
  Result<DecodedImage> image = decode({argv[3], nullptr, "", ""}, Encoding::srgb);
  if (!image) {
    fmt::print(stderr, "{}\n", image.error().text);
    return 1;
  }
  const Pattern pattern = [&](Vec2d uv) {
    const Rgba texel = sample(*image, Texture{}, uv);
    return Rgb{texel.r, texel.g, texel.b};
  };
  const PictureMoments picture(pattern, image->width, image->height);
  const Rgb mean = picture.mean();
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    Random random(static_cast<unsigned>(seed));
    int unanswered = 0, unknown = 0, beyond = 0, beyond_told = 0;
    double worst = 0, cells = 0, spent = 0;
    for (int i = 0; i < configurations; ++i) {
      const Placement p = place(Kind::rect, random, i % 2 == 0);
      const ShadingPoint point = point_for(p, i, random);
      const double floor = 1e-3 * lux_at(p.emitter, p.position, p.normal) * std::max({mean.x, mean.y, mean.z});
      const double begin = microseconds();
      const auto found = picture_luminance(p.emitter, picture, point, {tolerance, tolerance * floor});
      spent += microseconds() - begin;
      const auto truth = picture_luminance(p.emitter, picture, point, {0.1 * tolerance, 0.1 * tolerance * floor});
      unanswered += found ? 0 : 1, unknown += found && !truth ? 1 : 0;
      if (!found || !truth) continue;
      double off = 0, of_told = 0;
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(found->value[c] - truth->value[c]);
        off = std::max(off, error / (tolerance * std::max(truth->value[c], floor)));
        of_told = std::max(of_told, error / (found->error[c] + truth->error[c] + 1e-300));
      }
      constexpr double evaluations_of_a_cell = 13;
      cells += static_cast<double>(found->evaluations) / evaluations_of_a_cell;
      worst = std::max(worst, off);
      beyond += off > 1 ? 1 : 0, beyond_told += of_told > 1 ? 1 : 0;
    }
    fmt::print("{} {} {} {} {} {} {:.3f} {:.0f} {:.1f}\n", tolerance, configurations, unanswered, unknown, beyond, beyond_told, worst,
               cells / std::max(configurations - unanswered - unknown, 1), spent / configurations);
  }
}
