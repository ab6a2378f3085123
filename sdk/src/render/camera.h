// Primary rays of a pinhole camera: looks along its -Z, +Y up; pixel (0, 0) is the upper left one and covers [0, 1] x [0, 1].
#pragma once

#include "shapes.h"

#include "etendue/scene.h"

#include <cmath>
#include <cstdint>

namespace etendue::rendering {

class PinholeCamera {
 public:
  PinholeCamera(const Camera& camera, std::uint32_t width, std::uint32_t height)
      : frame_(camera.transform.rigid()), width_(width), height_(height), half_height_(std::tan(camera.vfov_rad / 2)) {}

  const Vec3d& position() const { return frame_.translation; }
  Ray through(double x, double y) const {
    const double aspect = static_cast<double>(width_) / height_;
    const Vec3d local{(2 * x / width_ - 1) * half_height_ * aspect, (1 - 2 * y / height_) * half_height_, -1};
    return {frame_.translation, normalised(frame_.vector(local))};
  }

 private:
  Transform frame_;
  std::uint32_t width_, height_;
  double half_height_;
};

}  // namespace etendue::rendering
