// Units to what is emitted: one small rule for each kind of shape.
#include "light_illuminance.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue {
namespace {

using Given = Emission::Given;
using Kind = Resolved::Kind;

double square(double x) { return x * x; }
bool finite(const Rgb& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

const char* name_of(Given given, bool radiant) {
  switch (given) {
    case Given::flux:
      return radiant ? "radiant_flux" : "flux";
    case Given::intensity:
      return radiant ? "radiant_intensity" : "intensity";
    case Given::luminance:
      return radiant ? "radiance" : "luminance";
    case Given::illuminance:
      return radiant ? "irradiance" : "illuminance";
    case Given::ev:
      return "ev";
    case Given::as_file:
      break;
  }
  return "emission of the file";
}

// A photometric value without colour, of white light.
struct White {
  Kind kind = Kind::luminance;
  double value = 0;
  double flux_lm = 0;
  double area_m2 = 0;
};

class Resolver {
 public:
  Resolver(const Light& light, double mesh_area_m2) : light_(light), e_(light.emission), mesh_area_m2_(mesh_area_m2) {}

  // Photometric value of what was given, EV apart.
  Result<double> photometric() const {
    if (!std::isfinite(e_.value) || (e_.given != Given::ev && e_.value < 0))
      return error("NUMBER_INVALID", fmt::format("expected a finite {} that is not negative, found {}", given(), e_.value));
    if (!e_.radiant) return e_.value;
    if (e_.given == Given::ev || e_.given == Given::as_file)
      return error("UNIT_UNSUITABLE", fmt::format("{} has no radiant twin", given()));
    if (!e_.efficacy_lm_W)
      return error("EFFICACY_MISSING", fmt::format("{} needs an efficacy in lm/W to become a photometric quantity", given()));
    if (!std::isfinite(*e_.efficacy_lm_W) || *e_.efficacy_lm_W <= 0)
      return error("NUMBER_INVALID", fmt::format("expected an efficacy greater than zero, found {} lm/W", *e_.efficacy_lm_W));
    return e_.value * *e_.efficacy_lm_W;
  }

  Result<White> operator()(const PointShape&) const { return punctual(4 * pi, 4 * pi); }
  Result<White> operator()(const SpotShape& s) const {
    return punctual(solid_angle_of(s, light_.flux_convention), solid_angle_of(s, FluxConvention::falloff));
  }
  Result<White> operator()(const FrustumShape& s) const { return punctual(solid_angle_of(s), solid_angle_of(s)); }

  // A disk of angular radius a around the normal gives E = L pi sin^2(a).
  Result<White> operator()(const DistantShape& s) const {
    const double projected = pi * square(std::sin(s.diameter_rad / 2));
    switch (e_.given) {
      case Given::illuminance:
        if (projected > 0) return White{Kind::luminance, v() / projected, 0, 0};
        return White{Kind::illuminance, v(), 0, 0};
      case Given::luminance:
      case Given::ev:
        if (projected > 0) return White{Kind::luminance, luminance_given(), 0, 0};
        return error("SIZE_MISSING", fmt::format("{} needs an angular_diameter greater than zero", given()));
      default:
        return unsuitable("give its illuminance");
    }
  }

  Result<White> operator()(const SphereShape& s) const { return area(pi * square(s.radius), s.radius, &s); }
  Result<White> operator()(const DiskShape& s) const { return area(pi * square(s.radius), 0, &s); }
  Result<White> operator()(const RectShape& s) const { return area(s.width * s.height, 0, &s); }
  Result<White> operator()(const PolygonShape& s) const {
    const Result<double> face = emitting_area(light_);
    return face ? area(*face, 0, &s) : Result<White>(face.error());
  }
  // Seen perpendicularly a tube is a rectangle, with round caps a stadium.
  Result<White> operator()(const TubeShape& s) const {
    return area(2 * s.radius * s.length + (s.caps == Caps::round ? pi * square(s.radius) : 0), s.radius, &s);
  }
  Result<White> operator()(const MeshShape&) const {
    if (e_.given == Given::intensity || e_.given == Given::illuminance) return unsuitable("give its flux or its luminance");
    return area<SphereShape>(0, 0, nullptr);
  }

  // I(theta) = I sin(theta) over the sphere: flux = 2 pi I integral of sin^2 = pi^2 I.
  Result<White> operator()(const LineShape& s) const {
    if (!(s.length > 0)) return error("SIZE_MISSING", "expected a length greater than zero");
    double intensity = v();
    if (e_.given == Given::flux) {
      intensity = v() / square(pi);
    } else if (e_.given == Given::illuminance) {
      const Result<double> d = distance_beyond(0);
      if (!d) return d.error();
      intensity = v() / facing_factor(s, *d);
    } else if (e_.given != Given::intensity) {
      return unsuitable("a line has no surface; give its flux, or make it a tube");
    }
    return White{Kind::line, intensity, intensity * square(pi), 0};
  }

  // The file's own candelas, times colour and filter; a flux is what the file is to be rescaled to.
  Result<White> operator()(const PhotometricShape&) const {
    if (e_.given == Given::as_file) return White{Kind::intensity, 1, 0, 0};
    if (e_.given == Given::flux) return White{Kind::intensity, 1, v(), 0};
    return unsuitable("its file gives the candelas; only flux rescales them");
  }

  // A plane under a uniform sky has E = pi L.
  Result<White> operator()(const EnvironmentShape& s) const {
    switch (e_.given) {
      case Given::as_file:
        if (s.image) return White{Kind::luminance, 1, 0, 0};
        return error("EMISSION_MISSING", "an environment without an image needs a luminance or an illuminance");
      case Given::luminance:
      case Given::ev:
        return White{Kind::luminance, luminance_given(), 0, 0};
      case Given::illuminance:
        return White{Kind::luminance, v() / pi, 0, 0};
      default:
        return unsuitable("give its luminance or its illuminance");
    }
  }

  Error error(const char* code, const std::string& text) const {
    return {code, fmt::format("{} light \"{}\": {}", etendue::name_of(light_.shape), light_.name, text), {"", 0, 0, light_.source}, {}, {}};
  }

 private:
  const char* given() const { return name_of(e_.given, e_.radiant); }
  double v() const { return e_.radiant ? e_.value * *e_.efficacy_lm_W : e_.value; }
  double luminance_given() const { return e_.given == Given::ev ? luminance_of_ev100(e_.value) : v(); }
  Error unsuitable(const char* what_to_do) const {
    if (e_.given == Given::as_file) return error("EMISSION_MISSING", "expected an emission, found none");
    Error e = error("UNIT_UNSUITABLE", fmt::format("{} says nothing about this shape", given()));
    e.hint = what_to_do;
    return e;
  }
  // The distance beside an illuminance, from the light's origin; the light reaches `nearest` towards it.
  Result<double> distance_beyond(double nearest) const {
    if (!e_.distance_m) return error("DISTANCE_MISSING", fmt::format("{} needs the distance at which it was measured", given()));
    if (!std::isfinite(*e_.distance_m) || !(*e_.distance_m > nearest))
      return error("NUMBER_INVALID", fmt::format("expected a distance greater than {} m, found {} m", nearest, *e_.distance_m));
    return *e_.distance_m;
  }

  // Flux spread over `given_sr` becomes intensity on the axis, which sends out `emitted_sr` times as much. E = I / d^2.
  Result<White> punctual(double given_sr, double emitted_sr) const {
    double intensity = v();
    if (e_.given == Given::flux) {
      if (!(given_sr > 0)) return error("SIZE_MISSING", "flux needs an opening angle greater than zero");
      intensity = v() / given_sr;
    } else if (e_.given == Given::illuminance) {
      const Result<double> d = distance_beyond(0);
      if (!d) return d.error();
      intensity = v() * square(*d);
    } else if (e_.given != Given::intensity) {
      return unsuitable("it has no surface; give its flux or its intensity, or a shape with a size");
    }
    return White{Kind::intensity, intensity, intensity * emitted_sr, 0};
  }

  // Uniform luminance L on all sides that emit: flux = pi L A (Lambert); I = L times the area seen along the axis.
  template <class S>
  Result<White> area(double face_m2, double nearest, const S* shape) const {
    const Result<double> one_side = emitting_area(light_, mesh_area_m2_);
    if (!one_side) {
      if (!std::holds_alternative<MeshShape>(light_.shape) || e_.given == Given::flux) return one_side.error();
    }
    const double area_m2 = one_side ? *one_side * (emits_both_sides(light_) ? 2 : 1) : 0;
    double luminance = 0;
    switch (e_.given) {
      case Given::flux:
        luminance = v() / (pi * area_m2);
        break;
      case Given::intensity:
        luminance = v() / face_m2;
        break;
      case Given::illuminance: {
        const Result<double> d = distance_beyond(nearest);
        if (!d) return d.error();
        luminance = v() / facing_factor(*shape, *d);
        break;
      }
      case Given::luminance:
      case Given::ev:
        luminance = luminance_given();
        break;
      case Given::as_file:
        return unsuitable("");
    }
    return White{Kind::luminance, luminance, pi * luminance * area_m2, area_m2};
  }

  const Light& light_;
  const Emission& e_;
  double mesh_area_m2_;
};

}  // namespace

Result<Resolved> resolve(const Light& light, double mesh_area_m2) {
  const Resolver resolver(light, mesh_area_m2);
  if (const Result<double> value = resolver.photometric(); !value) return value.error();
  const Result<Rgb> colour = rgb_of(light.colour);
  if (!colour) return resolver.error(colour.error().code.c_str(), colour.error().text);
  const Rgb& filter = light.filter;
  if (!finite(filter) || filter.x < 0 || filter.y < 0 || filter.z < 0)
    return resolver.error("COLOUR_INVALID", fmt::format("expected a filter of finite numbers that are not negative, found {} {} {}",
                                                        filter.x, filter.y, filter.z));
  const Result<White> white = std::visit(resolver, light.shape);
  if (!white) return white.error();

  const Rgb filtered = *colour * filter;
  const Resolved resolved{white->kind, filtered * white->value, white->flux_lm * luminance_of(filtered), white->area_m2};
  if (!finite(resolved.rgb) || !std::isfinite(resolved.flux_lm))
    return resolver.error("NUMBER_INVALID", "the emission is beyond the range of a double for this size");
  return resolved;
}

}  // namespace etendue
