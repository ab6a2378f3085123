// Animations: what samplers store, what channels move, and that no two move the same.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "checks.h"

namespace etendue::gltf {
namespace {

constexpr int i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, f32 = 5126;

// By the path of a channel; none for paths whose format depends on more.
const std::vector<Format>* output_formats(const std::string& path) {
  static const std::map<std::string, std::vector<Format>> table = {
      {"translation", {{Shape::vec3, f32}}},
      {"rotation",
       {{Shape::vec4, f32}, {Shape::vec4, i8, true}, {Shape::vec4, u8, true}, {Shape::vec4, i16, true}, {Shape::vec4, u16, true}}},
      {"scale", {{Shape::vec3, f32}}},
      {"weights",
       {{Shape::scalar, f32},
        {Shape::scalar, i8, true},
        {Shape::scalar, u8, true},
        {Shape::scalar, i16, true},
        {Shape::scalar, u16, true}}},
  };
  const auto found = table.find(path);
  return found == table.end() ? nullptr : &found->second;
}

class AnimationCheck {
 public:
  AnimationCheck(Checks& checks, const Json& animation, const Path& path)
      : checks_(checks),
        findings_(checks.findings),
        samplers_(array_at(animation, "samplers")),
        channels_(array_at(animation, "channels")),
        path_(path),
        used_(samplers_.size(), false) {}

  void run() {
    if (samplers_.empty() || channels_.empty()) return;
    const Path samplers = path_ / "samplers", channels = path_ / "channels";
    for (std::size_t i = 0; i < samplers_.size(); ++i) check_sampler(samplers_[i], samplers / i);
    for (std::size_t i = 0; i < channels_.size(); ++i) check_channel(i, channels_[i], channels / i);
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (!used_[i]) findings_.note("UNUSED_OBJECT", "no channel refers to this sampler", samplers / i);
  }

 private:
  static bool is_cubic(const Json& sampler) {
    const std::string* interpolation = text_of(sampler, "interpolation");
    return interpolation != nullptr && *interpolation == "CUBICSPLINE";
  }

  void use(std::int64_t index, Usage usage, const Path& path) {
    const Accessor* accessor = checks_.records.accessor(index);
    if (accessor == nullptr) return;
    use_accessor(checks_, index, usage, path);
    use_view(checks_, accessor->view, Usage::other, path);
    if (const View* view = checks_.records.view(accessor->view); view != nullptr && view->stride != 0)
      findings_.error("ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE", "animations lie in views without byteStride", path);
  }

  void check_sampler(const Json& sampler, const Path& path) {
    const Path input_path = path / "input";
    const std::int64_t input = index_of(sampler, "input");
    use(input, Usage::animation_input, input_path);
    use(index_of(sampler, "output"), Usage::animation_output, path / "output");
    const Accessor* times = checks_.records.accessor(input);
    if (times == nullptr) return;
    const Format expected{Shape::scalar, f32};
    if (times->format != expected)
      findings_.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", format_expected(times->format, {expected}), input_path);
    if (!times->has_bounds)
      findings_.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", fmt::format("expected min and max of accessor {}", input),
                      input_path);
    if (is_cubic(sampler) && times->count < 2)
      findings_.error("ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS", fmt::format("a spline needs 2 times, found {}", times->count),
                      input_path);
  }

  const Json* node_at(std::int64_t index) const {
    const Json& nodes = array_at(checks_.root, "nodes");
    return index >= 0 && static_cast<std::size_t>(index) < nodes.size() ? &nodes[static_cast<std::size_t>(index)] : nullptr;
  }

  std::size_t targets_of(const Json& node) const {
    const Json& meshes = array_at(checks_.root, "meshes");
    const std::int64_t mesh = index_of(node, "mesh");
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= meshes.size()) return 0;
    const Json& primitives = array_at(meshes[static_cast<std::size_t>(mesh)], "primitives");
    return primitives.empty() ? 0 : array_at(primitives[0], "targets").size();
  }

  void check_channel(std::size_t index, const Json& channel, const Path& path) {
    const Json& target = object_at(channel, "target");
    const Path target_path = path / "target", sampler_path = path / "sampler";
    const std::int64_t node = index_of(target, "node");
    const std::string* animated = text_of(target, "path");
    const std::string what = animated != nullptr ? *animated : "";
    if (const Json* found = node_at(node)) check_target(*found, what, target_path);
    check_pointer(target, what, target_path);
    if (node >= 0 && animated != nullptr) {
      const auto [other, is_new] = known_.emplace(std::pair(node, what), index);
      if (!is_new)
        findings_.error("ANIMATION_DUPLICATE_TARGETS", fmt::format("channel {} animates {} of node {} already", other->second, what, node),
                        target_path);
    }
    const std::int64_t sampler = index_of(channel, "sampler");
    if (sampler < 0) return;
    if (static_cast<std::size_t>(sampler) >= samplers_.size())
      return findings_.error("UNRESOLVED_REFERENCE",
                             fmt::format("expected an index into samplers, which has {} elements, found {}", samplers_.size(), sampler),
                             sampler_path);
    used_[static_cast<std::size_t>(sampler)] = true;
    if (!target.empty()) check_output(samplers_[static_cast<std::size_t>(sampler)], node_at(node), what, sampler_path);
  }

  void check_target(const Json& node, const std::string& what, const Path& path) {
    if (what == "translation" || what == "rotation" || what == "scale") {
      if (node.contains("matrix"))
        findings_.error("ANIMATION_CHANNEL_TARGET_NODE_MATRIX", fmt::format("a node with a matrix has no {} to animate", what), path);
      if (index_of(node, "skin") >= 0)
        findings_.warning("ANIMATION_CHANNEL_TARGET_NODE_SKIN", "its transform does not move a skinned mesh", path / "path");
    } else if (what == "weights" && targets_of(node) == 0) {
      findings_.error("ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "the node's mesh has nothing to morph", path);
    }
  }

  // KHR_animation_pointer.
  void check_pointer(const Json& target, const std::string& what, const Path& path) {
    const Path extensions = path / "extensions", here = extensions / "KHR_animation_pointer";
    if (!object_at(target, "extensions").contains("KHR_animation_pointer") || !checks_.declares("KHR_animation_pointer")) return;
    if (target.contains("node"))
      findings_.error("KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE", "expected no node beside a pointer", here);
    if (what != "pointer")
      findings_.error("KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH",
                      fmt::format("expected the path \"pointer\", found \"{}\"", what), here);
  }

  void check_output(const Json& sampler, const Json* node, const std::string& what, const Path& path) {
    const Accessor* values = checks_.records.accessor(index_of(sampler, "output"));
    const Accessor* times = checks_.records.accessor(index_of(sampler, "input"));
    const auto* formats = output_formats(what);
    if (values == nullptr || formats == nullptr) return;
    if (std::find(formats->begin(), formats->end(), values->format) == formats->end())
      findings_.error("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", format_expected(values->format, *formats), path);
    if (times == nullptr || times->count == 0 || values->count == 0) return;
    std::uint64_t expected = times->count * (is_cubic(sampler) ? 3 : 1);
    if (what == "weights") expected *= node != nullptr ? targets_of(*node) : 0;
    if (expected != 0 && expected != values->count)
      findings_.error("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
                      fmt::format("expected {} values, found {}", expected, values->count), path);
  }

  Checks& checks_;
  Findings& findings_;
  const Json &samplers_, &channels_;
  const Path& path_;
  std::vector<bool> used_;
  std::map<std::pair<std::int64_t, std::string>, std::size_t> known_;
};

}  // namespace

void check_animations(Checks& checks) {
  const Path root, path = root / "animations";
  const Json& animations = array_at(checks.root, "animations");
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const Path animation = path / i;
    AnimationCheck(checks, animations[i], animation).run();
  }
}

}  // namespace etendue::gltf
