#include "limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::cli {
namespace {

constexpr std::uint64_t any = std::uint64_t{1} << 62;

struct Limit {
  std::string_view name;
  std::uint64_t most;
  void (*set)(ImportOptions&, std::uint64_t);
};
// The depth is one of calls within calls: its most is what a stack of a megabyte holds.
constexpr Limit limits[] = {
    {"max_bytes", any, [](ImportOptions& o, std::uint64_t n) { o.max_bytes = n; }},
    {"max_items", any, [](ImportOptions& o, std::uint64_t n) { o.max_items = static_cast<std::size_t>(n); }},
    {"max_depth", 1000, [](ImportOptions& o, std::uint64_t n) { o.max_depth = static_cast<int>(n); }},
    {"max_pixels", any, [](ImportOptions& o, std::uint64_t n) { o.max_pixels = n; }},
    {"max_decoded", any, [](ImportOptions& o, std::uint64_t n) { o.max_decoded = n; }},
    {"max_memory", any, [](ImportOptions& o, std::uint64_t n) { o.max_memory = n; }},
};

std::uint64_t factor_of(std::string_view suffix) {
  if (suffix.empty()) return 1;
  const std::size_t power = std::string_view("kMGT").find(suffix[0]);
  if (suffix.size() > 1 || power == std::string_view::npos) return 0;
  std::uint64_t factor = 1;
  for (std::size_t i = 0; i <= power; ++i) factor *= 1000;
  return factor;
}

// "" or what is wrong.
std::string set_limit(ImportOptions& options, std::string_view text) {
  const std::size_t sign = std::min(text.find('='), text.size());
  const auto* const limit =
      std::find_if(std::begin(limits), std::end(limits), [&](const Limit& l) { return l.name == text.substr(0, sign); });
  if (limit == std::end(limits) || sign == text.size())
    return fmt::format("expected NAME=NUMBER, NAME one of max_bytes, max_items, max_depth, max_pixels, max_decoded, max_memory, found '{}'",
                       text);
  const std::string_view value = text.substr(sign + 1);
  std::uint64_t number = 0;
  const auto [rest, fault] = std::from_chars(value.data(), value.data() + value.size(), number);
  const std::uint64_t factor = factor_of(value.substr(static_cast<std::size_t>(rest - value.data())));
  if (fault != std::errc() || factor == 0 || number > limit->most / factor)
    return fmt::format("expected a whole number up to {} after {}=, with k, M, G or T behind it for thousands, found '{}'", limit->most,
                       limit->name, value);
  limit->set(options, number * factor);
  return {};
}

}  // namespace

void add_limits(CLI::App& verb, ImportOptions& options) {
  const auto set_all = [&options](const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (const std::string fault = set_limit(options, text); !fault.empty()) throw CLI::ValidationError("--limit", fault);
  };
  verb.add_option_function<std::vector<std::string>>(
          "--limit", set_all,
          "What a file may ask for at most, as NAME=NUMBER: max_bytes, max_items, max_depth, max_pixels, max_decoded, max_memory")
      ->expected(1)
      ->take_all();
}

}  // namespace etendue::cli
