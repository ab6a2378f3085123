// Any bytes as an OpenEXR picture.
#include "etendue/picture.h"
#include "temporary_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const etendue::fuzz::TemporaryFile input("input.exr");
  const etendue::Result<etendue::Picture> picture = etendue::read_exr(input.holding(data, size));
  if (!picture) return 0;
  for (const etendue::Layer& layer : picture->layers)
    if (layer.pixels.size() != std::size_t{picture->width} * picture->height * static_cast<std::size_t>(layer.channels)) std::abort();
  return 0;
}
