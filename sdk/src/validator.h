// What the parts of validate() share.
#pragma once

#include "etendue/scene.h"

#include <string>

namespace etendue {

// Checks of numbers, indices and transforms that put errors about one named thing of a scene into its diagnostics.
class Validator {
 public:
  Validator(const Scene& scene, Diagnostics& diagnostics) : scene_(scene), diagnostics_(diagnostics) {}

  // What the next checks are about: `light "key"`, and where it came from.
  void about(const char* kind, std::size_t index, const std::string& name, const std::string& source);

  void error(const char* code, const std::string& text);
  void warning(const char* code, const std::string& text);
  void append(const Error& error);

  // Each returns whether all is well.
  bool finite(const char* what, const Transform& transform);
  bool rigid(const Transform& transform);
  bool between(const char* what, double value, double low, double high);  // ends included
  bool above(const char* what, double value, double low);                 // low excluded, finite
  bool colour(const char* what, const Rgb& value, double high);           // each channel in [0, high]
  bool index(const char* what, std::uint32_t value, std::size_t count);
  bool texture(const char* what, const Texture& texture);

  const Scene& scene() const { return scene_; }

 private:
  Where where() const;
  const Scene& scene_;
  Diagnostics& diagnostics_;
  std::string subject_, source_;
};

void validate_light(Validator& check, const Light& light);

}  // namespace etendue
