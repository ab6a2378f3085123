// Suggestions for a misspelt word.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

// Number of insertions, deletions and replacements of bytes that make one text of the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b);

struct Candidate {
  std::string text;     // what is compared
  std::string suggest;  // what is told
};
// The at most `count` nearest suggestions, nearest first, each once; candidates that share less than half of the word stay out
// unless there is nothing else.
std::vector<std::string> nearest_candidates(std::string_view word, const std::vector<Candidate>& candidates, std::size_t count);

}  // namespace etendue
