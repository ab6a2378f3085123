// Any bytes as IES LM-63.
#include "exporters/ies/ies.h"
#include "importers/ies/ies.h"
#include "photometric_round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  etendue::fuzz::round_trip(data, size, &etendue::read_ies, &etendue::write_ies);
  return 0;
}
