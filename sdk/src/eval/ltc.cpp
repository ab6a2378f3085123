// Linearly transformed cosines (Heitz, Dupuy, Hill and Neubelt 2016): the table, and lights seen through it.
#include "etendue/ltc.h"

#include "fresnel.h"
#include "hill_heitz.h"
#include "illuminance.h"
#include "specular_batch.h"
#include "specular_line.h"
#include "specular_view.h"
#include "transformed_contour.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

TransformedCosine transformed_cosine(const std::array<double, 5>& t, double alpha, double cosine) {
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  // Rows of the rotation that takes the mirror direction (-sine, 0, cosine) to z.
  const Vec3d x{cosine, 0, sine}, z{-sine, 0, cosine};
  const Vec3d first = x * t[0] + z * t[1], third = (x * t[3] + z * t[4]) * alpha;
  TransformedCosine result;
  result.inverse.columns = {Vec3d{first.x, 0, third.x}, Vec3d{0, 1 / t[2], 0}, Vec3d{first.z, 0, third.z}};
  return result;
}

double TransformedCosine::share_above() const { return 0.5 * (1 + normalised(inverse.normal({0, 0, 1})).z); }

double TransformedCosine::density(const Vec3d& light) const {
  const Vec3d there = inverse.vector(light);
  const double squared = dot(there, there);
  return std::max(there.z, 0.0) * std::abs(inverse.determinant()) / (pi * squared * squared);
}

double LtcTable::alpha_of(std::uint32_t row) const {
  const double root = static_cast<double>(row) / (size_ - 1);
  return std::max(root * root, lowest_alpha);
}
double LtcTable::cosine_of(std::uint32_t column) const { return std::max(static_cast<double>(column) / (size_ - 1), lowest_cosine); }

LtcLobe LtcTable::at(double alpha, double cosine) const {
  const double a = std::clamp(alpha, lowest_alpha, 1.0);
  const double x = std::clamp(cosine, 0.0, 1.0) * (size_ - 1), y = std::sqrt(a) * (size_ - 1);
  const std::uint32_t i = std::min(static_cast<std::uint32_t>(x), size_ - 2), j = std::min(static_cast<std::uint32_t>(y), size_ - 2);
  const double u = x - i, v = y - j;
  const Node* row = &nodes_[static_cast<std::size_t>(j) * size_ + i];
  const auto term = [&](std::size_t k) {
    return (row[0][k] * (1 - u) + row[1][k] * u) * (1 - v) + (row[size_][k] * (1 - u) + row[size_ + 1][k] * u) * v;
  };
  const auto cosine_from = [&](std::size_t k) {
    return transformed_cosine({term(k), term(k + 1), term(k + 2), term(k + 3), term(k + 4)}, a, std::clamp(cosine, 0.0, 1.0));
  };
  return {cosine_from(0),
          cosine_from(one),
          cosine_from(first),
          cosine_from(second),
          {term(albedo), term(of_first)},
          {term(albedo + 1), term(of_first + 1)}};
}

namespace {

// The cap of directions whose integral is that of a light's.
class Cap {
 public:
  explicit Cap(const Vec3d& integral) {
    const double length_of = length(integral);
    if (length_of > 0) axis_ = integral / length_of, sine_ = std::sqrt(std::min(length_of / pi, 1.0));
  }
  // The integral of the directions over what of it is above a plane, along z. The rim's part is half b x b' over the angle 2 phi, the
  // plane's the angle 2 psi that the cap takes of it.
  double above(const Vec3d& n) const {
    const double up = dot(n, axis_), whole = pi * sine_ * sine_ * axis_.z;
    if (up >= sine_) return whole;
    if (up <= -sine_) return 0;
    const double cosine = std::sqrt((1 - sine_) * (1 + sine_)), half_chord = std::sqrt((sine_ - up) * (sine_ + up));
    const double phi = std::atan2(half_chord, -cosine * up), psi = std::atan2(half_chord, cosine);
    const Vec3d across = n - axis_ * up;
    return axis_.z * sine_ * sine_ * phi - across.z * cosine * half_chord / std::max(dot(across, across), 1e-6) + n.z * psi;
  }

 private:
  Vec3d axis_{0, 0, 1};
  double sine_ = 0;
};

// pi times the share of the transformed cosine that the light covers: the cosine integral of the light seen through the inverse matrix.
struct Covered {
  const Emitter& emitter;
  const ShadingPoint& point;
  const ViewFrame& frame;
  const TransformedCosine& cosine;
  bool real_horizon;
  bool clamped = true;  // nothing is below the cosine's own horizon; else it is negative there

  // From the local frame of the point, in which lights have their outlines, to that of the view and on to the cosine's.
  Transform through(const LocalFrame& local) const {
    Transform t;
    for (int i = 0; i < 3; ++i) {
      Vec3d unit;
      unit[i] = 1;
      t.columns[i] = cosine.inverse.vector(frame.vector(local.to_world(unit)));
    }
    return t;
  }
  double operator()() const {
    const LocalFrame local(point.position, point.normal);
    const Horizons horizons = this->horizons(local);
    const Transform linear = through(local);
    const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape);
    if (polygon != nullptr && clamped && !(horizons.distinct && real_horizon)) return covered(*polygon, local, linear);
    return std::max(irradiance(local, horizons, linear).z, 0.0);
  }
  // The integral of the directions that the light covers there: its z is the answer above, and it leads to the light's middle.
  Vec3d irradiance(const LocalFrame& local, const Horizons& horizons, const Transform& linear) const {
    Vec3d sum;
    each_outline(emitter, local, [&](const Contour& outline, std::size_t) {
      const Contour seen = transformed(real_horizon ? clipped(outline, horizons) : outline, linear);
      sum += direction_integral(clamped ? clipped(seen, Vec3d{0, 0, 1}) : seen);
    });
    return sum;
  }
  Vec3d irradiance() const {
    const LocalFrame local(point.position, point.normal);
    return irradiance(local, horizons(local), through(local));
  }
  Horizons horizons(const LocalFrame& local) const { return horizons_of(local, point.normal, point.surface_normal); }
  // The same of all of the light, above the horizon or not.
  Vec3d whole_irradiance() const {
    const LocalFrame local(point.position, point.normal);
    const Transform linear = through(local);
    Vec3d sum;
    each_outline(emitter, local, [&](const Contour& outline, std::size_t) { sum += direction_integral(transformed(outline, linear)); });
    return sum;
  }
  // Of a cap, cut at the surface's horizon alone: below its own horizon the cosine counts as negative, which is little where a lobe is, and
  // nearer on the mean than none. Nothing once all of the light is below the surface's horizon.
  double share_as_cap() const {
    const LocalFrame local(point.position, point.normal);
    const Horizons horizons = this->horizons(local);
    bool is_up = false;
    each_outline(emitter, local, [&](const Contour& outline, std::size_t) { is_up = is_up || !clipped(outline, horizons).empty(); });
    const Vec3d horizon = normalised(cosine.inverse.normal({0, 0, 1}));
    return is_up ? std::clamp(Cap(whole_irradiance()).above(horizon) / (pi * cosine.share_above()), 0.0, 1.0) : 0;
  }
  // The horizon of the surface is a plane through the point there too.
  double covered(const PolygonEmitter& polygon, const LocalFrame& local, const Transform& linear) const {
    if (polygon.vertices.size() < 3) return 0;
    const double height = dot(point.position - polygon.vertices[0], polygon.normal);
    if (!(height > 0 || (emitter.two_sided && height < 0))) return 0;
    std::vector<Vec3d> vertices;
    vertices.reserve(polygon.vertices.size());
    for (const Vec3d& p : polygon.vertices) vertices.push_back(linear.vector(local.point(p)));
    const Horizons horizon{normalised(linear.normal({0, 0, 1})), real_horizon};
    return std::max((height > 0 ? -1 : 1) * projected_solid_angle(vertices, horizon), 0.0);
  }
};

// Schlick's weight at the direction that goes to `there` in the cosine's space.
double weight_towards(const Vec3d& there, const TransformedCosine& cosine, const Vec3d& view) {
  // Cramer's rule, but for the determinant, which is positive.
  const auto& [a, b, c] = cosine.inverse.columns;
  const Vec3d half = view + normalised(Vec3d{dot(cross(b, c), there), dot(cross(c, a), there), dot(cross(a, b), there)});
  return schlick_weight(dot(view, half) / std::max(length(half), 1e-12));
}

enum class Form { four_terms, published, one_lobe, representative, one_cosine, two_lobes, two_cosines, two_caps };

std::optional<Rgb> through_table(const Emitter& emitter, const ShadingPoint& point, Form form) {
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  const LineEmitter* line = plain_line(emitter);
  if (!lobe || (line == nullptr ? !is_uniform_area_light(emitter) : form == Form::two_caps)) return std::nullopt;
  const ViewFrame frame(point.normal, point.view);
  if (!(frame.cosine > 0)) return Rgb{};
  LtcLobe fit = ltc_table().at(lobe->alpha, frame.cosine);
  if (form == Form::four_terms) fit.whole = four_term_cosine(lobe->alpha, frame.cosine);
  const bool published = form == Form::four_terms || form == Form::published;
  const Rgb scale = line != nullptr ? line->intensity : luminance_of(emitter);
  const bool clamped = form != Form::one_cosine && form != Form::two_cosines;
  const auto light_through = [&](const TransformedCosine& cosine) { return Covered{emitter, point, frame, cosine, !published, clamped}; };
  // Integral over the light of the cosine times the direction in its space; the z of that is the light's share, of a line without bound.
  const auto covered = [&](const TransformedCosine& cosine) {
    const Covered light = light_through(cosine);
    if (line == nullptr) return light.irradiance() / pi;
    const LocalFrame local(point.position, point.normal);
    const std::optional<LineView> seen =
        published ? line_view(local.point(line->a), local.point(line->b)) : seen_line(*line, local, light.horizons(local));
    return seen ? cosine_along(*seen, light.through(local)) : Vec3d{};
  };
  const auto kept = [&](double share, const TransformedCosine& cosine) {
    const double above = published ? share : share / cosine.share_above();
    return line == nullptr && !published ? std::min(above, 1.0) : above;
  };
  const auto share = [&](const TransformedCosine& cosine) {
    if (form == Form::two_caps) return light_through(cosine).share_as_cap();
    return kept(line == nullptr ? light_through(cosine)() / pi : covered(cosine).z, cosine);
  };
  if (form == Form::representative || form == Form::one_cosine) {
    const TransformedCosine& cosine = form == Form::representative ? fit.whole : fit.one;
    const Vec3d there = covered(cosine);
    const double part = kept(there.z, cosine);
    if (!(part > 0)) return Rgb{};
    const bool by_whole = form == Form::one_cosine && is_round(emitter);
    const double lit = part * (fit.f0.albedo + fit.f90.albedo);
    const double weight = weight_towards(by_whole ? light_through(cosine).whole_irradiance() : there, cosine, frame.vector(point.view));
    return scale * (lobe->f0 * (lit * (1 - weight)) + Rgb{1, 1, 1} * (lit * lobe->f90 * weight));
  }
  const bool two = form == Form::two_lobes || form == Form::two_cosines || form == Form::two_caps;
  const double first = share(two ? fit.first : fit.whole), second = two ? share(fit.second) : first;
  // No part of a lobe gives less than nothing, nor has an area light more than all of it.
  const bool is_bounded = line == nullptr && !published;
  const auto of_part = [&](const LtcLobe::Part& part) {
    return std::clamp(part.of_first * first + (part.albedo - part.of_first) * second, 0.0, is_bounded ? part.albedo : HUGE_VAL);
  };
  return scale * (lobe->f0 * of_part(fit.f0) + Rgb{1, 1, 1} * (lobe->f90 * of_part(fit.f90)));
}
template <Form form>
std::optional<Rgb> luminance(const Emitter& emitter, const ShadingPoint& point) {
  return through_table(emitter, point, form);
}

constexpr std::string_view article = "Heitz, Dupuy, Hill and Neubelt 2016, with the table of this library";
constexpr SpecularMethod methods[] = {
    {"ltc-four-terms", article,
     "As in 2016: 64 x 64 matrices over the square root of alpha and the angle of the view, divided by their last term, which makes the "
     "others "
     "vary so fast that narrow lobes are misplaced between them: a sun on alpha .001 is 1.6 % off instead of .02 %.",
     luminance<Form::four_terms>},
    {"ltc-unclipped", article,
     "As published: cut at the horizon of the cosine alone, so that light from below the surface's leaks in; Fresnel's term averaged over "
     "the lobe.",
     luminance<Form::published>},
    {"ltc", article, "The light is cut at the surface's horizon first, and the cosine is one for what is above it.",
     luminance<Form::one_lobe>},
    {"ltc-fresnel", article,
     "The same, with Schlick's Fresnel at the direction of what the light covers of the cosine, instead of averaged over the lobe.",
     luminance<Form::representative>},
    {"ltc-one-cosine", article,
     "As ltc-fresnel, with a cosine that is fitted between the nodes of its table too and is negative below its own horizon in place of "
     "cut "
     "there: cheaper than ltc. Of round lights the direction is that of the whole light.",
     luminance<Form::one_cosine>},
    {"ltc-two-lobes", article,
     "The same, with a sum of two cosines for the part of the lobe that Fresnel's term weighs with f0, and another of the same two for "
     "that with f90.",
     luminance<Form::two_lobes>},
    {"ltc-two-cosines", article,
     "The same two, negative below their own horizons in place of cut there: cheaper. Lights that fill most of the sky are a little "
     "too dark.",
     luminance<Form::two_cosines>},
    {"ltc-two-caps", article,
     "The same, the light replaced by the cap of the same vector irradiance, which the surface's horizon cuts: cheaper for round lights. "
     "Those that fill most of the sky are too dark, on rough surfaces by up to a third.",
     luminance<Form::two_caps>},
};

}  // namespace

std::span<const SpecularMethod> ltc_methods() { return methods; }

}  // namespace etendue::eval
