// A town at night: street lamps of four kinds on a grid, points on its ground and on the walls along its streets.
#pragma once

#include "etendue/rig_batch.h"
#include "eval_protocol.h"
#include "float_points.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue::eval::street {

constexpr double spacing = 30, height = 8;

// columns x rows lamps, one every 30 m, 8 m above the ground, 4000 to 12000 lm, warm white: LED panels and round ones that face the ground,
// a tube and a globe of opal glass that shine all around.
inline std::vector<Emitter> lamps(int columns, int rows, protocol::Random& random) {
  std::vector<Emitter> lights;
  for (int i = 0; i < columns * rows; ++i) {
    const int column = i % columns, row = i / columns;
    const Vec3d at{spacing * column + random.uniform(-3, 3), height + random.uniform(-0.5, 0.5), spacing * row + random.uniform(-3, 3)};
    Emitter e;
    double area = 0;
    switch (i % 8) {
      case 1:
        e.shape = SphereEmitter{at, 0.2}, area = 4 * pi * 0.04;
        break;
      case 5:
        e.shape = TubeEmitter{at - Vec3d{0.3, 0, 0}, at + Vec3d{0.3, 0, 0}, 0.04, Caps::round}, area = 2 * pi * 0.04 * (0.6 + 2 * 0.04);
        break;
      case 0:
      case 3:
      case 6:
        e.shape = DiskEmitter{at, {0, -1, 0}, {1, 0, 0}, 0.2}, area = pi * 0.04;
        break;
      default:
        e.shape = protocol::rectangle(at, {1, 0, 0}, {0, 0, 1}, 0.5, 0.25), area = 0.125;
        break;
    }
    const double lumens = random.uniform(4000, 12000);
    e.radiance = Rgb{1.22, 0.96, 0.73} * (lumens / (pi * area));
    lights.push_back(e);
  }
  return lights;
}

// Anywhere in the town, in random order: four in five on the ground, the others on walls of up to 6 m.
inline FloatPoints points(int columns, int rows, std::size_t count, protocol::Random& random) {
  FloatPoints all;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(-0.5, columns - 0.5) * spacing, z = random.uniform(-0.5, rows - 0.5) * spacing;
    if (random.uniform(0, 1) < 0.8) {
      all.add({x, 0, z}, {0, 1, 0});
    } else {
      const double side = random.uniform(0, 1) < 0.5 ? -1 : 1;
      const bool along = random.uniform(0, 1) < 0.5;
      all.add({x, random.uniform(0, 6), z}, along ? Vec3d{side, 0, 0} : Vec3d{0, 0, side});
    }
  }
  return all;
}

// Street by street: rows of cells of 2 m.
inline FloatPoints in_order(const FloatPoints& points) {
  struct Key {
    int row, column;
    std::size_t index;
    bool operator<(const Key& o) const { return std::tie(row, column, index) < std::tie(o.row, o.column, o.index); }
  };
  std::vector<Key> keys;
  for (std::size_t i = 0; i < points.size(); ++i)
    keys.push_back({static_cast<int>(std::floor(points.pz[i] / 2)), static_cast<int>(std::floor(points.px[i] / 2)), i});
  std::sort(keys.begin(), keys.end());
  FloatPoints sorted;
  for (const Key& k : keys) sorted.add(points.position(k.index), points.normal(k.index));
  return sorted;
}

// How few lights are enough: the most that the others give together is the tolerance. `which` gets those that are needed.
inline std::size_t lights_that_matter(const std::vector<Emitter>& lights, const Vec3d& position, const Vec3d& normal, double tolerance_lx,
                                      std::vector<std::size_t>& which) {
  std::vector<std::pair<double, std::size_t>> each;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Rgb lux = illuminance(lights[i], position, normal);
    each.emplace_back(std::max({lux.x, lux.y, lux.z}), i);
  }
  std::sort(each.begin(), each.end());
  double left_out = 0;
  std::size_t from = 0;
  while (from < each.size() && left_out + each[from].first <= tolerance_lx) left_out += each[from++].first;
  which.clear();
  for (std::size_t k = from; k < each.size(); ++k) which.push_back(each[k].second);
  return which.size();
}

}  // namespace etendue::eval::street
