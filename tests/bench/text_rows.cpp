// Quantities as text: the anchor is what the C++ library takes for the number alone.
#include "units_rows.h"

#include "etendue/quantity_text.h"
#include "etendue/units.h"

#include <array>
#include <charconv>

namespace etendue::bench {
namespace {

constexpr std::array<std::string_view, 8> quantities = {"1200 lm", "15 klx", "60 cm", "2.8 m", "3000 K", "806 lm", "16.25 knit", "-3 EV"};

template <class Read>
void each(const Read& read) {
  double sum = 0;
  for (const std::string_view text : quantities) sum += read(text);
  keep(&sum);
}

}  // namespace

void text_rows(Bench& bench) {
  Task& task = bench.task("a quantity from text", quantities.size());
  task.contender("std::from_chars, the number alone", Kind::anchor, "", [] {
    each([](std::string_view text) {
      double number = 0;
      std::from_chars(text.data(), text.data() + text.size(), number);
      return number;
    });
  });
  task.contender("etendue parse_quantity()", Kind::ours, "0", [] { each([](std::string_view text) { return parse_quantity(text)->si; }); });
  task.contender("etendue parse(), cameras and colours too", Kind::ours, "0",
                 [] { each([](std::string_view text) { return std::get<WrittenQuantity>(*parse(text)).quantity().si; }); });
}

}  // namespace etendue::bench
