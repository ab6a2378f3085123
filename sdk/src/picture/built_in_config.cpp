#include "built_in_config.h"

#include "etendue/colour_space.h"

namespace etendue {
namespace {

namespace ocio = OCIO_NAMESPACE;

// OpenColorIO's matrices are 4x4, row by row.
ocio::MatrixTransformRcPtr matrix(const Matrix3& m) {
  const Matrix3 rows = transposed(m);
  const double values[16] = {rows.a.x, rows.a.y, rows.a.z, 0, rows.b.x, rows.b.y, rows.b.z, 0, rows.c.x, rows.c.y, rows.c.z, 0, 0, 0, 0, 1};
  ocio::MatrixTransformRcPtr made = ocio::MatrixTransform::Create();
  made->setMatrix(values);
  return made;
}

constexpr ColourSpace aces2065_1{"aces2065-1",     {0.7347, 0.2653},   {0, 1},
                                 {0.0001, -0.077}, {0.32168, 0.33767}, "SMPTE ST 2065-1, AP0: what configurations exchange colours in"};

// Between the reference, linear Rec.709, and a space: Bradford where the whites differ, a known matrix, hence no error.
ocio::MatrixTransformRcPtr to_reference(const ColourSpace& space) {
  return matrix(*conversion(space, rec709, ChromaticAdaptation::bradford));
}

// sRGB's curve as OpenColorIO has it: gamma and offset are the standard's, the straight part is made to meet the power smoothly, which
// differs from the standard's rounded slope of 12.92 by 2.5e-4 of values that are below .04.
ocio::TransformRcPtr srgb_curve() {
  ocio::ExponentWithLinearTransformRcPtr made = ocio::ExponentWithLinearTransform::Create();
  made->setGamma({2.4, 2.4, 2.4, 1});
  made->setOffset({0.055, 0.055, 0.055, 0});
  return made;
}
ocio::TransformRcPtr gamma_2_4() {
  ocio::ExponentTransformRcPtr made = ocio::ExponentTransform::Create();
  made->setValue({2.4, 2.4, 2.4, 1});
  made->setNegativeStyle(ocio::NEGATIVE_MIRROR);
  return made;
}

void add(const ocio::ConfigRcPtr& config, const char* name, const char* encoding, bool is_data,
         std::initializer_list<ocio::TransformRcPtr> steps) {
  ocio::ColorSpaceRcPtr space = ocio::ColorSpace::Create();
  space->setName(name);
  space->setEncoding(encoding);
  space->setBitDepth(ocio::BIT_DEPTH_F32);
  space->setIsData(is_data);
  if (steps.size() > 0) {
    ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
    for (const ocio::TransformRcPtr& step : steps) group->appendTransform(step);
    space->setTransform(group, ocio::COLORSPACE_DIR_TO_REFERENCE);
  }
  config->addColorSpace(space);
}

}  // namespace

ocio::ConfigRcPtr built_in_config() {
  ocio::ConfigRcPtr config = ocio::Config::CreateRaw()->createEditableCopy();
  config->setVersion(2, 0);
  config->setDescription("Etendue's own: linear spaces by their primaries, three displays without a tone curve.");
  config->clearColorSpaces();
  config->clearDisplays();
  add(config, "linear Rec.709", "scene-linear", false, {});
  add(config, "sRGB texture", "sdr-video", false, {srgb_curve()});
  add(config, "ACEScg", "scene-linear", false, {to_reference(acescg)});
  add(config, "ACES2065-1", "scene-linear", false, {to_reference(aces2065_1)});
  add(config, "linear Rec.2020", "scene-linear", false, {to_reference(rec2020)});
  add(config, "linear P3", "scene-linear", false, {to_reference(p3_d65)});
  add(config, "raw", "data", true, {});
  add(config, "Display P3", "sdr-video", false, {srgb_curve(), to_reference(p3_d65)});
  add(config, "Rec.709 display", "sdr-video", false, {gamma_2_4()});
  for (const auto& [display, space] : {std::pair{"sRGB", "sRGB texture"}, {"Display P3", "Display P3"}, {"Rec.709", "Rec.709 display"}}) {
    config->addDisplayView(display, "Standard", space, "");
    config->addDisplayView(display, "Raw", "raw", "");
  }
  config->setRole(ocio::ROLE_REFERENCE, "linear Rec.709");
  config->setRole("aces_interchange", "ACES2065-1");
  config->setRole(ocio::ROLE_SCENE_LINEAR, "linear Rec.709");
  config->setRole(ocio::ROLE_RENDERING, "linear Rec.709");
  config->setRole(ocio::ROLE_DATA, "raw");
  config->setRole(ocio::ROLE_DEFAULT, "raw");
  config->validate();
  return config;
}

}  // namespace etendue
