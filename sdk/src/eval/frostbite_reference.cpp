// Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering 3.0" (2014), appendix A: the reference mode.
#include "frostbite_reference.h"

#include "views.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// Listing A.3's: the height of a point of the sphere is uniform (Archimedes).
Vec3d uniform_sample_sphere(const Vec2d& u) {
  const double phi = 2 * pi * u.y, cosine = 1 - 2 * u.x, sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

}  // namespace

double SpherePart::area() const { return 4 * pi * radius * radius; }
SurfacePoint SpherePart::at(const Vec2d& u) const {
  const Vec3d normal = uniform_sample_sphere(u);
  return {centre + normal * radius, normal};
}

double DiskPart::area() const { return pi * radius * radius; }
SurfacePoint DiskPart::at(const Vec2d& u) const {
  const Basis basis = basis_around(normal);
  const double r = radius * std::sqrt(u.x), phi = 2 * pi * u.y;
  return {centre + basis.tangent * (r * std::cos(phi)) + basis.bitangent * (r * std::sin(phi)), normal};
}

double ParallelogramPart::area() const { return length(cross(x, y)); }
SurfacePoint ParallelogramPart::at(const Vec2d& u) const { return {corner + x * u.x + y * u.y, normal}; }

double CylinderPart::area() const { return 2 * pi * radius * length(b - a); }
SurfacePoint CylinderPart::at(const Vec2d& u) const {
  const Basis basis = basis_around(normalised(b - a));
  const double phi = 2 * pi * u.y;
  const Vec3d out = basis.tangent * std::cos(phi) + basis.bitangent * std::sin(phi);
  return {a + (b - a) * u.x + out * radius, out};
}

double CapsPart::area() const { return 4 * pi * radius * radius; }
SurfacePoint CapsPart::at(const Vec2d& u) const {
  const Vec3d normal = uniform_sample_sphere(u);
  return {(dot(normal, b - a) > 0 ? b : a) + normal * radius, normal};
}

// The root makes lines across the triangle, as long as they are far from a, equally likely.
double TrianglePart::area() const { return 0.5 * length(cross(b - a, c - a)); }
SurfacePoint TrianglePart::at(const Vec2d& u) const {
  const double root = std::sqrt(u.x);
  return {a * (1 - root) + b * (root * (1 - u.y)) + c * (root * u.y), normalised(cross(b - a, c - a))};
}

namespace {

double area_of(const SurfacePart& part) {
  return std::visit([](const auto& p) { return p.area(); }, part);
}
SurfacePoint point_of(const SurfacePart& part, const Vec2d& u) {
  return std::visit([&](const auto& p) { return p.at(u); }, part);
}

}  // namespace

Surface::Surface(std::vector<SurfacePart> parts) : parts_(std::move(parts)) {
  double sum = 0;
  for (const SurfacePart& part : parts_) running_.push_back(sum += area_of(part));
}

Surface::Sample Surface::at(const Vec2d& u) const {
  const double at = u.x * running_.back();
  const auto found = std::upper_bound(running_.begin(), running_.end() - 1, at);
  const auto i = static_cast<std::size_t>(found - running_.begin());
  const double before = i > 0 ? running_[i - 1] : 0;
  return {point_of(parts_[i], {std::clamp((at - before) / (running_[i] - before), 0.0, 1.0), u.y}), i};
}

// ---- As a method of its own, for what the listing's default gives ----

namespace {

constexpr std::uint32_t sample_count_base = 512;

// getSample(i, n), which the document leaves out: Hammersley's points, i / n and the digits of i in base two behind the point in reverse.
Vec2d get_sample(std::uint32_t i, std::uint32_t n) {
  double reversed = 0, place = 0.5;
  for (std::uint32_t rest = i; rest > 0; rest >>= 1, place *= 0.5) reversed += (rest & 1) * place;
  return {static_cast<double>(i) / n, reversed};
}

double sampled_illuminance(const SurfacePoint& p, const Vec3d& n, double area) {
  const Vec3d l = shader_normalise(p.position);
  return saturate(dot(p.normal, -l)) * saturate(dot(n, l)) * area / dot(p.position, p.position);
}

// A pass a part, each with as many samples as are its share; none is 0 / 0.
double listing_a3_passes(const std::vector<SurfacePart>& passes, const Vec3d& n) {
  double total = 0, sum = 0;
  for (const SurfacePart& part : passes) total += area_of(part);
  for (const SurfacePart& part : passes) {
    const double area = area_of(part);
    const double share = area / total;
    const auto count = share > 0 ? static_cast<std::uint32_t>(sample_count_base * share) : 0U;
    double pass = 0;
    for (std::uint32_t i = 0; i < count; ++i) pass += sampled_illuminance(point_of(part, get_sample(i, count)), n, area);
    sum += pass / count;
  }
  return sum;
}
double listing_a3_at_once(const Surface& surface, const Vec3d& n) {
  double sum = 0;
  if (!(surface.area() > 0)) return 0;
  for (std::uint32_t i = 0; i < sample_count_base; ++i)
    sum += sampled_illuminance(surface.at(get_sample(i, sample_count_base)).point, n, surface.area());
  return sum / sample_count_base;
}

double a3_rect(const RectView& rect, const Vec3d& n) {
  const ParallelogramPart part{rect.at(-rect.half_x, -rect.half_y), rect.x * (2 * rect.half_x), rect.y * (2 * rect.half_y), rect.normal};
  return listing_a3_passes({part}, n);
}
double a3_disk(const DiskView& disk, const Vec3d& n) { return listing_a3_passes({DiskPart{disk.centre, disk.normal, disk.radius}}, n); }
double a3_sphere(const SphereView& sphere, const Vec3d& n) { return listing_a3_passes({SpherePart{sphere.centre, sphere.radius}}, n); }
std::vector<SurfacePart> capsule(const TubeView& tube) {
  return {CylinderPart{tube.a, tube.b, tube.radius}, CapsPart{tube.a, tube.b, tube.radius}};
}
double a3_tube(const TubeView& tube, const Vec3d& n) { return listing_a3_passes(capsule(tube), n); }
double a3_tube_mended(const TubeView& tube, const Vec3d& n) { return listing_a3_at_once(Surface(capsule(tube)), n); }

constexpr std::string_view source = "Lagarde and de Rousiers 2014, listing A.3";
constexpr DiffuseMethod methods[] = {
    {.name = "frostbite-a3",
     .source = source,
     .note =
         "512 points uniform over the light's whole surface (Hammersley's; the document does not print its own): .05 to .5 % off above the "
         "horizon, 1 to 2 % across, more close to a large light. Printed: no number for a capsule with a radius below a 1022nd of its "
         "length, or without a length.",
     .rect = a3_rect,
     .disk = a3_disk,
     .sphere = a3_sphere,
     .tube = a3_tube},
    {.name = "frostbite-a3-mended",
     .source = source,
     .note =
         "The same with caps and side of a capsule sampled as one. eval::monte_carlo is it with as many samples as asked for, any BRDF, "
         "and an error.",
     .tube = a3_tube_mended},
};

}  // namespace

std::span<const DiffuseMethod> frostbite_reference_methods() { return methods; }

}  // namespace etendue::eval
