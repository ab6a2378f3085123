// Any bytes as EULUMDAT.
#include "exporters/eulumdat/eulumdat.h"
#include "importers/eulumdat/eulumdat.h"
#include "photometric_round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  etendue::fuzz::round_trip(data, size, &etendue::read_eulumdat, &etendue::write_eulumdat);
  return 0;
}
