// How layers stand in an OpenEXR file: a layer of three channels is "NAME.R" "NAME.G" "NAME.B" (R, G, B for the layer ""),
// a layer of one channel is "NAME".
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace etendue {

inline constexpr std::array<char, 3> channel_letters{'R', 'G', 'B'};

inline std::string channel_name(std::string_view layer, int channels, int channel) {
  std::string name(layer);
  if (channels == 1) return name;
  if (!name.empty()) name += '.';
  return name + channel_letters[static_cast<std::size_t>(channel)];
}

}  // namespace etendue
