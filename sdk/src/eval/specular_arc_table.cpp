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
  bool inside = false, doubtful = false;
};
struct SeenFrom {
  const Vec3d& position;
  const ViewFrame& frame;
  const Vec3d& mirror;
  bool two_sided;

  Seen operator()(const DiskSeen& disk) const {
    const Vec3d centre = frame.vector(disk.centre - position), normal = frame.vector(disk.normal);
    const Contour outline = disk_silhouette(centre, normal, disk.radius, two_sided);
    if (outline.empty()) return {};
    const double reach = disk.radius * std::sqrt(std::max(1 - normal.z * normal.z, 0.0));
    return {above_horizon(outline, centre.z - reach), hit_disk(centre, normal, disk.radius, Vec3d{}, mirror).has_value()};
  }
  // From within a tube that emits there too all of the sky is lit.
  Seen operator()(const TubeSeen& tube) const {
    const Vec3d a = frame.vector(tube.a - position), b = frame.vector(tube.b - position);
    const Contour outline = tube_silhouette(a, b, tube.radius, tube.caps);
    if (outline.empty()) return {{}, false, two_sided && inside_tube(a, b, tube.radius, tube.caps)};
    return {above_horizon(outline, std::min(a.z, b.z) - tube.radius),
            hit_tube({a, b, tube.radius, tube.caps}, Vec3d{}, mirror).has_value()};
  }
  template <class Other>
  Seen operator()(const Other&) const {
    return {};
  }

 private:
  // `lowest`: that of the whole light; where it is above there is nothing to cut.
  static Contour above_horizon(const Contour& outline, double lowest) { return lowest > 0 ? outline : clipped(outline, Vec3d{0, 0, 1}); }
};

// Quarters of a turn; eighths of a rim that is close to the point: |b|^2 = m + rho cos s is 0 arcosh(m / rho) beside the arc, and of rules
// over quarters that bends no more than the lobe does from 2.3 on.
std::size_t parts_of(const Arc& arc) {
  const double m = dot(arc.centre, arc.centre) + dot(arc.u, arc.u), rho = 2 * std::hypot(dot(arc.centre, arc.u), dot(arc.centre, arc.v));
  const bool close = !arc.unit && m < 5 * rho;
  return static_cast<std::size_t>(std::max(1.0, std::ceil((arc.end - arc.begin) / ((close ? 0.25 : 0.5) * pi) - 1e-9)));
}

bool has_rims(const OutlinedLight& light) {
  const auto* tube = std::get_if<TubeSeen>(&light.shape);
  return tube == nullptr || tube->caps != Caps::round;
}

}  // namespace

// Sine and cosine are turned from part to part.
void ArcTable::put(std::size_t first, std::size_t parts, std::size_t point, const Arc& whole) {
  const double span = (whole.end - whole.begin) / static_cast<double>(parts), middle = whole.begin + 0.5 * span;
  const double turn_c = std::cos(span), turn_s = std::sin(span), to_end = std::tan(0.25 * span);
  double cs = std::cos(middle), sn = std::sin(middle);
  const double size = whole.unit ? 1 : 1 / std::max(length(whole.centre), length(whole.u));
  const Vec3d centre = whole.centre * size;
  for (std::size_t part = first; part < first + parts; ++part) {
    const Vec3d u = (whole.u * cs + whole.v * sn) * size, v = (whole.v * cs - whole.u * sn) * size;
    const std::array<double, numbers> all{centre.x, centre.y, centre.z, u.x, u.y, u.z, v.x, v.y, v.z, to_end};
    for (std::size_t k = 0; k < numbers; ++k) arc[k][part * points_at_once + point] = all[k];
    const double next = cs * turn_c - sn * turn_s;
    sn = sn * turn_c + cs * turn_s, cs = next;
  }
}

void fill_arcs(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, ArcTable& table) {
  constexpr std::size_t all_arcs = ArcTable::most_arcs + ArcTable::along_horizon;
  for (std::vector<double>& numbers : table.arc) numbers.resize(all_arcs * points_at_once);
  std::fill(table.arc[ArcTable::reach].begin(), table.arc[ArcTable::reach].end(), 0.0);
  table.illuminance.fill(0), table.inside.fill(false), table.doubtful.fill(false);
  table.arcs = 0, table.rims = has_rims(light);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t k) { return Vec3d{places.numbers[k][i], places.numbers[k + 1][i], places.numbers[k + 2][i]}; };
    const Vec3d position = at(0), normal = normalised(at(3)), view = normalised(at(6));
    if (!(dot(normal, view) > 0) || !(dot(position, position) < 1e200)) continue;
    const ViewFrame frame(normal, view);
    const Vec3d local_view = frame.vector(view);
    const Vec3d mirror{-local_view.x, -local_view.y, local_view.z};
    const Seen seen = std::visit(SeenFrom{position, frame, mirror, light.two_sided}, light.shape);
    if (table.rims) table.illuminance[i] = direction_integral(seen.lit).z;
    table.inside[i] = seen.inside, table.doubtful[i] = seen.doubtful;
    std::size_t arcs = 0, level = 0;
    for (const Arc& arc : seen.lit) {
      const bool horizon = along_horizon(arc);
      const std::size_t parts = parts_of(arc), most = horizon ? ArcTable::along_horizon : ArcTable::most_arcs;
      std::size_t& found = horizon ? level : arcs;
      if (found + parts > most) {
        table.doubtful[i] = true;
        continue;
      }
      table.put(horizon ? ArcTable::most_arcs + found : found, parts, i, arc);
      found += parts;
    }
    table.arcs = std::max(table.arcs, arcs);
  }
}

}  // namespace etendue::eval
