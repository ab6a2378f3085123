// Light at a point: BRDFs, emitters in world space, and the reference that every faster method is held to.
// Nothing here knows a scene: see render.h for pictures with shadows.
#pragma once

#include "etendue/light.h"
#include "etendue/material.h"
#include "etendue/vec.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace etendue {
class IntensityWeb;
}

namespace etendue::eval {

// ---- Surfaces ----

// Diffuse lobes alone, white-based: Disney 2012 and Frostbite's renormalised form of it.
struct DisneyDiffuse {
  Rgb base_colour{1, 1, 1};
  double roughness = 0.5;
};
struct FrostbiteDiffuse {
  Rgb base_colour{1, 1, 1};
  double roughness = 0.5;
};
// glTF 2.0's (appendix B): base colour / pi times what Schlick's Fresnel of the half vector leaves. No roughness in it.
struct GltfDiffuse {
  Rgb base_colour{1, 1, 1};
  double ior = 1.5;
};
// Oren and Nayar 1994, the qualitative model: V-shaped grooves with Lambertian sides, one reflection.
struct OrenNayar {
  Rgb base_colour{1, 1, 1};
  double sigma_rad = 0.3;  // standard deviation of the slopes' angle
};
// The sigma of a microfacet surface with that alpha (roughness squared): arctan(alpha) / sqrt 2 (Lagarde and de Rousiers 2014, eq B.1),
// derived for Beckmann's distribution. Good to alpha .4; how far it carries with GGX is in sdk/docs/evaluation.md.
double oren_nayar_sigma_rad(double alpha);
// Gotanda 2014, "Designing Reflectance Models for New Consoles": a fit to Lambertian GGX facets under Fresnel. Not reciprocal.
struct GotandaDiffuse {
  Rgb base_colour{1, 1, 1};
  double roughness = 0.5;  // perceptually linear; alpha = roughness^2
  double f0 = 0.04;        // of the layer over the facets
};
// The specular lobe alone: GGX with Schlick's Fresnel.
struct GgxLobe {
  double alpha = 0.25;
  Rgb f0{0.04, 0.04, 0.04};
  double f90 = 1;
  Masking masking = Masking::correlated;
};
// How the normals of facets are spread (sdk/docs/brdf.md). Phong's lobe is none of facets: a power of the cosine about the mirror
// direction, normalised by (n + 2) / (2 pi), and so reciprocal and at most 1 in sum (Lewis 1993; Lafortune and Willems 1994).
enum class Distribution { ggx, beckmann, blinn_phong, phong };
// Schlick's from f0 to f90, as a power or as a spherical Gaussian (Karis 2013, eq 5), or exactly from the index of refraction.
enum class Fresnel { schlick, schlick_gaussian, dielectric, conductor };
// What a lobe that mirrors all (F = 1) gives back of a white sky, by the view: made once (directional_albedo.h).
class AlbedoCurve;
// A specular lobe alone, of any of them. What GgxLobe has is here to the same digits.
struct SpecularLobe {
  Distribution distribution = Distribution::ggx;
  double alpha_x = 0.25, alpha_y = 0.25;  // along ShadingPoint::tangent and across; Blinn-Phong and Phong are round: sqrt(x y)
  Masking masking = Masking::correlated;  // Phong has none
  Fresnel fresnel = Fresnel::schlick;
  Rgb f0{0.04, 0.04, 0.04};  // of Schlick's
  double f90 = 1;
  Rgb eta{1.5, 1.5, 1.5}, k{0, 0, 0};  // index of refraction of the others, over that outside; k of the conductor alone
  // Light that facets pass on to each other is added: what this curve, of the same facets and masking, lacks of 1.
  std::shared_ptr<const AlbedoCurve> compensation = nullptr;
};
// Reflectance of its facets at the angle of incidence with that cosine.
Rgb fresnel_reflectance(const SpecularLobe& lobe, double cosine);
// Micro-occlusion: f90 = min(50 f0, 1), because no material's f0 is below .02 (Schueler 2009; Lagarde and de Rousiers 2014, listing 27).
double micro_occlusion_f90(const Rgb& f0);
// Exponents of Blinn-Phong's (n.h)^n and Phong's (r.l)^n whose lobe is as wide as that of a Beckmann surface of that alpha (which is at
// most 1): n = 2 / alpha^2 - 2 (Walter et al. 2007, after eq 30), and a quarter of it, because r moves by twice the angle of h.
double blinn_phong_exponent(double alpha);
double alpha_of_blinn_phong(double exponent);
double phong_exponent(double alpha);
double alpha_of_phong(double exponent);

// A BRDF with every parameter resolved at one point.
using Brdf = std::variant<Lambert, Principled, Standard, Conductor, MetalRough, DisneyDiffuse, FrostbiteDiffuse, GgxLobe, TwoColour,
                          GltfDiffuse, OrenNayar, GotandaDiffuse, SpecularLobe>;

// BRDF times cosine of `light`, 1/sr. Unit vectors in the shading frame (z is the normal, x the tangent). 0 if either is below the horizon.
Rgb brdf_cos(const Brdf& brdf, const Vec3d& view, const Vec3d& light);

// Density (1/sr) with which sample_brdf picks `light`, and the choice itself from u in [0,1)^2. pdf 0: no direction.
double pdf_brdf(const Brdf& brdf, const Vec3d& view, const Vec3d& light);
struct DirectionSample {
  Vec3d direction;
  double pdf = 0;
};
DirectionSample sample_brdf(const Brdf& brdf, const Vec3d& view, const Vec2d& u);
// What pdf_brdf exceeds nowhere. 0 below the horizon.
double highest_pdf(const Brdf& brdf, const Vec3d& view);

struct ShadingPoint {
  Vec3d position;
  Vec3d normal;          // of the shading frame: interpolated and perturbed by a normal map
  Vec3d surface_normal;  // interpolated only: light below its horizon does not count either
  Vec3d view;            // unit, from the point to the eye
  Brdf brdf;
  Vec3d tangent = {};  // x of anisotropic lobes, made perpendicular to `normal`; none: any direction across it
};
// The axes that directions of a BRDF are told in.
Basis shading_basis(const ShadingPoint& point);

// ---- Emitters ----

// What multiplies a light by distance (light.h), with its range; the window of an area light is taken at the emitting point.
struct Window {
  Falloff falloff;
  double range_m = 0;  // 0: no range
};
double window_at(const Window& window, double distance_m);
// The least of it between two distances.
double least_window(const Window& window, double nearest_m, double furthest_m);
// Whether it is one: another number than 1 somewhere.
bool is_window(const Window& window);

// Emission pattern over a planar emitter's own uv in [0,1]^2, or a mesh's texture coordinates; multiplies the radiance.
using Pattern = std::function<Rgb(Vec2d uv)>;

// cd towards a direction of the light's own frame, times PunctualEmitter::intensity; with a cone, times the share that it lets through.
struct ProfileShape {
  std::shared_ptr<const IntensityWeb> web;
  std::optional<SpotShape> cone = {};
};
double flux_lm(const ProfileShape& profile);  // that passes the cone

struct PunctualEmitter {
  Vec3d position;
  Transform frame;  // rigid; emission along its -Z
  Rgb intensity;    // cd on the axis; of a profile the factor on its candelas
  std::variant<PointShape, SpotShape, FrustumShape, ProfileShape> shape;
};
struct DistantEmitter {
  Vec3d towards;          // unit, from any point to the light
  Rgb illuminance;        // lx facing it
  double radius_rad = 0;  // angular radius; > 0: a uniform disk of that illuminance
};
struct SphereEmitter {
  Vec3d centre;
  double radius;
};
struct DiskEmitter {
  Vec3d centre, normal;  // normal: the emitting side
  Vec3d x;               // unit, along which u grows; v grows along cross(x, normal); uv spans the square around the disk
  double radius;
};
struct PolygonEmitter {
  std::vector<Vec3d> vertices;  // counter-clockwise seen from the emitting side; simple, planar
  Vec3d normal;
  std::array<Vec3d, 3> uv_frame;                          // origin, u and v vectors: point = origin + u du + v dv
  std::vector<std::array<std::uint32_t, 3>> triangles{};  // indices of vertices, covering it; for sampling
};
struct TubeEmitter {
  Vec3d a, b;  // centres of the caps
  double radius;
  Caps caps;
};
struct LineEmitter {
  Vec3d a, b;
  Rgb intensity;  // cd, perpendicular to the line
};
struct MeshEmitter {
  std::vector<std::array<Vec3d, 3>> triangles;  // emit on the counter-clockwise side
  std::vector<double> running_area{};           // of the triangles up to and with each; for sampling
  std::vector<std::array<Vec2d, 3>> uvs{};      // of the triangles' corners, for a pattern; or empty
};
// Latitude-longitude map; bilinear, texel-centred, periodic in u, rows clamped at the poles. Built once.
class EnvironmentMap;
struct EnvironmentEmitter {
  std::shared_ptr<const EnvironmentMap> map;  // none: constant
  Transform to_local;                         // rotation from world to the map (+Z in the centre column, +X at u = .25, +Y up)
};
using EmitterShape = std::variant<PunctualEmitter, DistantEmitter, SphereEmitter, DiskEmitter, PolygonEmitter, TubeEmitter, LineEmitter,
                                  MeshEmitter, EnvironmentEmitter>;

struct Emitter {
  EmitterShape shape;
  Rgb radiance;  // cd/m2 on the emitting side (area and environment lights)
  bool two_sided = false;
  Window window;
  Pattern pattern;  // may be empty
};

// The parts of an emitter that only the owner of meshes and pictures can give.
struct EmitterParts {
  std::vector<std::array<Vec3d, 3>> triangles;  // mesh lights, in the light's own frame (scale not applied)
  std::shared_ptr<const EnvironmentMap> environment;
  Pattern pattern;
  std::vector<std::array<Vec2d, 3>> uvs;  // of mesh lights with a pattern, as many as triangles
};
// Patterns lie upright as seen from the emitting side: uv (0, 0) is the top left there, where +Y is up (and so +X is left).
// Errors as resolve(). EVALUATION_UNSUPPORTED: photometric lights that nobody read, tubes without caps that emit on both sides.
Result<Emitter> emitter_of(const Light& light, const EmitterParts& parts = {});

// width * height linear RGB in cd/m2, row 0 at the top (+Y).
std::shared_ptr<const EnvironmentMap> make_environment(std::uint32_t width, std::uint32_t height, std::vector<Vec3f> pixels);
Rgb lookup(const EnvironmentMap& map, const Vec3d& local_direction);
double mean_luminance(const EnvironmentMap& map);  // over the sphere

// ---- Light at a point, nothing in between ----

struct Tolerance {
  double relative = 1e-6;
  double absolute = 0;  // cd/m2; the larger of both is aimed at
};
struct Estimate {
  Rgb value;                      // luminance towards the view, cd/m2
  Rgb error;                      // bound that the method vouches for, same unit
  std::uint64_t evaluations = 0;  // of the BRDF
};

// Double precision, adaptive over the exact silhouette, clipped at both horizons: the definition of the answer.
// Environment maps are integrated by importance sampling and carry the statistical error (3 standard deviations).
Estimate reference(const Emitter& emitter, const ShadingPoint& point, const Tolerance& tolerance);

// The same answer by sampling the light: points uniform over its surface, as the reference mode of Lagarde and de Rousiers (2014), appendix
// A, draws them for spheres, disks, rectangles, cylinders and capsules (polygons and meshes triangle by triangle, lines along their length,
// suns over their solid angle, environments from the BRDF). It shares no outline, horizon or quadrature with `reference`.
struct Sampling {
  std::uint64_t samples = 1u << 16;  // made a multiple of 32
  std::uint64_t seed = 1;
};
struct SampledEstimate {
  Rgb value;           // luminance towards the view, cd/m2
  Rgb standard_error;  // of the value, from 32 independent parts of the samples: a t-distribution of 31 degrees of freedom, if none is rare
  Rgb heaviest;        // what the one sample that weighs most adds to the value; at least what one at the mirror direction would
  std::uint64_t samples = 0;

  // Three standard errors, which 99.5 of 100 values keep, and three times the heaviest sample: what n samples have all missed by chance (1
  // in 20) happens to less than 3 in n of all.
  Rgb error() const;
};
// Of one seed always the same; points at other places are independent. Lights without extent are exact and take no samples.
SampledEstimate monte_carlo(const Emitter& emitter, const ShadingPoint& point, const Sampling& sampling);

// Cosine integral of the light's luminance (lux) in closed form: every light without pattern or environment map; `reference` with a white
// Lambert surface for those. Not below the horizon of `normal`. A window on an extended light too, but for round ones an integral over one
// variable is left, to 1e-12 sr; from inside of one that emits on both sides it is `reference`.
// The inside of a sphere, tube or disk's back is dark unless the light is two-sided. From within the plane of a flat light it is not seen.
Rgb illuminance(const Emitter& emitter, const Vec3d& position, const Vec3d& normal);
// Whether it is one that has a closed form.
bool has_closed_form(const Emitter& emitter);

// ---- Sampling, for visibility ----

// A direction towards the emitter and what comes from there. delta: not one of a solid angle, `radiance` is the illuminance facing it
// (punctual lights and true directions; of a line, one of its points, with the illuminance divided by the density of the choice).
struct LightSample {
  Vec3d direction;      // unit, from the point
  double distance = 0;  // to the emitting point; infinite for distant lights and environments
  double pdf = 0;       // 1/sr; 0: no sample
  Rgb radiance;         // cd/m2 from there (lx if delta), window and pattern included
  bool delta = false;
};
LightSample sample_light(const Emitter& emitter, const Vec3d& position, const Vec2d& u);
// Density with which sample_light picks a direction (0 if the ray misses the light), and the radiance and distance that the ray meets.
LightSample light_along(const Emitter& emitter, const Vec3d& position, const Vec3d& direction);

}  // namespace etendue::eval
