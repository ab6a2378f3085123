// Quantities, colour, camera and pixel formats: time an element against a bare multiplication, and the peers' formulas with their errors.
#include "units_rows.h"

int main(int argc, char** argv) {
  etendue::bench::Bench bench;
  etendue::bench::exposure_rows(bench);
  etendue::bench::colour_rows(bench);
  etendue::bench::pixel_rows(bench);
  etendue::bench::text_rows(bench);
  return bench.run(argc, argv);
}
