#include "meshopt.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "json_values.h"

#ifdef ETENDUE_MESHOPT
#include <meshoptimizer.h>
#endif

namespace etendue::gltf {

#ifdef ETENDUE_MESHOPT

namespace {

// The extension's rules, which the library takes for granted.
const char* fault_of(const std::string& mode, const std::string& filter, std::size_t stride, std::size_t count) {
  if (count < 1) return "expected a count of at least 1";
  if (mode == "ATTRIBUTES") {
    if (stride < 4 || stride > 256 || stride % 4 != 0) return "expected a byteStride of 4 to 256, a multiple of 4";
    if (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) return "expected a byteStride of 4 or 8 for OCTAHEDRAL";
    if (filter == "QUATERNION" && stride != 8) return "expected a byteStride of 8 for QUATERNION";
    const bool known = filter == "NONE" || filter == "OCTAHEDRAL" || filter == "QUATERNION" || filter == "EXPONENTIAL";
    return known ? nullptr : "expected the filter NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL";
  }
  if (mode != "TRIANGLES" && mode != "INDICES") return "expected the mode ATTRIBUTES, TRIANGLES or INDICES";
  if (stride != 2 && stride != 4) return "expected a byteStride of 2 or 4 for indices";
  if (filter != "NONE") return "expected no filter for indices";
  return mode == "TRIANGLES" && count % 3 != 0 ? "expected a multiple of 3 indices" : nullptr;
}

bool decode(const std::string& mode, const std::string& filter, std::size_t stride, std::size_t count, const SharedBytes& from,
            std::uint8_t* to) {
  if (mode == "TRIANGLES") return meshopt_decodeIndexBuffer(to, count, stride, from.data(), from.size()) == 0;
  if (mode == "INDICES") return meshopt_decodeIndexSequence(to, count, stride, from.data(), from.size()) == 0;
  if (meshopt_decodeVertexBuffer(to, count, stride, from.data(), from.size()) != 0) return false;
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to, count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(to, count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(to, count, stride);
  return true;
}

}  // namespace

bool meshopt_is_built() { return true; }

Result<SharedBytes> decode_meshopt(Asset& asset, const nlohmann::json& extension, const SharedBytes& source, const std::string& pointer) {
  const std::uint64_t authored_stride = uint_of(extension, "byteStride").value_or(0),
                      authored_count = uint_of(extension, "count").value_or(0);
  const std::string mode = text_or(extension, "mode", ""), filter = text_or(extension, "filter", "NONE");
  constexpr std::uint64_t most = UINT64_MAX / 2;
  const std::uint64_t bytes = authored_count > most / std::max<std::uint64_t>(authored_stride, 1) ? most : authored_stride * authored_count;
  if (auto room = asset.claim_decoded(bytes, pointer); !room) return room.error();
  const auto stride = static_cast<std::size_t>(authored_stride), count = static_cast<std::size_t>(authored_count);
  if (const char* fault = fault_of(mode, filter, stride, count)) return asset.failure("MESHOPT_INVALID", fault, pointer);
  std::vector<std::uint8_t> out(stride * count);
  if (!decode(mode, filter, stride, count, source, out.data()))
    return asset.failure("MESHOPT_INVALID", "the compressed bytes cannot be decoded", pointer);
  return SharedBytes(std::move(out));
}

#else

bool meshopt_is_built() { return false; }

Result<SharedBytes> decode_meshopt(Asset& asset, const nlohmann::json&, const SharedBytes&, const std::string& pointer) {
  return asset.failure("NOT_BUILT", "this build decodes no EXT_meshopt_compression: meshoptimizer was not there", pointer);
}

#endif

}  // namespace etendue::gltf
