#include "etendue/picture.h"

#include <algorithm>

namespace etendue {

Layer* Picture::find(std::string_view name) {
  const auto it = std::find_if(layers.begin(), layers.end(), [name](const Layer& l) { return l.name == name; });
  return it == layers.end() ? nullptr : &*it;
}

const Layer* Picture::find(std::string_view name) const {
  const auto it = std::find_if(layers.begin(), layers.end(), [name](const Layer& l) { return l.name == name; });
  return it == layers.end() ? nullptr : &*it;
}

Layer& Picture::add(std::string name, int channels) {
  const std::size_t count = static_cast<std::size_t>(width) * height * static_cast<std::size_t>(channels);
  layers.push_back({std::move(name), channels, std::vector<float>(count, 0.0f)});
  return layers.back();
}

std::string layer_safe(std::string_view name) {
  std::string safe(name);
  for (char& c : safe) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '.' || code < 0x20 || code == 0x7f) c = '_';
  }
  return safe;
}

}  // namespace etendue
