#include "repairs.h"

#include <algorithm>
#include <iterator>

namespace etendue::gltf {
namespace {

struct Repair {
  const char* code;
  const char* what;
};

// The reading goes on as it says here: nothing depends on what was wrong, or it is put right where it is read.
constexpr Repair repairs[] = {
    {"ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "the bounds are those of the elements"},
    {"ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "the bounds are those of the elements"},
    {"ACCESSOR_MAX_MISMATCH", "the bounds are those of the elements"},
    {"ACCESSOR_MIN_MISMATCH", "the bounds are those of the elements"},
    {"ACCESSOR_OFFSET_ALIGNMENT", "components are read from where they are"},
    {"ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "components are read from where they are"},
    {"ACCESSOR_MATRIX_ALIGNMENT", "components are read from where they are"},
    {"ACCESSOR_VECTOR3_NON_UNIT", "made a unit vector"},
    {"ACCESSOR_WEIGHTS_NON_NORMALIZED", "scaled to sum to 1"},
    {"ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", "the bounds are those of the elements"},
    {"BUFFER_DATA_URI_MIME_TYPE_INVALID", "the bytes are what they are"},
    {"BUFFER_VIEW_TARGET_OVERRIDE", "the target is not used"},
    {"GLB_CHUNK_LENGTH_UNALIGNED", "the chunk is read from where it is"},
    {"MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "components are read from where they are"},
    {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "the bounds are those of the elements"},
    {"NON_REQUIRED_EXTENSION", "taken as required"},
    {"ROTATION_NON_UNIT", "made a unit quaternion"},
    {"UNDECLARED_EXTENSION", "taken as declared"},
    {"UNUSED_EXTENSION_REQUIRED", "nothing needs it"},
};

}  // namespace

const char* repair_of(const std::string& code) {
  const auto found = std::find_if(std::begin(repairs), std::end(repairs), [&](const Repair& repair) { return code == repair.code; });
  return found == std::end(repairs) ? nullptr : found->what;
}

}  // namespace etendue::gltf
