// Colour steps of pictures, through OpenColorIO in float: between the spaces of a configuration, to a display, or baked into one table.
//   ColourConfig config = *ColourConfig::built_in();
//   ColourStep step = *config.view({.exposure = exposure_of_ev100(12, frostbite), .display = "sRGB", .view = "Standard"});
//   step.apply(pixels);
// Lights' colours do not come through here: quantities use the double matrices of colour_space.h, to which the built-in configuration's are
// held.
#pragma once

#include "etendue/colour_space.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

// Something done to pixels. May be used from several threads.
class ColourStep {
 public:
  void apply(std::span<Vec3f> pixels) const;  // in place

  // For other programs; the ending chooses: ".clf" (Academy/ASC), ".ctf" (Autodesk). COLOUR_STEP_UNWRITABLE.
  Status write(const std::filesystem::path& file) const;

 private:
  friend class ColourConfig;
  struct Implementation;
  explicit ColourStep(std::shared_ptr<const Implementation> made) : made_(std::move(made)) {}
  std::shared_ptr<const Implementation> made_;
};

// Exposure, white balance, view: from scene-linear cd/m2 to what is sent to a display.
struct ViewSettings {
  std::string from = "linear Rec.709";
  double exposure = 1;                                     // what cd/m2 are multiplied by: exposure_of_ev100, exposure_of
  Matrix3 white_balance{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // of `from`'s RGB: white_balance() of colour_space.h
  std::string display, view;
};
// A table's domain and size. Between lattice points it is interpolated in tetrahedra over s = (log2(x + 2^least) - least) / (greatest -
// least), x the exposed value: 0 has s = 0, and what is outside counts as the ends.
struct TableSettings {
  double least_stop = -10, greatest_stop = 10;
  int grid = 65;  // 3 to 129 points a side
};

// Colour spaces, displays and views by name. Errors of its functions: COLOUR_NAME_UNKNOWN, with the nearest; COLOUR_CONFIG_INVALID with
// what OpenColorIO says; VIEW_INVALID unless exposure and white balance are finite; TABLE_INVALID.
class ColourConfig {
 public:
  // "linear Rec.709", "sRGB texture", "ACEScg", "ACES2065-1", "linear Rec.2020", "linear P3", "raw"; displays "sRGB", "Display P3",
  // "Rec.709" (gamma 2.4), each with the views "Standard" (no tone curve: what is beyond 1 stays so) and "Raw". Whites are adapted by
  // Bradford.
  static Result<ColourConfig> built_in();
  static Result<ColourConfig> from_file(const std::filesystem::path& file);
  // The file that $OCIO names, or the built-in one where it is not set: for programs whose user asks for it.
  static Result<ColourConfig> from_environment();

  std::vector<std::string> spaces() const;
  std::vector<std::string> displays() const;
  std::vector<std::string> views(const std::string& display) const;

  Result<ColourStep> conversion(const std::string& from, const std::string& to) const;
  // To the built-in configuration's "linear Rec.709", by way of ACES2065-1: a configuration from a file has to have the role
  // aces_interchange, else COLOUR_CONFIG_INVALID.
  Result<ColourStep> to_linear_rec709(const std::string& from) const;
  Result<ColourStep> view(const ViewSettings& settings) const;
  // The same as a matrix (exposure, white balance), a shaper and one table, whose input is cd/m2. What the matrix leaves negative counts as
  // 0. In the built-in views of linear Rec.709 it is within .0015 of the range from display black to white with 65 points a side, .006
  // with 33. A view with a steeper curve costs more, and so does a gamut that the table makes smaller.
  Result<ColourStep> baked(const ViewSettings& settings, const TableSettings& table) const;

 private:
  struct Implementation;
  explicit ColourConfig(std::shared_ptr<const Implementation> made) : made_(std::move(made)) {}
  std::shared_ptr<const Implementation> made_;
};

}  // namespace etendue
