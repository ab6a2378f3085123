// Emitters as the published methods see them, and the list of the methods.
#include "views.h"

#include <vector>

namespace etendue::eval {

std::optional<RectView> rect_view(const PolygonEmitter& polygon, bool two_sided, const Vec3d& position) {
  if (polygon.vertices.size() != 4) return std::nullopt;
  const auto& v = polygon.vertices;
  const Vec3d x = v[1] - v[0], y = v[3] - v[0];
  const double width = length(x), height = length(y), size = std::max(width, height);
  if (length(v[2] - v[1] - y) > 1e-6 * size || std::abs(dot(x, y)) > 1e-6 * width * height) return std::nullopt;
  RectView view{(v[0] - position + (v[2] - position)) * 0.5, {}, {}, polygon.normal, 0.5 * width, 0.5 * height};
  if (two_sided && view.height() < 0) view.normal = -view.normal;
  // Sides of no length take their direction from the other one, or from anywhere in the plane.
  view.x = width > 0 ? x / width : height > 0 ? cross(y / height, view.normal) : basis_around(view.normal).tangent;
  view.y = cross(view.normal, view.x);
  return view;
}

ClippedQuad clipped(const std::array<Vec3d, 4>& quad, const Vec3d& n) {
  ClippedQuad out;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d& p = quad[i];
    const Vec3d& q = quad[(i + 1) % 4];
    const double dp = dot(n, p), dq = dot(n, q);
    if (dp >= 0) out.vertices[out.count++] = p;
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) out.vertices[out.count++] = p + (q - p) * (dp / (dp - dq));
  }
  return out;
}

std::optional<LightView> light_view(const Emitter& emitter, const Vec3d& position) {
  if (const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape)) {
    const auto view = rect_view(*polygon, emitter.two_sided, position);
    return view ? std::optional<LightView>(*view) : std::nullopt;
  }
  if (const auto* d = std::get_if<DiskEmitter>(&emitter.shape)) {
    DiskView view{d->centre - position, d->normal, d->radius};
    if (emitter.two_sided && view.height() < 0) view.normal = -view.normal;
    return view;
  }
  if (const auto* s = std::get_if<SphereEmitter>(&emitter.shape)) return SphereView{s->centre - position, s->radius};
  if (const auto* t = std::get_if<TubeEmitter>(&emitter.shape); t != nullptr && t->caps == Caps::round)
    return TubeView{t->a - position, t->b - position, t->radius};
  return std::nullopt;
}

std::optional<double> DiffuseMethod::illuminance(const Emitter& emitter, const Vec3d& position, const Vec3d& n) const {
  const std::optional<LightView> light = light_view(emitter, position);
  if (!light) return std::nullopt;
  return std::visit(
      [&](const auto& view) -> std::optional<double> {
        const auto rule = rule_for(*this, view);
        if (rule == nullptr) return std::nullopt;
        const double lux = in_front(view) ? rule(view, n) : 0;
        return std::isfinite(lux) ? lux : 0;
      },
      *light);
}

std::span<const DiffuseMethod> diffuse_methods() {
  static const std::vector<DiffuseMethod> all = [] {
    std::vector<DiffuseMethod> methods;
    for (const auto part :
         {frostbite_methods(), frostbite_reference_methods(), drobot_methods(), hill_heitz_methods(), karis_methods(), eden_methods()})
      methods.insert(methods.end(), part.begin(), part.end());
    return methods;
  }();
  return all;
}

const DiffuseMethod* find_diffuse_method(std::string_view name) {
  for (const DiffuseMethod& method : diffuse_methods()) {
    if (method.name == name) return &method;
  }
  return nullptr;
}

}  // namespace etendue::eval
