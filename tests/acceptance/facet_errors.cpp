// Prints one line a diffuse model, surface of Lambertian facets and roughness: model, interface, masking, roughness, and two differences in
// per cent of all the light that the facets reflect: as it is, and with the model times the factor that suits it best. Both are means over
// views of every cosine and lights all over the hemisphere, of |f - facets| n.l.
#include "etendue/microfacet_diffuse.h"
#include "eval/quadrature.h"
#include "ratio_rules.h"

#include <fmt/core.h>

namespace {

using namespace etendue;
using namespace etendue::eval;

struct Pair {
  Vec3d view, light;
  double weight;
};

std::vector<Pair> pairs() {
  constexpr int azimuths = 16;
  std::vector<Pair> all;
  const auto cosine = [](const KronrodNode& node) { return 0.5 * (1 + node.x); };
  for (int i = 0; i < kronrod7().count; ++i) {
    const double nv = cosine(kronrod7().nodes[static_cast<std::size_t>(i)]), sv = std::sqrt(1 - nv * nv);
    for (const KronrodNode& node : kronrod15().nodes) {
      const double nl = cosine(node), sl = std::sqrt(1 - nl * nl);
      for (int k = 0; k < azimuths; ++k) {
        const double phi = pi * (k + 0.5) / azimuths;
        all.push_back({{sv, 0, nv},
                       {sl * std::cos(phi), sl * std::sin(phi), nl},
                       kronrod7().nodes[static_cast<std::size_t>(i)].weight * node.weight});
      }
    }
  }
  return all;
}

struct Difference {
  double plain, scaled;
};
Difference difference(const std::vector<Pair>& pairs, const Brdf& brdf, const std::vector<double>& facets) {
  double both = 0, square = 0, all = 0, plain = 0, scaled = 0;
  std::vector<double> values;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    values.push_back(brdf_cos(brdf, pairs[i].view, pairs[i].light).x);
    both += pairs[i].weight * values[i] * facets[i];
    square += pairs[i].weight * values[i] * values[i];
    all += pairs[i].weight * facets[i];
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    plain += pairs[i].weight * std::abs(values[i] - facets[i]);
    scaled += pairs[i].weight * std::abs(values[i] * both / square - facets[i]);
  }
  return {100 * plain / all, 100 * scaled / all};
}

}  // namespace

int main() {
  const std::vector<Pair> places = pairs();
  for (const auto& [interface, name] : {std::pair{FacetInterface::none, "none"},
                                        {FacetInterface::diffuse_exit, "diffuse_exit"},
                                        {FacetInterface::both_ways, "both_ways"}}) {
    for (const Masking masking : {Masking::correlated, Masking::separable}) {
      for (const double roughness : protocol::roughnesses) {
        std::vector<double> facets;
        facets.reserve(places.size());
        for (const Pair& p : places)
          facets.push_back(brdf_cos(LambertianFacets{roughness * roughness, masking, interface}, p.view, p.light, 1e-6).value);
        const auto tell = [&, interface_name = name](std::string_view model, const Brdf& brdf) {
          const Difference d = difference(places, brdf, facets);
          fmt::print("{} {} {} {} {:.3g} {:.3g}\n", model, interface_name, masking == Masking::correlated ? "correlated" : "separable",
                     roughness, d.plain, d.scaled);
        };
        tell("lambert", Lambert{{1, 1, 1}});
        for (const protocol::DiffuseModel& model : protocol::diffuse_models) tell(model.name, model.of(roughness));
      }
    }
  }
}
