#include "etendue/picture_light.h"

#include "quadratic_nodes.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

constexpr std::uint32_t side = 1U << PictureMoments::finest;

// Where the joined picture bends along an axis, and where cells end: between two such places it is linear and in one cell.
std::vector<double> breaks(std::uint32_t texels) {
  std::vector<double> at;
  at.reserve(std::size_t{texels} + side + 1);
  for (std::uint32_t k = 0; k < texels; ++k) at.push_back((k + 0.5) / texels);
  for (std::uint32_t j = 0; j <= side; ++j) at.push_back(static_cast<double>(j) / side);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  return at;
}

// A piece between two breaks: its cell, its share of that, and the cell's three polynomials at Gauss and Legendre's two places in it.
// Linear times quadratic is what two places integrate exactly, and so is a square of the linear.
struct Piece {
  std::uint32_t cell;
  double share;
  std::array<std::array<double, 3>, 2> polynomials;
};
constexpr double near_place = 0.21132486540518713;  // (1 - 1 / sqrt 3) / 2, from either end
std::vector<Piece> pieces_of(const std::vector<double>& at) {
  std::vector<Piece> pieces;
  pieces.reserve(at.size() - 1);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double length = at[i + 1] - at[i];
    const auto cell = std::min(static_cast<std::uint32_t>((at[i] + 0.5 * length) * side), side - 1);
    const auto polynomials = [&](double t) { return quadratics(2 * ((at[i] + t * length) * side - cell) - 1); };
    pieces.push_back({cell, length * side, {polynomials(near_place), polynomials(1 - near_place)}});
  }
  return pieces;
}

using Values = std::array<Rgb, 2>;  // at the two places of a strip across v
struct Sums {
  std::array<Rgb, 9> weights;
  Rgb squares;
};

// A level's cells in doubles, made into the next coarser one's: a polynomial of a cell is on its quarter the sum of the quarter's own, each
// times what it is at that node.
std::vector<Sums> coarser(const std::vector<Sums>& fine, std::uint32_t fine_side) {
  std::array<std::array<std::array<double, 3>, 3>, 2> at{};  // [half][child's node][parent's polynomial]
  for (std::size_t half = 0; half < 2; ++half)
    for (std::size_t j = 0; j < 3; ++j) at[half][j] = quadratics(0.5 * (quadratic_nodes[j] + (half == 0 ? -1 : 1)));
  std::vector<Sums> out(fine.size() / 4);
  for (std::uint32_t y = 0; y < fine_side; ++y) {
    for (std::uint32_t x = 0; x < fine_side; ++x) {
      const Sums& from = fine[std::size_t{y} * fine_side + x];
      Sums& to = out[std::size_t{y / 2} * (fine_side / 2) + x / 2];
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) {
          const Rgb quarter = from.weights[3 * k + j] * 0.25;
          for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t a = 0; a < 3; ++a) to.weights[3 * b + a] += quarter * (at[x % 2][j][a] * at[y % 2][k][b]);
        }
      }
      to.squares += from.squares * 0.25;
    }
  }
  return out;
}

PictureMoments::Cell rounded(const Sums& sums) {
  PictureMoments::Cell cell;
  Rgb mean;
  for (std::size_t k = 0; k < 9; ++k) {
    mean += sums.weights[k];
    cell.weights[k] = vec_cast<float>(sums.weights[k]);
  }
  for (int c = 0; c < 3; ++c) cell.deviation[c] = static_cast<float>(std::sqrt(std::max(sums.squares[c] - mean[c] * mean[c], 0.0)));
  return cell;
}

}  // namespace

PictureMoments::PictureMoments(const Pattern& pattern, std::uint32_t width, std::uint32_t height) {
  const std::vector<double> us = breaks(std::max(width, 1U)), vs = breaks(std::max(height, 1U));
  const std::vector<Piece> across = pieces_of(us), down = pieces_of(vs);
  std::vector<Sums> cells(std::size_t{side} * side);
  std::vector<Rgb> above(us.size()), below(us.size());
  const auto row = [&](double v, std::vector<Rgb>& values) {
    for (std::size_t i = 0; i < us.size(); ++i) values[i] = pattern({us[i], v});
  };
  row(vs[0], above);
  for (std::size_t j = 0; j < down.size(); ++j) {
    row(vs[j + 1], below);
    const Piece& strip = down[j];
    const auto in_strip = [&](std::size_t i) {
      const Rgb step = below[i] - above[i];
      return Values{above[i] + step * near_place, below[i] - step * near_place};
    };
    Values left = in_strip(0);
    for (std::size_t i = 0; i < across.size(); ++i) {
      const Piece& piece = across[i];
      const Values right = in_strip(i + 1);
      Sums& cell = cells[std::size_t{strip.cell} * side + piece.cell];
      const double share = 0.25 * strip.share * piece.share;
      for (std::size_t g = 0; g < 2; ++g) {
        const Rgb step = right[g] - left[g];
        const std::array<Rgb, 2> at{left[g] + step * near_place, right[g] - step * near_place};
        for (std::size_t a = 0; a < 3; ++a) {
          const Rgb part = (at[0] * piece.polynomials[0][a] + at[1] * piece.polynomials[1][a]) * share;
          for (std::size_t b = 0; b < 3; ++b) cell.weights[3 * b + a] += part * strip.polynomials[g][b];
        }
        cell.squares += (at[0] * at[0] + at[1] * at[1]) * share;
      }
      left = right;
    }
    std::swap(above, below);
  }
  levels_.resize(finest + 1);
  for (int level = finest; level >= 0; --level) {
    auto& kept = levels_[static_cast<std::size_t>(level)];
    kept.reserve(cells.size());
    for (const Sums& sums : cells) kept.push_back(rounded(sums));
    if (level > 0) cells = coarser(cells, 1U << level);
  }
}

Rgb PictureMoments::mean() const {
  Rgb sum;
  for (const Vec3f& weight : levels_[0][0].weights) sum += vec_cast<double>(weight);
  return sum;
}

}  // namespace etendue::eval
