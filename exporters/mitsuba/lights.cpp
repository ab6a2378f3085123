#include "lights.h"

#include <fmt/format.h>

#include <algorithm>

#include "etendue/eval.h"

namespace etendue::mitsuba {
namespace {

bool is_lit(const ExportOptions& options, std::uint32_t light) {
  return options.lit.empty() || std::find(options.lit.begin(), options.lit.end(), light) != options.lit.end();
}

bool is_punctual(const Shape& shape) {
  return std::holds_alternative<PointShape>(shape) || std::holds_alternative<SpotShape>(shape) ||
         std::holds_alternative<FrustumShape>(shape) || std::holds_alternative<LineShape>(shape) ||
         std::holds_alternative<PhotometricShape>(shape);
}

// Without a place in the world or without a body: nothing is left of it when it does not emit.
bool has_body(const Shape& shape) {
  return !is_punctual(shape) && !std::holds_alternative<DistantShape>(shape) && !std::holds_alternative<EnvironmentShape>(shape);
}

eval::Window window_of(const Light& light) { return {light.falloff, light.range_m.value_or(0)}; }

// Ours times w(d); Mitsuba's 1.
void report_window(Writer& writer, const Light& light) {
  if (!has_window(light) || writer.parts == MitsubaParts::with_plugins) return;
  const eval::Window window = window_of(light);
  const double at_m = light.range_m ? *light.range_m / 2 : 1, w = eval::window_at(window, at_m);
  const std::string more = w > 0 ? fmt::format("{:+.1f} % at {} m", 100 * (1 / w - 1), text_of(at_m)) : "light at every distance";
  if (light.range_m)
    writer.losses.add(name_for_losses(light) + ": range " + text_of(*light.range_m) + " m",
                      "no window: " + more + ", and light beyond the range, where there should be none" + exact_with_plugins);
  else
    writer.losses.add(name_for_losses(light) + ": falloff " + name_of(light.falloff), "inverse square: " + more + exact_with_plugins);
}

void report_losses(Writer& writer, const Light& light) {
  report_window(writer, light);
  const bool can_show_picture = std::holds_alternative<RectShape>(light.shape) || std::holds_alternative<DiskShape>(light.shape) ||
                                std::holds_alternative<PolygonShape>(light.shape) || std::holds_alternative<MeshShape>(light.shape);
  if (light.emission.texture && !can_show_picture) {
    writer.losses.add(name_for_losses(light) + ": texture", "left out, as in our own evaluation: only planar and mesh lights have one");
  }
  if (!light.visible && has_body(light.shape)) {
    writer.losses.add(name_for_losses(light) + ": invisible", "seen by the camera, and it casts shadows");
  }
}

Status write_shape(Writer& writer, const LightEntry& entry) {
  return std::visit(
      [&](const auto& shape) -> Status {
        using S = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<S, PointShape>) return write_point(writer, entry);
        if constexpr (std::is_same_v<S, SpotShape>) return write_spot(writer, entry, shape);
        if constexpr (std::is_same_v<S, FrustumShape>) return write_frustum(writer, entry, shape);
        if constexpr (std::is_same_v<S, DistantShape>) return write_distant(writer, entry, shape);
        if constexpr (std::is_same_v<S, SphereShape>) return write_sphere(writer, entry, shape);
        if constexpr (std::is_same_v<S, DiskShape>) return write_disk(writer, entry, shape);
        if constexpr (std::is_same_v<S, RectShape>) return write_rect(writer, entry, shape);
        if constexpr (std::is_same_v<S, PolygonShape>) return write_polygon(writer, entry, shape);
        if constexpr (std::is_same_v<S, TubeShape>) return write_tube(writer, entry, shape);
        if constexpr (std::is_same_v<S, LineShape>) return write_line(writer, entry, shape);
        if constexpr (std::is_same_v<S, MeshShape>) return write_mesh_light(writer, entry, shape);
        if constexpr (std::is_same_v<S, EnvironmentShape>) return write_environment(writer, entry, shape);
        if constexpr (std::is_same_v<S, PhotometricShape>) return write_photometric(writer, entry);
      },
      entry.light.shape);
}

Status check_environments(const Scene& scene, const ExportOptions& options) {
  const Light* first = nullptr;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!is_lit(options, i) || !std::holds_alternative<EnvironmentShape>(light.shape)) continue;
    if (first) {
      return unsupported("Mitsuba takes one environment, found '" + first->name + "' and '" + light.name + "'", light.source);
    }
    first = &light;
  }
  return Done{};
}

}  // namespace

std::string name_for_losses(const Light& light) { return "light '" + light.name + "'"; }

bool has_window(const Light& light) {
  return eval::is_window(window_of(light)) && !std::holds_alternative<DistantShape>(light.shape) &&
         !std::holds_alternative<EnvironmentShape>(light.shape);
}

void add_window(pugi::xml_node emitter, const Light& light) {
  if (!has_window(light)) return;
  const auto name = [](Falloff::Law law) -> const char* {
    switch (law) {
      case Falloff::Law::power:
        return "power";
      case Falloff::Law::power_squared:
        return "power_squared";
      case Falloff::Law::smoothstep:
        return "smoothstep";
      case Falloff::Law::scale_bias:
        return "scale_bias";
      case Falloff::Law::karis:
        return "karis";
      case Falloff::Law::inverse_square:
        break;
    }
    return "inverse_square";
  };
  add_string(emitter, "falloff", name(light.falloff.law));
  add_float(emitter, "exponent", light.falloff.exponent);
  add_float(emitter, "range", light.range_m.value_or(0));
}

Status write_lights(Writer& writer) {
  const Scene& scene = writer.scene;
  if (Status s = check_environments(scene, writer.options); !s) return s;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool lit = is_lit(writer.options, i);
    if (!lit && !has_body(light.shape)) continue;
    report_losses(writer, light);
    LightEntry entry{light, i, "light_" + std::to_string(i) + "_" + id_safe(light.name), lit, {}};
    if (lit) {
      Result<Resolved> resolved = resolve(light, mesh_area_of(scene, light));
      if (!resolved) return resolved.error();
      entry.resolved = *resolved;
    }
    if (Status s = write_shape(writer, entry); !s) return s;
  }
  return Done{};
}

}  // namespace etendue::mitsuba
