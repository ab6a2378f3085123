// The shading point's own coordinates: positions relative to it, z along the shading normal. Everything is integrated there.
#pragma once

#include "contour.h"
#include "etendue/eval.h"
#include "silhouette.h"

#include <cmath>
#include <utility>
#include <vector>

namespace etendue::eval {

class LocalFrame {
 public:
  LocalFrame(const Vec3d& position, const Vec3d& normal) : origin_(position), basis_(basis_around(normal)) {}
  explicit LocalFrame(const ShadingPoint& point) : origin_(point.position), basis_(shading_basis(point)) {}
  Vec3d vector(const Vec3d& v) const { return {dot(basis_.tangent, v), dot(basis_.bitangent, v), dot(basis_.normal, v)}; }
  Vec3d point(const Vec3d& p) const { return vector(p - origin_); }
  Vec3d to_world(const Vec3d& v) const { return basis_.tangent * v.x + basis_.bitangent * v.y + basis_.normal * v.z; }

 private:
  Vec3d origin_;
  Basis basis_;
};

// Normals below whose horizons no light counts: z, and the surface's own where it is another one.
struct Horizons {
  Vec3d surface;          // unit, local
  bool distinct = false;  // from z
};
inline Horizons horizons_of(const LocalFrame& frame, const Vec3d& normal, const Vec3d& surface_normal) {
  const Vec3d apart = surface_normal - normal;
  return {frame.vector(surface_normal), dot(apart, apart) > 1e-24};
}
Contour clipped(const Contour& outline, const Horizons& horizons);

// Calls use(contour) for the parts of an outline on which a BRDF is smooth: a folded one (LobeFacts) bends where the light crosses the
// plane of the normal across the view.
template <class Use>
void each_smooth_part(Contour contour, const Vec3d& view, bool folded, Use use) {
  const double across = std::hypot(view.x, view.y);
  if (contour.empty()) return;
  if (!folded || !(across > 1e-9)) return use(std::move(contour));
  const Vec3d ahead{view.x / across, view.y / across, 0};
  for (const Vec3d& side : {ahead, -ahead})
    if (Contour part = clipped(contour, side); !part.empty()) use(std::move(part));
}

// Calls use(contour, index) for every outline that the emitter shows to the point, not clipped. The index counts the triangles of a mesh;
// it is 0 for all else. Punctual lights, true directions and lines have no outline; an environment has the horizon of z.
template <class Use>
void each_outline(const Emitter& emitter, const LocalFrame& frame, Use use) {
  struct Visitor {
    const Emitter& emitter;
    const LocalFrame& frame;
    Use& use;

    void operator()(const PunctualEmitter&) const {}
    void operator()(const LineEmitter&) const {}
    void operator()(const DistantEmitter& e) const {
      if (e.radius_rad > 0) use(Contour{cap_circle(frame.vector(e.towards), std::cos(e.radius_rad), std::sin(e.radius_rad))}, 0);
    }
    // From inside, a sphere that emits on both sides fills the sky.
    void operator()(const SphereEmitter& e) const {
      const Vec3d centre = frame.point(e.centre);
      const bool inside = dot(centre, centre) <= e.radius * e.radius;
      if (inside && emitter.two_sided && e.radius > 0) return use(Contour{horizon_circle({0, 0, 1})}, 0);
      use(sphere_silhouette(centre, e.radius), 0);
    }
    void operator()(const DiskEmitter& e) const {
      use(disk_silhouette(frame.point(e.centre), frame.vector(e.normal), e.radius, emitter.two_sided), 0);
    }
    void operator()(const PolygonEmitter& e) const {
      std::vector<Vec3d> vertices;
      vertices.reserve(e.vertices.size());
      for (const Vec3d& p : e.vertices) vertices.push_back(frame.point(p));
      use(polygon_silhouette(vertices, frame.vector(e.normal), emitter.two_sided), 0);
    }
    void operator()(const TubeEmitter& e) const {
      const Vec3d a = frame.point(e.a), b = frame.point(e.b);
      if (emitter.two_sided && e.radius > 0 && inside_tube(a, b, e.radius, e.caps)) return use(Contour{horizon_circle({0, 0, 1})}, 0);
      use(tube_silhouette(a, b, e.radius, e.caps), 0);
    }
    void operator()(const MeshEmitter& e) const {
      for (std::size_t i = 0; i < e.triangles.size(); ++i) {
        const std::array<Vec3d, 3> t{frame.point(e.triangles[i][0]), frame.point(e.triangles[i][1]), frame.point(e.triangles[i][2])};
        if (t[0].z <= 0 && t[1].z <= 0 && t[2].z <= 0) continue;
        const Vec3d normal = normalised(cross(t[1] - t[0], t[2] - t[0]));
        if (emitter.two_sided || dot(normal, t[0]) < 0) use(polygon_silhouette(t, normal, emitter.two_sided), i);
      }
    }
    void operator()(const EnvironmentEmitter&) const { use(Contour{horizon_circle({0, 0, 1})}, 0); }
  };
  std::visit(Visitor{emitter, frame, use}, emitter.shape);
}

}  // namespace etendue::eval
