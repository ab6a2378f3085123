// A scene made ready for rays: everything in the world, textures decoded, lights as emitters.
#pragma once

#include "emitters.h"
#include "surface.h"

#include "etendue/render.h"

#include <deque>
#include <string>

namespace etendue::rendering {

// The ball around a light's shape.
struct Ball {
  Vec3d centre;
  double radius;
};

struct StageLight {
  std::uint32_t index = 0;  // into Scene::lights
  std::string layer;        // "light.NAME"
  eval::Emitter emitter;
  eval::Emitter as_seen;           // without window: what the camera meets
  std::uint32_t thing = no_index;  // its visible shape
  std::optional<Ball> extent;      // of a sphere, disk, polygon or tube
  bool delta = false;              // one direction a point: punctual and true directions
  bool analytic = true;            // a LightPlan is exact and cheap enough; else sampled alone
  // Of a picture: then it is so on surfaces without a narrow lobe.
  std::shared_ptr<const eval::PictureMoments> picture = {};
  bool convex = true;       // cannot hide a part of its own front from anybody
  bool background = false;  // seen behind everything: an environment, or a sun with a disk
};

class Stage {
 public:
  // Errors as render().
  static Result<std::unique_ptr<Stage>> build(const Scene& scene, const RenderOptions& options, Diagnostics& diagnostics);

  // The nearest surface; holes of paints are passed through.
  std::optional<SurfacePoint> first(const Ray& ray) const;
  // Whether anything stands between a point and a place `distance` away. `normal`: the true surface's, either side. `skip`: a convex light.
  bool blocked(const SurfacePoint& from, const Vec3d& direction, double distance, std::uint32_t skip) const;

  const Thing& thing(std::uint32_t number) const { return things_[number]; }
  const std::vector<StageLight>& lights() const { return lights_; }  // those that emit
  std::uint64_t images_decoded() const { return images_.size(); }
  // False where nothing but the light itself could stand in its way.
  bool can_be_blocked(const StageLight& light) const;

 private:
  Stage() = default;
  Status add_objects(const Scene& scene, const RenderOptions& options);
  Status add_lights(const Scene& scene, const RenderOptions& options);
  Status add_light(const Scene& scene, std::uint32_t index, bool lit, const RenderOptions& options);
  Result<const DecodedImage*> image(const Scene& scene, const Texture& texture);
  Result<const Paint*> paint(const Scene& scene, std::uint32_t material, const RenderOptions& options);
  Thing& add_thing();
  Result<PicturedEmitter> emitter(const Scene& scene, const Light& light, bool with_picture);

  struct Image {
    std::uint32_t index;
    Encoding encoding;
    std::unique_ptr<DecodedImage> pixels;
  };
  struct NamedPaint {
    std::uint32_t material;
    Paint paint;
  };
  std::deque<Thing> things_;
  std::deque<NamedPaint> paints_;
  std::deque<Image> images_;
  std::vector<StageLight> lights_;
  Rays rays_;
  bool holes_ = false;
  Ray shadow_ray(const SurfacePoint& from, const Vec3d& direction, double& distance) const;

  double offset_ = 0;          // how far above a surface a shadow ray starts, in metres
  bool mitsuba_rays_ = false;  // shadow rays as Mitsuba's
};

}  // namespace etendue::rendering
