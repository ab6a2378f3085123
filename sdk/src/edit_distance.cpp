#include "edit_distance.h"

#include <algorithm>
#include <numeric>

namespace etendue {

// One row of the dynamic programme at a time: row[j] is the distance of a[0, i) and b[0, j).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::vector<std::string> nearest_candidates(std::string_view word, const std::vector<Candidate>& candidates, std::size_t count) {
  constexpr std::size_t longest_compared = 64;  // bounds the work on hostile input
  word = word.substr(0, longest_compared);
  struct Ranked {
    std::size_t distance;
    const Candidate* candidate;
  };
  std::vector<Ranked> ranked;
  ranked.reserve(candidates.size());
  for (const Candidate& c : candidates) ranked.push_back({edit_distance(word, c.text), &c});
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.distance < b.distance; });
  std::vector<std::string> nearest;
  for (const Ranked& r : ranked) {
    if (nearest.size() == count || (!nearest.empty() && 2 * r.distance > word.size())) break;
    if (std::find(nearest.begin(), nearest.end(), r.candidate->suggest) == nearest.end()) nearest.push_back(r.candidate->suggest);
  }
  return nearest;
}

}  // namespace etendue
