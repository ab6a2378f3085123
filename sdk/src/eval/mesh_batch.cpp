// Emissive meshes at many points: some points at a time, and of these those that a triangle can be seen from, in vectors as a polygon.
#include "light_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

namespace etendue::eval {
namespace {

constexpr std::size_t most = 256;  // points whose numbers stay in the nearest cache

struct Triangle {
  std::array<Vec3d, 3> corners;
  Vec3d normal;
  std::shared_ptr<const LightBatch::Shape> polygon;
};

// Indices of the points in front of the triangle whose horizon it is not wholly below, as far as floats can tell; more rather than less.
std::size_t seen_from(const Triangle& triangle, const PointBatch& points, bool two_sided, std::span<std::uint16_t> index) {
  std::array<Vec3f, 3> c;
  double reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d from_origin = triangle.corners[k] - points.origin;
    c[k] = vec_cast<float>(from_origin);
    reach = std::max({reach, std::abs(from_origin.x), std::abs(from_origin.y), std::abs(from_origin.z)});
  }
  const Vec3f n = vec_cast<float>(triangle.normal);
  const float least = static_cast<float>(reach), plane = dot(n, c[0]);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.px.size(); ++i) {
    const Vec3f p{points.px[i], points.py[i], points.pz[i]}, up{points.nx[i], points.ny[i], points.nz[i]};
    // Ten roundings of what is summed.
    const float slack = 2e-6f * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + least);
    const float at = dot(up, p), highest = std::max({dot(up, c[0]), dot(up, c[1]), dot(up, c[2])}) - at;
    const bool front = two_sided || dot(n, p) - plane > -slack;
    index[count] = static_cast<std::uint16_t>(i);
    count += front && highest > -slack ? 1 : 0;
  }
  return count;
}

PointBatch part_of(const PointBatch& p, std::size_t from, std::size_t count) {
  const auto part = [&](std::span<const float> s) { return s.subspan(from, count); };
  return {part(p.px), part(p.py), part(p.pz), part(p.nx), part(p.ny), part(p.nz), p.origin};
}

class MeshBatch final : public LightBatch::Shape {
 public:
  MeshBatch(std::vector<Triangle> triangles, bool two_sided) : triangles_(std::move(triangles)), two_sided_(two_sided) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    std::size_t without = 0;
    for (std::size_t from = 0; from < sr.size(); from += most) {
      const std::size_t count = std::min(most, sr.size() - from);
      without += over_some(part_of(points, from, count), sr.subspan(from, count), where_none);
    }
    return without;
  }

 private:
  std::size_t over_some(const PointBatch& points, std::span<float> sr, float where_none) const {
    std::array<double, most> sum{};
    std::array<std::uint16_t, most> index;
    std::array<std::array<float, most>, 7> dense;
    const std::array<const float*, 6> all{points.px.data(), points.py.data(), points.pz.data(),
                                          points.nx.data(), points.ny.data(), points.nz.data()};
    for (const Triangle& triangle : triangles_) {
      const std::size_t count = seen_from(triangle, points, two_sided_, index);
      for (std::size_t c = 0; c < 6; ++c)
        for (std::size_t k = 0; k < count; ++k) dense[c][k] = all[c][index[k]];
      const auto part = [&](std::size_t c) { return std::span(dense[c]).first(count); };
      triangle.polygon->over({part(0), part(1), part(2), part(3), part(4), part(5), points.origin}, part(6), 0);
      for (std::size_t k = 0; k < count; ++k) sum[index[k]] += static_cast<double>(dense[6][k]);
    }
    std::size_t without = 0;
    for (std::size_t i = 0; i < sr.size(); ++i) {
      const bool valid = std::all_of(all.begin(), all.end(), [&](const float* x) { return std::isfinite(x[i]); });
      sr[i] = valid ? static_cast<float>(sum[i]) : where_none;
      without += valid ? 0 : 1;
    }
    return without;
  }

  std::vector<Triangle> triangles_;
  bool two_sided_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> mesh_batch(const Emitter& white) {
  std::vector<Triangle> triangles;
  Emitter one = white;
  for (const auto& t : std::get<MeshEmitter>(white.shape).triangles) {
    const Vec3d normal = normalised(cross(t[1] - t[0], t[2] - t[0]));
    if (normal == Vec3d{}) continue;
    one.shape = PolygonEmitter{{t.begin(), t.end()}, normal, {}};
    triangles.push_back({t, normal, polygon_batch(one)});
  }
  return std::make_shared<MeshBatch>(std::move(triangles), white.two_sided);
}

}  // namespace etendue::eval
