// What a conversion stream is held to: reads "value,unit" lines, parses, multiplies, prints "value,unit," in the shortest digits; in
// blocks, in one thread, with nothing checked.
//   units_bare_loop FACTOR UNIT < in.csv > out.csv
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const double factor = std::atof(argv[1]);
  const std::string tail = std::string(",") + argv[2] + ",\n";
  constexpr std::size_t block = 1 << 20;
  std::vector<char> in(block + 4096), out(8 * (block + 4096));  // the shortest line, "1,lm\n", may become 32 characters
  std::size_t kept = 0;
  for (bool first = true;;) {
    const std::size_t got = std::fread(in.data() + kept, 1, block, stdin);
    const char* at = in.data();
    const char* const end = in.data() + kept + got;
    char* to = out.data();
    while (const auto* newline = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at)))) {
      if (first) {  // the header
        constexpr char header[] = "value,unit,error\n";
        std::memcpy(to, header, sizeof header - 1);
        to += sizeof header - 1;
        first = false;
      } else {
        double value = 0;
        std::from_chars(at, newline, value);
        to = std::to_chars(to, to + 32, value * factor).ptr;
        std::memcpy(to, tail.data(), tail.size());
        to += tail.size();
      }
      at = newline + 1;
    }
    std::fwrite(out.data(), 1, static_cast<std::size_t>(to - out.data()), stdout);
    if (got == 0) break;
    kept = static_cast<std::size_t>(end - at);
    std::memmove(in.data(), at, kept);
  }
}
