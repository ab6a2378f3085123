// The web as a body, seen from a little above.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "photometric_diagrams.h"
#include "svg.h"

namespace etendue::cli {
namespace {

constexpr double width = 680, height = 700, scale = 245;
constexpr Vec2d middle{width / 2, 372};
constexpr int planes = 48;

// Seen from C 225, 22 degrees above the horizon, without perspective: `right` and `up` on the sheet, `depth` towards the eye.
struct Seen {
  Vec2d at;
  double depth;
};
Seen seen(const Vec3d& p) {
  const double turn = 55 * pi / 180, tip = 22 * pi / 180;
  const double right = p.x * std::cos(turn) + p.y * std::sin(turn), away = -p.x * std::sin(turn) + p.y * std::cos(turn);
  return {{middle.x + scale * right, middle.y - scale * (p.z * std::cos(tip) + away * std::sin(tip))},
          p.z * std::sin(tip) - away * std::cos(tip)};
}

// Angles that follow the body: even in a mean of the angle and of how far the brightest profile moves, so that narrow beams get enough.
std::vector<double> gammas_of(const IntensityWeb& web) {
  constexpr int fine = 720, count = 64;
  std::vector<double> walked{0};
  double before = 0;
  for (int i = 0; i <= fine; ++i) {
    double most = 0;
    for (int c = 0; c < 360; c += 15) most = std::max(most, web.at(c, 180.0 * i / fine));
    const double share = most / web.max_cd();
    if (i > 0) walked.push_back(walked.back() + 2.0 / fine + std::abs(share - before));
    before = share;
  }
  std::vector<double> gammas;
  for (int k = 0; k <= count; ++k) {
    const double wanted = walked.back() * k / count;
    const auto next = std::lower_bound(walked.begin(), walked.end(), wanted);
    gammas.push_back(180.0 * static_cast<double>(next - walked.begin()) / fine);
  }
  gammas.back() = 180;
  gammas.erase(std::unique(gammas.begin(), gammas.end()), gammas.end());
  return gammas;
}

struct Face {
  std::array<Vec2d, 4> corners;
  double depth, share, shade;
};

std::vector<Face> faces_of(const IntensityWeb& web) {
  const std::vector<double> gammas = gammas_of(web);
  std::vector<Vec3d> points;
  for (const double gamma : gammas)
    for (int j = 0; j < planes; ++j) {
      const double c = 360.0 * j / planes;
      points.push_back(direction_of(WebType::c, {gamma, c}) * (web.at(c, gamma) / web.max_cd()));
    }
  std::vector<Face> faces;
  for (std::size_t i = 0; i + 1 < gammas.size(); ++i) {
    for (std::size_t j = 0; j < planes; ++j) {
      const std::size_t next = (j + 1) % planes;
      const std::array<Vec3d, 4> p{points[i * planes + j], points[i * planes + next], points[(i + 1) * planes + next],
                                   points[(i + 1) * planes + j]};
      Face face{{}, 0, 0, 1};
      for (std::size_t k = 0; k < 4; ++k) {
        const Seen s = seen(p[k]);
        face.corners[k] = s.at;
        face.depth += s.depth / 4;
        face.share += length(p[k]) / 4;
      }
      if (!(face.share > 1e-4)) continue;
      // Light from the upper left, softened: a face turned away keeps two thirds.
      const Vec3d normal = cross(p[2] - p[0], p[3] - p[1]);
      const double size = length(normal);
      if (size > 0) face.shade = 0.83 + 0.17 * std::abs(dot(normal * (1 / size), Vec3d{-0.35, -0.55, 0.76}));
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.depth < b.depth; });
  return faces;
}

// A circle of the horizontal plane through the light: the half behind it first, then the other.
void draw_ring(SvgSheet& sheet, bool behind) {
  std::vector<Vec2d> run;
  const auto flush = [&] {
    sheet.path(run, false, "axis");
    run.clear();
  };
  for (int c = 0; c <= 360; c += 3) {
    const Seen s = seen(direction_of(WebType::c, {90, static_cast<double>(c)}));
    if ((s.depth < 0) == behind) {
      run.push_back(s.at);
    } else {
      flush();
    }
  }
  flush();
  for (int c = 0; c < 360; c += 90) {
    const Vec3d u = direction_of(WebType::c, {90, static_cast<double>(c)});
    if ((seen(u).depth < 0) != behind) continue;
    sheet.line(seen({0, 0, 0}).at, seen(u).at, "axis");
    const Vec2d at = seen(u * 1.1).at;
    sheet.text({at.x, at.y + 4}, fmt::format("C{}", c), "soft halo", "middle");
  }
}

void draw_pole(SvgSheet& sheet, double z, const char* name) {
  sheet.line(seen({0, 0, 0}).at, seen({0, 0, z}).at, "axis");
  const Vec2d at = seen({0, 0, z * 1.06}).at;
  sheet.text({at.x, at.y + (z < 0 ? 12 : 0)}, name, "soft halo", "middle");
}

}  // namespace

std::string web_svg(const IntensityWeb& web, const std::string& title) {
  SvgSheet sheet(width, height);
  sheet.heading(title, key_figures(web));
  draw_ring(sheet, true);
  draw_pole(sheet, 1.08, "zenith");
  draw_pole(sheet, -1.08, "nadir");
  if (web.max_cd() > 0)
    for (const Face& face : faces_of(web)) {
      const std::string colour = ramp_colour(std::sqrt(face.share), face.shade);
      std::string points;
      for (const Vec2d& p : face.corners) points += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
      points.pop_back();
      sheet.raw(fmt::format("<polygon points=\"{0}\" fill=\"{1}\" stroke=\"{1}\" stroke-width=\".4\"/>\n", points, colour));
    }
  draw_ring(sheet, false);
  const double y = height - 40;
  constexpr int steps = 48;
  for (int i = 0; i < steps; ++i)
    sheet.raw(fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"5.2\" height=\"10\" fill=\"{}\"/>\n", 24 + 5.0 * i, y,
                          ramp_colour(std::sqrt((i + 0.5) / steps))));
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    sheet.text({24 + 240 * share, y + 26}, fmt::format("{:.4g}", share * web.max_cd()), "soft", "middle", 11);
  sheet.text({24 + 252, y + 9}, "cd", "soft", "start", 11);
  return sheet.str();
}

}  // namespace etendue::cli
