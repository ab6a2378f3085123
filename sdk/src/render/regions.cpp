#include "regions.h"
#include "hashing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace etendue::rendering {
namespace {

constexpr int places_on_a_line = 9;
constexpr double narrowest = 1e-5;  // pixels: how well an edge is located on a scanline
constexpr int first_lines = 4, most_lines = 32;
constexpr std::uint32_t nodes_where_shading_varies = 4;

struct Look {
  double s;  // along the scanline, 0 to 1
  Probe probe;
};
// A stretch of a scanline without a discontinuity.
struct Piece {
  double begin, end;
  double across;     // the scanline's place
  double weight;     // the scanline's, of all
  std::size_t kind;  // equal for what is the same, see same()
  SurfaceKind surface;
  bool lambert;
};

class Scanner {
 public:
  Scanner(const Prober& prober, const Stage& stage, std::uint32_t x, std::uint32_t y, bool along_x, RayCounts& counts)
      : prober_(prober), stage_(stage), x_(x), y_(y), along_x_(along_x), counts_(counts) {}

  Node node(double along, double across, double weight, std::uint32_t region) const {
    const auto a = static_cast<float>(along), b = static_cast<float>(across), w = static_cast<float>(weight);
    return along_x_ ? Node{a, b, w, region} : Node{b, a, w, region};
  }

  void scan(double across, double weight, std::vector<Piece>& pieces) {
    weight_ = weight;
    Look left = look(0, across);
    double begin = 0;
    for (int i = 1; i < places_on_a_line; ++i) {
      Look right = look(static_cast<double>(i) / (places_on_a_line - 1), across);
      split(left, right, across, begin, pieces);
      left = right;
    }
    close(begin, 1, across, left.probe, pieces);
  }

  // What a scanline meets, in order.
  std::vector<std::size_t> kinds_along(double across) {
    std::vector<Piece> pieces;
    scan(across, 1, pieces);
    std::vector<std::size_t> kinds;
    kinds.reserve(pieces.size());
    for (const Piece& p : pieces) kinds.push_back(p.kind);
    return kinds;
  }
  const std::vector<Probe>& kinds() const { return kinds_; }  // that were met

  std::size_t kind_at(double along, double across) { return kind_of(look(along, across).probe); }
  std::size_t kind_in_pixel(double u, double v) { return kind_of(prober_.look(x_ + u, y_ + v, counts_)); }

 private:
  Look look(double along, double across) const {
    const double u = along_x_ ? along : across, v = along_x_ ? across : along;
    return {along, prober_.look(x_ + u, y_ + v, counts_)};
  }

  // Finds what lies between two places: bisection towards the edge, both halves if the middle is a third thing.
  void split(const Look& left, const Look& right, double across, double& begin, std::vector<Piece>& pieces) {
    if (same(left.probe, right.probe)) return;
    Look a = left, b = right;
    while (b.s - a.s > narrowest) {
      Look middle = look((a.s + b.s) / 2, across);
      if (same(a.probe, middle.probe)) {
        a = middle;
      } else if (same(b.probe, middle.probe)) {
        b = middle;
      } else {
        split(a, middle, across, begin, pieces);
        a = middle;
      }
    }
    const double edge = (a.s + b.s) / 2;
    close(begin, edge, across, a.probe, pieces);
    begin = edge;
  }

  void close(double begin, double end, double across, const Probe& probe, std::vector<Piece>& pieces) {
    if (end > begin) pieces.push_back({begin, end, across, weight_, kind_of(probe), surface_of(probe), is_lambert(probe)});
  }

  std::size_t kind_of(const Probe& probe) {
    const auto known = std::find_if(kinds_.begin(), kinds_.end(), [&](const Probe& kind) { return same(kind, probe); });
    const auto kind = static_cast<std::size_t>(known - kinds_.begin());
    if (known == kinds_.end()) kinds_.push_back(probe);
    return kind;
  }

  bool is_lambert(const Probe& probe) const {
    const Paint* paint = probe.point ? stage_.thing(probe.point->thing).paint : nullptr;
    return paint == nullptr || std::holds_alternative<Lambert>(paint->material.model);
  }

  SurfaceKind surface_of(const Probe& probe) const {
    if (!probe.point) return {true, false};
    const std::uint32_t thing = probe.point->thing;
    const Paint* paint = stage_.thing(thing).paint;
    const bool patterned = std::any_of(stage_.lights().begin(), stage_.lights().end(),
                                       [&](const StageLight& light) { return light.thing == thing && light.emitter.pattern; });
    const bool textured = patterned || (paint != nullptr && paint->textured());
    return {textured || !probe.point->flat, textured};
  }

  const Prober& prober_;
  const Stage& stage_;
  std::uint32_t x_, y_;
  bool along_x_;
  RayCounts& counts_;
  double weight_ = 1;         // of the scanline that is being scanned
  std::vector<Probe> kinds_;  // met so far
};

// Scanlines should cross the edges: they run along x if the corners differ more from left to right than from top to bottom.
bool runs_along_x(const Prober& prober, std::uint32_t x, std::uint32_t y, RayCounts& counts) {
  const Probe a = prober.look(x, y, counts), b = prober.look(x + 1.0, y, counts);
  const Probe c = prober.look(x, y + 1.0, counts), d = prober.look(x + 1.0, y + 1.0, counts);
  const int horizontal = !same(a, b) + !same(c, d), vertical = !same(a, c) + !same(b, d);
  return horizontal >= vertical;
}

std::map<std::size_t, double> areas_of(const std::vector<Piece>& pieces) {
  std::map<std::size_t, double> areas;
  for (const Piece& p : pieces) areas[p.kind] += (p.end - p.begin) * p.weight;
  return areas;
}

double largest_difference(const std::map<std::size_t, double>& a, const std::map<std::size_t, double>& b) {
  double most = 0;
  for (const auto& [key, area] : a) {
    const auto other = b.find(key);
    most = std::max(most, std::abs(area - (other == b.end() ? 0 : other->second)));
  }
  for (const auto& [key, area] : b) {
    if (a.find(key) == a.end()) most = std::max(most, area);
  }
  return most;
}

// One node at the region's centroid if that is inside the region (shading is linear there as far as a pixel can tell).
void add_centroid(Scanner& scanner, const std::vector<Piece>& pieces, double area, std::uint32_t region, std::vector<Node>& nodes) {
  Vec2d centroid;
  double total = 0;
  for (const Piece& p : pieces) {
    const double size = p.end - p.begin;
    centroid.x += size * (p.begin + p.end) / 2;
    centroid.y += size * p.across;
    total += size;
  }
  centroid = {centroid.x / total, centroid.y / total};
  Vec2d chosen = centroid;
  if (scanner.kind_at(centroid.x, centroid.y) != pieces.front().kind) {
    const auto distance = [&](const Piece& p) { return std::hypot((p.begin + p.end) / 2 - centroid.x, p.across - centroid.y); };
    const Piece& nearest =
        *std::min_element(pieces.begin(), pieces.end(), [&](const Piece& a, const Piece& b) { return distance(a) < distance(b); });
    chosen = {(nearest.begin + nearest.end) / 2, nearest.across};
  }
  nodes.push_back(scanner.node(chosen.x, chosen.y, area, region));
}

// Stratified along the scanlines laid end to end.
void add_stratified(const Scanner& scanner, const std::vector<Piece>& pieces, double area, std::uint32_t region, Random& random,
                    std::vector<Node>& nodes) {
  double total = 0;
  for (const Piece& p : pieces) total += p.end - p.begin;
  const std::uint32_t count = nodes_where_shading_varies;
  std::size_t piece = 0;
  double passed = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double target = (i + random.next()) / count * total;
    while (piece + 1 < pieces.size() && passed + (pieces[piece].end - pieces[piece].begin) < target) {
      passed += pieces[piece].end - pieces[piece].begin;
      ++piece;
    }
    const Piece& p = pieces[piece];
    nodes.push_back(scanner.node(std::clamp(p.begin + target - passed, p.begin, p.end), p.across, area / count, region));
  }
}

// Places over the whole pixel, one at random in each of cells x cells, by what they fall on: for textured regions, whose areas are known
// better than the places' numbers say.
std::map<std::size_t, std::vector<Vec2d>> places_by_kind(Scanner& scanner, Random& random) {
  constexpr int cells = 12;
  std::map<std::size_t, std::vector<Vec2d>> places;
  for (int i = 0; i < cells * cells; ++i) {
    const int column = i % cells, row = i / cells;
    const Vec2d place{(column + random.next()) / cells, (row + random.next()) / cells};
    places[scanner.kind_in_pixel(place.x, place.y)].push_back(place);
  }
  return places;
}

void add_equal_parts(const std::vector<Vec2d>& places, double area, std::uint32_t region, std::vector<Node>& nodes) {
  for (const Vec2d& place : places) {
    nodes.push_back(
        {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(area / static_cast<double>(places.size())), region});
  }
}

// Gauss and Legendre's two places on each piece.
void add_along_pieces(const Scanner& scanner, const std::vector<Piece>& pieces, std::uint32_t region, std::vector<Node>& nodes) {
  const double away = std::sqrt(1.0 / 12);
  for (const Piece& p : pieces) {
    const double size = p.end - p.begin, middle = (p.begin + p.end) / 2;
    for (const double shift : {-away, away}) nodes.push_back(scanner.node(middle + shift * size, p.across, size * p.weight / 2, region));
  }
}

std::vector<std::uint32_t> kinks_of(const std::vector<Probe>& kinds, const Stage& stage) {
  std::vector<std::uint32_t> kinks;
  for (const StageLight& light : stage.lights()) {
    std::array<bool, 2> met{};
    for (const Probe& kind : kinds) {
      if (kind.point && !light.delta) met[side_of_plane(light, kind.point->position)] = true;
    }
    if (met[0] && met[1]) kinks.push_back(light.index);
  }
  return kinks;
}

// Places across the pixel where a scanline begins to meet other things: where edges leave through its sides, or meet.
std::vector<double> breaks_of(Scanner& scanner) {
  constexpr int looks = 4;
  constexpr double closest = 1e-4;
  std::vector<double> breaks{0};
  std::vector<std::size_t> before = scanner.kinds_along(0);
  for (int i = 1; i <= looks; ++i) {
    double low = (i - 1.0) / looks, high = static_cast<double>(i) / looks;
    std::vector<std::size_t> after = scanner.kinds_along(high);
    if (after != before) {
      while (high - low > closest) {
        const double middle = (low + high) / 2;
        (scanner.kinds_along(middle) == before ? low : high) = middle;
      }
      breaks.push_back((low + high) / 2);
    }
    before = std::move(after);
  }
  breaks.push_back(1);
  return breaks;
}

// Light that fades to nothing at an edge, in proportion to the distance h from it, is not served by areas alone: over pieces of the length
// h its integral is h^2 / 2, of which the midpoint rule of n scanlines loses 1 / (4 n^2) where h begins at 0 and all where only a corner of
// the pixel is lit, and one place a region misses its curvature (2 % of a pixel, 10 % of a corner, where a disk's plane met a floor).
// Between breaks h is linear along a straight edge, and three scanlines at Gauss and Legendre's places are exact to the fifth degree.
void add_kinked(Scanner& scanner, std::map<std::size_t, std::uint32_t>& numbers, Regions& regions) {
  static const double away = std::sqrt(0.15);
  const std::vector<double> breaks = breaks_of(scanner);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double width = breaks[i + 1] - breaks[i], middle = (breaks[i + 1] + breaks[i]) / 2;
    for (const double place : {-away, 0.0, away}) scanner.scan(middle + place * width, width * (place == 0 ? 8 : 5) / 18, pieces);
  }
  for (const Piece& p : pieces) {
    const auto [number, added] = numbers.try_emplace(p.kind, static_cast<std::uint32_t>(regions.kinds.size()));
    if (added) regions.kinds.push_back(p.surface);
    add_along_pieces(scanner, {p}, number->second, regions.kinked);
  }
}

}  // namespace

Regions regions_of(const Prober& prober, const Stage& stage, std::uint32_t x, std::uint32_t y, double tolerance, std::uint64_t seed,
                   RayCounts& counts) {
  Scanner scanner(prober, stage, x, y, runs_along_x(prober, x, y, counts), counts);
  std::vector<Piece> pieces;
  std::map<std::size_t, double> areas;
  Regions regions;
  int lines = first_lines;
  // The midpoint rule over scanlines: an edge that leaves through a side of the pixel costs O(1 / lines^2), so doubling divides by 4.
  for (;; lines *= 2) {
    pieces.clear();
    for (int i = 0; i < lines; ++i) scanner.scan((i + 0.5) / lines, 1.0 / lines, pieces);
    std::map<std::size_t, double> finer = areas_of(pieces);
    const double difference = largest_difference(areas, finer);
    areas = std::move(finer);
    regions.area_error = difference / 3;
    if ((lines > first_lines && difference < tolerance) || lines == most_lines) break;
  }
  Random random(seed);
  const bool any_textured = std::any_of(pieces.begin(), pieces.end(), [](const Piece& p) { return p.surface.textured; });
  std::map<std::size_t, std::vector<Vec2d>> places;
  if (any_textured) places = places_by_kind(scanner, random);
  std::map<std::size_t, std::uint32_t> numbers;
  for (const auto& [kind, area] : areas) {
    const std::uint32_t number = numbers[kind] = static_cast<std::uint32_t>(regions.kinds.size());
    std::vector<Piece> own;
    std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(own), [kind = kind](const Piece& p) { return p.kind == kind; });
    const bool textured = own.front().surface.textured && places[kind].size() > 1;
    const bool varies = std::any_of(own.begin(), own.end(), [](const Piece& p) { return p.surface.varies; });
    if (textured) {
      add_equal_parts(places[kind], area, number, regions.coarse);
      add_equal_parts(places[kind], area, number, regions.nodes);
    } else {
      if (varies) {
        add_stratified(scanner, own, area, number, random, regions.coarse);
      } else {
        add_centroid(scanner, own, area, number, regions.coarse);
      }
      add_along_pieces(scanner, own, number, regions.nodes);
    }
    regions.kinds.push_back({varies, textured});
    regions.only_lambert = regions.only_lambert && own.front().lambert;
  }
  for (const double side : {0.0, 1.0}) scanner.kinds_along(side);  // a corner between a side and the outermost scanline
  regions.kinks = kinks_of(scanner.kinds(), stage);
  if (!regions.kinks.empty() && !any_textured) add_kinked(scanner, numbers, regions);
  return regions;
}

}  // namespace etendue::rendering
