// Lagarde and de Rousiers 2014, 4.7.4, and what others do: a diffuse BRDF for one direction times the illuminance of all the light.
#include "etendue/diffuse_light.h"
#include "etendue/published.h"
#include "local.h"
#include "representative_point.h"

namespace etendue::eval {
namespace {

using Choice = DiffuseRule::Choice;

std::optional<Vec3d> centre_of(const Emitter& emitter) {
  if (const auto* s = std::get_if<SphereEmitter>(&emitter.shape)) return s->centre;
  if (const auto* d = std::get_if<DiskEmitter>(&emitter.shape)) return d->centre;
  if (const auto* t = std::get_if<TubeEmitter>(&emitter.shape)) return (t->a + t->b) * 0.5;
  const auto* p = std::get_if<PolygonEmitter>(&emitter.shape);
  if (p == nullptr || p->vertices.empty()) return std::nullopt;
  Vec3d sum;
  for (const Vec3d& v : p->vertices) sum += v;
  return sum / static_cast<double>(p->vertices.size());
}

std::optional<Vec3d> direction_of(const std::optional<Vec3d>& offset) {
  return offset && length(*offset) > 0 ? std::optional(normalised(*offset)) : std::nullopt;
}

std::optional<Choice> light_position(const Emitter& emitter, const ShadingPoint& point) {
  const auto centre = centre_of(emitter);
  const auto towards = direction_of(centre ? std::optional(*centre - point.position) : std::nullopt);
  return towards ? std::optional(Choice{*towards, point.normal}) : std::nullopt;
}

std::optional<Choice> representative_point(const Emitter& emitter, const ShadingPoint& point) {
  const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape);
  if (polygon == nullptr) return std::nullopt;
  const auto view = rect_view(*polygon, emitter.two_sided, point.position);
  const auto towards = direction_of(view ? std::optional(most_representative(*view, point.normal)) : std::nullopt);
  return towards ? std::optional(Choice{*towards, point.normal}) : std::nullopt;
}

double roughness_of(const Brdf& brdf) {
  if (const auto* disney = std::get_if<DisneyDiffuse>(&brdf)) return disney->roughness;
  if (const auto* frostbite = std::get_if<FrostbiteDiffuse>(&brdf)) return frostbite->roughness;
  return -1;
}

std::optional<Choice> dominant_direction(const Emitter& emitter, const ShadingPoint& point) {
  const double roughness = roughness_of(point.brdf);
  auto choice = roughness >= 0 ? light_position(emitter, point) : std::nullopt;
  if (choice) choice->normal = frostbite_diffuse_direction(point.normal, point.view, roughness);
  return choice;
}

// Where there is no vector, there is no light: any direction will do.
std::optional<Choice> light_vector(const Emitter& emitter, const ShadingPoint& point) {
  if (!centre_of(emitter)) return std::nullopt;
  const LocalFrame frame(point.position, point.normal);
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  Vec3d sum;
  each_outline(emitter, frame, [&](const Contour& outline, std::size_t) { sum += direction_integral(clipped(outline, horizons)); });
  return Choice{length(sum) > 0 ? frame.to_world(normalised(sum)) : point.normal, point.normal};
}

constexpr std::string_view equation = "Lagarde and de Rousiers 2014, eq 45";
constexpr DiffuseRule rules[] = {
    {"frostbite-45", equation,
     "The light's position, as Frostbite does: up to 5 % off above the horizon with Disney's lobe, a quarter across it.", light_position},
    {"frostbite-45-point", equation,
     "The point where cos(theta) / r^2 is highest, of rectangles: what the text calls better. Their shader takes Drobot's approximation of "
     "it.",
     representative_point},
    {"frostbite-15", "Lagarde and de Rousiers 2014, 4.7.4, listing 15",
     "The light's position, and the illuminance of the normal moved towards the view; for Disney's and Frostbite's diffuse lobe. The "
     "shift was fitted to light from everywhere: of one light it changes the illuminance itself by tens of per cent.",
     dominant_direction},
    {"light-vector", "-", "The direction of the exact vector of illuminance above the horizon: what one direction can do.", light_vector},
};

}  // namespace

std::optional<Rgb> DiffuseRule::luminance(const Emitter& emitter, const ShadingPoint& point) const {
  if (!is_diffuse(point.brdf) || !has_closed_form(emitter)) return std::nullopt;
  const auto choice = choose(emitter, point);
  if (!choice) return std::nullopt;
  const LocalFrame frame(point.position, point.normal);
  Vec3d light = frame.vector(choice->light);
  light.z = std::max(light.z, 1e-6);
  light = normalised(light);
  return brdf_cos(point.brdf, frame.vector(point.view), light) / light.z * illuminance(emitter, point.position, choice->normal);
}

std::span<const DiffuseRule> diffuse_rules() { return rules; }

const DiffuseRule* find_diffuse_rule(std::string_view name) {
  for (const DiffuseRule& rule : rules)
    if (rule.name == name) return &rule;
  return nullptr;
}

}  // namespace etendue::eval
