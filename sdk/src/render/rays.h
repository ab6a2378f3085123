// Visibility through Embree: triangles and analytic shapes; the hit is refined in double.
#pragma once

#include "shapes.h"

#include "etendue/result.h"
#include "etendue/scene.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace etendue::rendering {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

struct Hit {
  std::uint32_t thing = no_index;  // in the order of add(); no_index: nothing was hit
  std::uint32_t triangle = 0;
  double t = infinite;
  double u = 0, v = 0;  // barycentric, of the triangle's second and third corner
  bool something() const { return thing != no_index; }
};

struct Triangles {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> corners;
};

class Rays {
 public:
  Rays();
  ~Rays();
  Rays(const Rays&) = delete;
  Rays& operator=(const Rays&) = delete;

  // Borrowed: they must live as long as this. Return the thing's number, 0, 1, 2 ...
  std::uint32_t add(const Triangles& triangles);
  std::uint32_t add(const Shape& shape);
  // After the last add(). Error: OUT_OF_MEMORY or what else Embree says.
  Status commit();

  // `skip`: an analytic thing that does not count.
  Hit closest(const Ray& ray, double t_min, double t_max, std::uint32_t skip = no_index) const;
  bool blocked(const Ray& ray, double t_min, double t_max, std::uint32_t skip = no_index) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace etendue::rendering
