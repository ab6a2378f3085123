// Shading points in float, for tests of batches.
#pragma once

#include "etendue/illuminance_batch.h"

#include <span>
#include <vector>

namespace etendue::eval {

struct FloatPoints {
  std::vector<float> px, py, pz, nx, ny, nz;
  Vec3d origin;

  void add(const Vec3d& position, const Vec3d& normal) {
    const Vec3f p = vec_cast<float>(position - origin), n = vec_cast<float>(normal);
    px.push_back(p.x), py.push_back(p.y), pz.push_back(p.z);
    nx.push_back(n.x), ny.push_back(n.y), nz.push_back(n.z);
  }
  std::size_t size() const { return px.size(); }
  PointBatch batch(std::size_t first, std::size_t count) const {
    const auto part = [&](const std::vector<float>& v) { return std::span(v).subspan(first, count); };
    return {part(px), part(py), part(pz), part(nx), part(ny), part(nz), origin};
  }
  PointBatch batch() const { return batch(0, size()); }
  // What the floats say.
  Vec3d position(std::size_t i) const { return origin + Vec3d{px[i], py[i], pz[i]}; }
  Vec3d normal(std::size_t i) const { return normalised(Vec3d{nx[i], ny[i], nz[i]}); }
};

}  // namespace etendue::eval
