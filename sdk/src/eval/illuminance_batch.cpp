// Many points under one light: by the kernel of its shape, else one by one.
#include "etendue/illuminance_batch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "batch_error.h"
#include "light_batch.h"
#include "window_part.h"

namespace etendue::eval {
namespace {

Vec3d at(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::size_t i) {
  return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
}

class OneByOne final : public LightBatch::Shape {
 public:
  explicit OneByOne(const Emitter& white) : white_(white) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    std::size_t without = 0;
    for (std::size_t i = 0; i < sr.size(); ++i) {
      const Vec3d p = at(points.px, points.py, points.pz, i), n = at(points.nx, points.ny, points.nz, i);
      const bool valid = std::isfinite(dot(p, p)) && std::isfinite(dot(n, n));
      sr[i] = valid ? in_double(white_, points, i) : where_none;
      if (!valid) ++without;
    }
    return without;
  }

 private:
  Emitter white_;
};

std::shared_ptr<const LightBatch::Shape> batch_of(const Emitter& white) {
  if (std::holds_alternative<PunctualEmitter>(white.shape)) return punctual_batch(white);
  if (std::holds_alternative<DistantEmitter>(white.shape)) return distant_batch(white);
  if (is_window(white.window)) {
    return Taken::suits(white.window) && std::holds_alternative<PolygonEmitter>(white.shape) ? polygon_batch(white) : nullptr;
  }
  if (std::holds_alternative<SphereEmitter>(white.shape)) return sphere_batch(white);
  if (std::holds_alternative<PolygonEmitter>(white.shape)) {
    if (auto rect = rect_batch(white)) return rect;
    return polygon_batch(white);
  }
  if (std::holds_alternative<TubeEmitter>(white.shape)) return tube_batch(white);
  if (std::holds_alternative<MeshEmitter>(white.shape)) return mesh_batch(white);
  if (std::holds_alternative<LineEmitter>(white.shape)) return line_batch(white);
  if (std::holds_alternative<DiskEmitter>(white.shape)) return disk_batch(white);
  return nullptr;
}

struct Scale {
  Emitter& emitter;
  Rgb& operator()(PunctualEmitter& e) const { return e.intensity; }
  Rgb& operator()(DistantEmitter& e) const { return e.illuminance; }
  Rgb& operator()(LineEmitter& e) const { return e.intensity; }
  template <class Area>
  Rgb& operator()(Area&) const {
    return emitter.radiance;
  }
};

}  // namespace

double unit_for(double size) { return size > 0 && std::isfinite(size) ? std::exp2(-std::floor(std::log2(size))) : 1; }

float in_double(const Emitter& white, const PointBatch& p, std::size_t i) {
  const double value = illuminance(white, at(p.px, p.py, p.pz, i) + p.origin, normalised(at(p.nx, p.ny, p.nz, i))).x;
  return static_cast<float>(std::min(value, static_cast<double>(std::numeric_limits<float>::max())));
}

Result<LightBatch> LightBatch::of(const Emitter& emitter) {
  if (!has_closed_form(emitter)) return Error{"EVALUATION_UNSUPPORTED", "expected a light without pattern or map", {}, {}, {}};
  Emitter white = emitter;
  const Rgb scale = std::exchange(std::visit(Scale{white}, white.shape), Rgb{1, 1, 1});
  std::shared_ptr<const Shape> shape = batch_of(white);
  return LightBatch(shape ? std::move(shape) : std::make_shared<OneByOne>(white), scale);
}

BatchOutcome LightBatch::projected_solid_angles(const PointBatch& points, std::span<float> values, float where_none) const {
  for (const std::span<const float>& s : {points.px, points.py, points.pz, points.nx, points.ny, points.nz})
    if (s.size() != values.size()) return batch_sizes_differ(s.size(), values.size());
  return shape_->over(points, values, where_none);
}

}  // namespace etendue::eval
