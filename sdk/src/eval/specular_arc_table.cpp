#include "specular_arc_table.h"

#include "hit.h"
#include "silhouette.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

bool along_horizon(const Arc& arc) { return arc.great_circle() && std::abs(arc.u.z) < 1e-14 && std::abs(arc.v.z) < 1e-14; }

// What is above the horizon of z of the light's outline, in the point's own frame, and whether the ray along `mirror` meets the light.
struct Seen {
  Contour lit;
  bool inside;
};
Seen seen_from(const CapsuleSeen& tube, const Vec3d& position, const ViewFrame& frame, const Vec3d& mirror) {
  const Vec3d a = frame.vector(tube.a - position), b = frame.vector(tube.b - position);
  const Contour outline = tube_silhouette(a, b, tube.radius, Caps::round);
  if (outline.empty()) return {};
  return {clipped(outline, Vec3d{0, 0, 1}), hit_tube({a, b, tube.radius, Caps::round}, Vec3d{}, mirror).has_value()};
}

}  // namespace

void ArcTable::put(std::size_t index, std::size_t point, const Arc& part) {
  const double middle = 0.5 * (part.begin + part.end), cs = std::cos(middle), sn = std::sin(middle);
  const Vec3d u = part.u * cs + part.v * sn, v = part.v * cs - part.u * sn;
  const std::array<double, numbers> all{part.centre.x, part.centre.y, part.centre.z, u.x, u.y,
                                        u.z,           v.x,           v.y,           v.z, std::tan(0.25 * (part.end - part.begin))};
  for (std::size_t k = 0; k < numbers; ++k) arc[k][index * points_at_once + point] = all[k];
}

void fill_arcs(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, ArcTable& table) {
  const CapsuleSeen& tube = *std::get_if<CapsuleSeen>(&light.shape);
  constexpr std::size_t all_arcs = ArcTable::most_arcs + ArcTable::along_horizon;
  for (std::vector<double>& numbers : table.arc) numbers.resize(all_arcs * points_at_once);
  std::fill(table.arc[ArcTable::reach].begin(), table.arc[ArcTable::reach].end(), 0.0);
  table.illuminance.fill(0), table.inside.fill(false), table.doubtful.fill(false);
  table.arcs = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t k) { return Vec3d{places.numbers[k][i], places.numbers[k + 1][i], places.numbers[k + 2][i]}; };
    const Vec3d position = at(0), normal = normalised(at(3)), view = normalised(at(6));
    if (!(dot(normal, view) > 0) || !(dot(position, position) < 1e200)) continue;
    const ViewFrame frame(normal, view);
    const Vec3d local_view = frame.vector(view);
    const Seen seen = seen_from(tube, position, frame, {-local_view.x, -local_view.y, local_view.z});
    table.illuminance[i] = direction_integral(seen.lit).z, table.inside[i] = seen.inside;
    std::size_t arcs = 0, level = 0;
    for (const Arc& arc : seen.lit) {
      const bool horizon = along_horizon(arc);
      const int parts = std::max(1, static_cast<int>(std::ceil((arc.end - arc.begin) / (0.5 * pi) - 1e-9)));
      const double span = (arc.end - arc.begin) / parts;
      for (int k = 0; k < parts; ++k) {
        Arc part = arc;
        part.begin = arc.begin + k * span, part.end = part.begin + span;
        std::size_t& found = horizon ? level : arcs;
        if (found == (horizon ? ArcTable::along_horizon : ArcTable::most_arcs)) {
          table.doubtful[i] = true;
        } else {
          table.put(horizon ? ArcTable::most_arcs + found : found, i, part);
          ++found;
        }
      }
    }
    table.arcs = std::max(table.arcs, arcs);
  }
}

}  // namespace etendue::eval
