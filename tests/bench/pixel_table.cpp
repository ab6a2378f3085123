// Frostbite's table 14 made anew: what each packed format holds, measured. Prints the table of sdk/docs/pixel.md.
#include "pixel_limits.h"

#include <fmt/format.h>

int main() {
  using namespace etendue;
  fmt::print("| format | bits | largest | full precision from | smallest | stops: full, all | largest error | digits | steps a stop |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const PixelFormat& format : pixel_formats()) {
    const PixelLimits m = measured_limits(format);
    const auto steps = [&](int i) { return m.steps_a_stop[i] < 10000 ? fmt::format("{}", m.steps_a_stop[i]) : std::string("2^23"); };
    fmt::print("| {} | {} | {:.6g} | {} | {:.3g} | {}, {:.0f} | {:.3g} | {:.2f} | {}, {}, {}, {} |\n", format.name, format.bits, m.largest,
               format.floating ? fmt::format("{:.3g}", m.least_precise) : "never", m.smallest,
               format.floating ? fmt::format("{:.0f}", std::log2(m.largest / m.least_precise)) : "0", m.stops(), m.relative_error, m.digits,
               steps(0), steps(1), steps(2), steps(3));
  }
  fmt::print("\nR11G11B10F stores grey with blue up to {:.2f} % beside red.\n", 100 * largest_tint_of_r11g11b10f());
}
