// The parts of check_data(), one a file: what a document's bytes say. What the checks of the document have reported is passed over.
#pragma once

#include "asset.h"
#include "elements.h"
#include "records.h"

#include <optional>
#include <set>
#include <string>
#include <tuple>

namespace etendue::gltf {

struct DataChecks {
  explicit DataChecks(Asset& opened) : asset(opened), records(opened.json()) {}

  // None where there is nothing to look at: no bytes, faults that are reported, or more work than the limits allow.
  std::optional<Elements> elements(std::int64_t accessor);
  void check_sparse_indices(std::int64_t accessor);
  // Whether an accessor has not been looked at in this way before.
  bool is_new(const char* check, std::int64_t accessor, std::uint64_t detail = 0) { return done_.emplace(check, accessor, detail).second; }

  Asset& asset;
  Records records;
  std::uint64_t budget = 0;  // bytes that may still be looked at

 private:
  std::optional<Elements> patched(const Json& source, const Accessor& accessor, std::optional<Elements> base);
  std::optional<Elements> placed(std::int64_t view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride, const Format& format);
  std::set<std::tuple<std::string, std::int64_t, std::uint64_t>> done_;
};

void check_buffer_files(DataChecks& checks);
void check_pictures(DataChecks& checks);
void check_values(DataChecks& checks);      // bounds, floats, sparse indices
void check_vertices(DataChecks& checks);    // indices, normals, tangents, colours
void check_influences(DataChecks& checks);  // joints and weights
void check_motion(DataChecks& checks);      // times, rotations, inverse bind matrices

}  // namespace etendue::gltf
