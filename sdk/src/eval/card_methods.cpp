// One lookup that stands for the picture as the lobe sees it: where, and how wide. The card's means over squares are the filter.
#include "etendue/ltc.h"
#include "etendue/probe.h"
#include "etendue/specular_methods.h"

#include "contour.h"
#include "drobot_point.h"
#include "illuminance.h"
#include "specular_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

struct Lookup {
  Vec2d uv;
  double width;  // of a square with the filter's variance, in sides of the card
};
Rgb looked_up(const LightCard& card, const Lookup& at) { return card.lookup(at.uv, -std::log2(std::max(at.width, 1e-9))); }

const PolygonEmitter* rectangle_of(const Emitter& emitter) {
  const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape);
  return polygon != nullptr && polygon->vertices.size() == 4 ? polygon : nullptr;
}

// The uniform light's luminance by a method of specular_methods.h.
std::optional<Rgb> uniform(std::string_view method, const Emitter& emitter, const ShadingPoint& point) {
  Emitter plain = emitter;
  plain.pattern = {};
  const SpecularMethod* m = find_specular_method(method);
  return m != nullptr ? m->luminance(plain, point) : std::nullopt;
}

// uv of a point p of the plane, from its corner.
Vec2d place_of(const Vec3d& p, const Vec3d& u, const Vec3d& v) {
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), pu = dot(p, u), pv = dot(p, v), det = uu * vv - uv * uv;
  return {(pu * vv - pv * uv) / det, (pv * uu - pu * uv) / det};
}

// The rectangle in the space where the lobe is a clamped cosine: origin, u, v.
std::array<Vec3d, 3> in_cosine_space(const PolygonEmitter& rectangle, const ShadingPoint& point, double alpha) {
  const double cosine = dot(point.normal, point.view);
  const Vec3d across = point.view - point.normal * cosine;
  const Vec3d x = dot(across, across) > 1e-30 ? normalised(across) : basis_around(point.normal).tangent, y = cross(point.normal, x);
  const TransformedCosine lobe = ltc_table().at(alpha, cosine).whole;
  const auto there = [&](const Vec3d& d) { return lobe.inverse.vector({dot(x, d), dot(y, d), dot(point.normal, d)}); };
  return {there(rectangle.uv_frame[0] - point.position), there(rectangle.uv_frame[1]), there(rectangle.uv_frame[2])};
}

// On a plane at the distance d a cosine has the weight (1 + s^2 / d^2)^-2, half of it within s = d; a Gaussian with that has sigma =
// d / sqrt(2 ln 2), a square of that variance the side sqrt(12) sigma.
double width_at(double distance, double area) { return std::sqrt(12 / (2 * std::log(2.0)) / area) * distance; }

// Perpendicular to the plane: nearest, and often beside the picture, where it continues as at its border.
std::optional<Lookup> perpendicular(const std::array<Vec3d, 3>& r) {
  const auto& [corner, u, v] = r;
  const Vec3d normal = cross(u, v);
  const double area = length(normal), along = dot(normal, corner) / (area * area);
  if (!(area > 0)) return std::nullopt;
  constexpr double border = 1.0 / 6;
  const Vec2d uv = place_of(normal * along - corner, u, v);
  return Lookup{{std::clamp(uv.x, -border, 1 + border), std::clamp(uv.y, -border, 1 + border)}, width_at(std::abs(along) * area, area)};
}
// Along the vector irradiance of the cosine's light, which always meets the picture.
std::optional<Lookup> along_f(const std::array<Vec3d, 3>& r) {
  const auto& [corner, u, v] = r;
  const std::array<Vec3d, 4> corners{corner, corner + u, corner + u + v, corner + v};
  Vec3d f;
  for (std::size_t i = 0; i < 4; ++i)
    if (const auto arc = great_circle(corners[i], corners[(i + 1) % 4])) f += direction_integral(*arc);
  const Vec3d normal = cross(u, v);
  const double area = length(normal), slope = dot(normal, f);
  if (!(area > 0) || slope == 0) return std::nullopt;
  const Vec3d met = f * (dot(normal, corner) / slope);
  const Vec2d uv = place_of(met - corner, u, v);
  return Lookup{{std::clamp(uv.x, 0.0, 1.0), std::clamp(uv.y, 0.0, 1.0)}, width_at(length(met), area)};
}

template <std::optional<Lookup> (*where)(const std::array<Vec3d, 3>&)>
std::optional<Rgb> by_cosine(const Emitter& emitter, const CardLookups& in, const ShadingPoint& point) {
  const PolygonEmitter* rectangle = rectangle_of(emitter);
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  if (rectangle == nullptr || !lobe) return std::nullopt;
  const std::optional<Rgb> light = uniform("ltc-unclipped", emitter, point);
  if (!light || *light == Rgb{}) return light;
  const auto at = where(in_cosine_space(*rectangle, point, lobe->alpha));
  return at ? *light * looked_up(*in.card, *at) : Rgb{};
}

// Drobot 2014, 1.23 and 1.28: the cone of the half angle alpha about the mirror direction as a square of the same area on the light's
// plane, cut with the rectangle; its middle is looked up, with the cone's width (1.26). The light is that of `moments`, so that the
// lookup's error alone is measured; 1.28 takes 1.20's.
std::optional<Rgb> drobot(const Emitter& emitter, const CardLookups& in, const ShadingPoint& point) {
  const PolygonEmitter* rectangle = rectangle_of(emitter);
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  if (rectangle == nullptr || !lobe) return std::nullopt;
  const std::optional<Rgb> light = uniform("moments", emitter, point);
  if (!light || *light == Rgb{}) return light;
  const auto& [origin, u, v] = rectangle->uv_frame;
  const Vec3d mirror = point.normal * (2 * dot(point.normal, point.view)) - point.view, normal = normalised(cross(u, v));
  const Vec3d corner = origin - point.position;
  const double height = dot(normal, corner), slope = dot(normal, mirror);
  // A mirror direction that leads away from the plane is given a way to it that is far beyond the rectangle.
  const double size = std::max(length(u), length(v)), far = 1e3 * (size + length(corner));
  const double way = slope * height > 0 ? std::min(height / slope, far) : far;
  const Vec2d at = place_of(mirror * way - normal * (dot(normal, mirror * way) - height) - corner, u, v);
  const double half = 0.5 * std::sqrt(pi) * way * std::tan(std::min(lobe->alpha, 1.5));
  const auto middle = [](double centre, double reach) {
    const double low = std::clamp(centre - reach, 0.0, 1.0), high = std::clamp(centre + reach, 0.0, 1.0);
    return 0.5 * (low + high);
  };
  const Lookup where{{middle(at.x, half / length(u)), middle(at.y, half / length(v))}, 2 * half / std::sqrt(length(cross(u, v)))};
  return *light * looked_up(*in.card, where);
}

// Drobot 2014, 1.24: the volume is asked at the point that stands for the light (clamped to it, his first form) and at its distance. As
// above, times the light's closed form instead of 1.16's.
std::optional<Rgb> drobot_diffuse(const Emitter& emitter, const CardLookups& in, const ShadingPoint& point) {
  const PolygonEmitter* rectangle = rectangle_of(emitter);
  const auto* lambert = std::get_if<Lambert>(&point.brdf);
  if (rectangle == nullptr || lambert == nullptr || is_window(emitter.window) || !in.over_distance) return std::nullopt;
  const std::optional<RectView> seen = rect_view(*rectangle, emitter.two_sided, point.position);
  if (!seen) return std::nullopt;
  Emitter plain = emitter;
  plain.pattern = {};
  const LocalFrame local(point.position, point.normal);
  const auto lux = closed_illuminance(plain, point.position, local, horizons_of(local, point.normal, point.surface_normal));
  const Rgb light = lambert->base_colour * lux.value_or(Rgb{}) / pi;
  if (light == Rgb{}) return light;
  Vec3d at = clamped_point(*seen, point.normal);
  if (!std::isfinite(length(at))) at = seen->centre;
  const auto& [origin, u, v] = rectangle->uv_frame;
  return light * in.over_distance->lookup(place_of(at + point.position - origin, u, v), length(at));
}

constexpr CardMethod methods[] = {
    {"ltc-perpendicular", "Heitz, Dupuy, Hill and Neubelt 2016",
     "Looked up where the perpendicular to the transformed polygon meets its plane, up to a sixth outside; filter widths of this library.",
     by_cosine<perpendicular>},
    {"ltc-along-f", "Hill and Heitz 2016, after Karis",
     "Looked up along the vector irradiance of the transformed polygon, which always meets it: no border.", by_cosine<along_f>},
    {"drobot-card", "Drobot 2014 (GPU Pro 5), 1.3.5",
     "Looked up in the middle of what the lobe's cone, as a square, covers of the rectangle, as wide as the cone; times the light by "
     "moments.",
     drobot},
    {"drobot-diffuse-card", "Drobot 2014 (GPU Pro 5), eq 1.24",
     "Of lambert: looked up in a volume over the distance, at the point that stands for the light; times its closed form.", drobot_diffuse,
     true},
};

}  // namespace

CardLookups CardMethod::lookups(const Emitter& emitter, const LightCard& card) const {
  CardLookups made{&card, {}};
  const PolygonEmitter* rectangle = rectangle_of(emitter);
  if (!over_distance || rectangle == nullptr) return made;
  const double width = length(rectangle->uv_frame[1]), height = length(rectangle->uv_frame[2]);
  if (width > 0 && height > 0) made.over_distance.emplace(card, width, height);
  return made;
}

std::span<const CardMethod> card_methods() { return methods; }

const CardMethod* find_card_method(std::string_view name) {
  const auto* found = std::find_if(std::begin(methods), std::end(methods), [&](const CardMethod& m) { return m.name == name; });
  return found == std::end(methods) ? nullptr : found;
}

}  // namespace etendue::eval
