// The picture of a rectangular light as a matt surface sees it from a distance: filtered beforehand, layer by layer.
//   DiffuseCard volume(card, width, height);
//   Rgb colour = volume.lookup(uv, distance);
#pragma once

#include "etendue/light_card.h"

#include <vector>

namespace etendue::eval {

// Drobot 2014 (GPU Pro 5), the lookup of equation 1.24: at a place of the rectangle and a distance straight in front of it, the mean of the
// picture with what each part's solid angle is there. Layers lie at 4, 2, 1, 1/2, ... of the longer side and have 1, 2^2, 4^2, ... places,
// so that places are a quarter of the distance apart. The article spaces layers evenly and leaves their number open.
class DiffuseCard {
 public:
  // Of 2^7 places a side at most, at a 32nd of the longer side. Nearer than the last layer is as on it, further than the first the mean.
  static constexpr int most_levels = 7;
  // Sides along u and v, m, above 0. Some tenths of a second for a picture of 1024 x 1024.
  DiffuseCard(const LightCard& card, double width, double height);

  // Linear between places and, in the logarithm of the distance (m), between layers. Outside, what is at the border.
  Rgb lookup(Vec2d uv, double distance) const;

 private:
  Rgb on(std::size_t layer, Vec2d uv) const;

  double longer_;
  Vec3f mean_;
  std::vector<std::vector<Vec3f>> layers_;
};

}  // namespace etendue::eval
