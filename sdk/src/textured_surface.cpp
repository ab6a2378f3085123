#include "etendue/textured_surface.h"

namespace etendue {
namespace {

struct Times {
  const SurfaceTexels& t;
  SurfaceModel operator()(const Lambert& m) const { return Lambert{m.base_colour * t.base_colour}; }
  SurfaceModel operator()(const Principled& m) const {
    return Principled{m.base_colour * t.base_colour, m.metallic * t.metallic, m.roughness * t.roughness, m.specular};
  }
  SurfaceModel operator()(const Standard& m) const {
    return Standard{m.base_colour * t.base_colour, m.metal * t.metallic, m.roughness * t.roughness, m.reflectance};
  }
  SurfaceModel operator()(const Conductor& m) const { return m; }
  SurfaceModel operator()(const MetalRough& m) const {
    return MetalRough{m.base_colour * t.base_colour, m.metallic * t.metallic, m.roughness * t.roughness, m.ior};
  }
  SurfaceModel operator()(const SpecularGlossiness& m) const {
    return SpecularGlossiness{m.diffuse * t.base_colour, m.specular * t.specular, m.glossiness * t.glossiness};
  }
};

}  // namespace

SurfaceModel textured(const SurfaceModel& model, const SurfaceTexels& texels) { return std::visit(Times{texels}, model); }

}  // namespace etendue
