// filter_normals(): the chain of mip levels of a normal map.
#include "etendue/normal_filter.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace etendue {
namespace {

// What levels are averages of.
struct Sums {
  Vec3d normal;
  double squared_alpha = 0;
};
struct Means {
  std::uint32_t width, height;
  std::vector<Sums> texels;
};

// Texel i of `fewer` covers [i, i + 1) n / fewer of the n below it, the ones at its ends in part.
struct Cover {
  std::uint32_t first;
  std::vector<double> shares;  // of the texels from `first` on, 1 in sum
};
std::vector<Cover> covers(std::uint32_t n, std::uint32_t fewer) {
  std::vector<Cover> all(fewer);
  for (std::uint32_t i = 0; i < fewer; ++i) {
    // In units of 1 / fewer of a texel all ends are whole numbers.
    const std::uint64_t begin = std::uint64_t{i} * n, end = begin + n;
    all[i].first = static_cast<std::uint32_t>(begin / fewer);
    for (std::uint64_t t = begin / fewer; t * fewer < end; ++t) {
      const std::uint64_t covered = std::min(end, (t + 1) * fewer) - std::max(begin, t * fewer);
      all[i].shares.push_back(static_cast<double>(covered) / n);
    }
  }
  return all;
}

Means halved(const Means& from) {
  Means to{std::max(1u, from.width / 2), std::max(1u, from.height / 2), {}};
  to.texels.resize(std::size_t{to.width} * to.height);
  const std::vector<Cover> columns = covers(from.width, to.width), rows = covers(from.height, to.height);
  for (std::uint32_t y = 0; y < to.height; ++y) {
    for (std::uint32_t x = 0; x < to.width; ++x) {
      Sums& sum = to.texels[std::size_t{y} * to.width + x];
      for (std::size_t j = 0; j < rows[y].shares.size(); ++j) {
        for (std::size_t i = 0; i < columns[x].shares.size(); ++i) {
          const Sums& part = from.texels[(rows[y].first + j) * from.width + columns[x].first + i];
          const double share = rows[y].shares[j] * columns[x].shares[i];
          sum.normal += part.normal * share;
          sum.squared_alpha += part.squared_alpha * share;
        }
      }
    }
  }
  return to;
}

NormalLevel level_of(const Means& means, NormalFilter filter) {
  NormalLevel level{means.width, means.height, {}, {}, {}, {}};
  const std::size_t count = means.texels.size();
  level.means.reserve(count), level.authored_alphas.reserve(count), level.alphas.reserve(count), level.misplaced.reserve(count);
  for (const Sums& texel : means.texels) {
    const double authored = std::min(1.0, std::sqrt(texel.squared_alpha));
    const FilteredLobe lobe = filtered_lobe(authored, length(texel.normal), filter);
    level.means.push_back({static_cast<float>(texel.normal.x), static_cast<float>(texel.normal.y), static_cast<float>(texel.normal.z)});
    level.authored_alphas.push_back(static_cast<float>(authored));
    level.alphas.push_back(static_cast<float>(lobe.alpha));
    level.misplaced.push_back(static_cast<float>(lobe.misplaced));
  }
  return level;
}

Error unsuitable(std::string text) { return {"FIELD_UNSUITABLE", std::move(text), {}, {}, {}}; }

Result<Means> unit_means(const NormalField& field) {
  const std::size_t count = std::size_t{field.width} * field.height;
  if (count == 0 || field.normals.size() != count)
    return unsuitable("expected " + std::to_string(count) + " normals, at least one, found " + std::to_string(field.normals.size()));
  if (field.alphas.size() != count && field.alphas.size() != 1)
    return unsuitable("expected one alpha or " + std::to_string(count) + ", found " + std::to_string(field.alphas.size()));
  Means means{field.width, field.height, {}};
  means.texels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&] { return " at column " + std::to_string(i % field.width) + ", row " + std::to_string(i / field.width); };
    const Vec3f& n = field.normals[i];
    const Vec3d normal{static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
    const double norm = length(normal), alpha = static_cast<double>(field.alphas[field.alphas.size() == 1 ? 0 : i]);
    if (!(norm > 0) || !std::isfinite(norm)) return unsuitable("expected a normal with a direction, found none" + at());
    if (!(alpha >= 0 && alpha <= 1)) return unsuitable("expected an alpha from 0 to 1, found " + std::to_string(alpha) + at());
    means.texels.push_back({normal / norm, alpha * alpha});
  }
  return means;
}

}  // namespace

Result<std::vector<NormalLevel>> filter_normals(const NormalField& field, NormalFilter filter) {
  Result<Means> means = unit_means(field);
  if (!means) return means.error();
  std::vector<NormalLevel> levels{level_of(*means, filter)};
  while (means->width > 1 || means->height > 1) {
    *means = halved(*means);
    levels.push_back(level_of(*means, filter));
  }
  return levels;
}

}  // namespace etendue
