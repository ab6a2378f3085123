#include "etendue/layered_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string_view>
#include <thread>
#include <utility>

#include "code_table.h"
#include "etendue/material_fit.h"
#include "etendue/material_parameters.h"
#include "etendue/normal_filter.h"
#include "etendue/unshown.h"
#include "layer_lookup.h"
#include "png_rows.h"

namespace etendue {
namespace {

constexpr int most_samples = 8;
constexpr std::uint32_t band_rows = 64;
// f0 of a dielectric of that index is .16, the largest that reflectance reaches.
constexpr double baked_ior = 7.0 / 3;
constexpr double same_reflectance = 1e-9;

Error invalid(std::string text) { return {"LAYERS_INVALID", std::move(text), {}, {}, {}}; }

double reflectance_factor(const SurfaceModel& model) { return standard_of(model).reflectance; }
// Whether the reflectance of a dielectric is the same at every texel: the model's own number.
bool has_one_reflectance(const SurfaceModel& model) {
  return !std::holds_alternative<SpecularGlossiness>(model) && !std::holds_alternative<Conductor>(model);
}

// What the baked textures are to have.
struct Plan {
  bool normal = false, specular = false, emissive = false;
  double reflectance = 0.5;  // of all, unless `specular`
  double emission = 0;       // of the brightest channel and layer
};
Plan plan_of(const LayeredMaterial& material, const LayerPictures& pictures) {
  Plan plan;
  plan.reflectance = reflectance_factor(material.layers[0].material.model);
  for (const MaterialLayer& layer : material.layers) {
    const Material& m = layer.material;
    plan.normal = plan.normal || m.normal_map.has_value();
    plan.specular = plan.specular || material.blend == LayerBlend::colours || !has_one_reflectance(m.model) ||
                    std::abs(reflectance_factor(m.model) - plan.reflectance) > same_reflectance;
    const Rgb emission = m.emissive * pictures.brightest(m.emissive_texture);
    plan.emission = std::max({plan.emission, emission.x, emission.y, emission.z});
  }
  plan.emissive = plan.emission > 0;
  return plan;
}

// A picture in the making, beside its place until it is whole.
struct Output {
  std::filesystem::path file;
  PngRows png;
  CodeTable codes;
  std::vector<std::uint16_t> rows;

  std::filesystem::path part() const { return file.string() + ".part"; }
  void put(std::size_t texel, const Vec3d& value) {
    for (int c = 0; c < 3; ++c) rows[3 * texel + static_cast<std::size_t>(c)] = codes.nearest(value[c]);
  }
};

class Baker {
 public:
  Baker(const LayeredMaterial& material, const BakeOptions& options, const LayerPictures& pictures)
      : material_(material), options_(options), pictures_(pictures), plan_(plan_of(material, pictures)), samples_(samples()) {}

  Result<BakedMaterial> bake() {
    Status done = open();
    if (done) done = write();
    if (!done) {
      for (const Output& output : outputs_) {
        std::error_code ignored;
        std::filesystem::remove(output.part(), ignored);
      }
      return done.error();
    }
    return result();
  }

 private:
  // As many as the finest texture has texels along a side of a baked one.
  int samples() const {
    double rate = 1;
    const auto look = [&](const Texture& texture, double scale) {
      const DecodedImage& image = pictures_.of(texture);
      const auto& m = texture.uv_transform;
      for (int axis = 0; axis < 2; ++axis) {
        const double texels = std::hypot(m[0][axis] * image.width, m[1][axis] * image.height) * std::abs(scale);
        rate = std::max(rate, texels / (axis == 0 ? options_.width : options_.height));
      }
    };
    for (const MaterialLayer& layer : material_.layers) {
      const auto own = [&](const std::optional<Texture>& texture) {
        if (texture) look(*texture, layer.uv_scale);
      };
      own(layer.material.base_colour_texture), own(layer.material.metal_rough_texture), own(layer.material.specular_gloss_texture);
      own(layer.material.emissive_texture);
      if (layer.material.normal_map) look(layer.material.normal_map->texture, layer.uv_scale);
      if (layer.material.occlusion) look(layer.material.occlusion->texture, layer.uv_scale);
      if (layer.mask) look(*layer.mask, 1);
    }
    return static_cast<int>(std::clamp(std::ceil(rate - 1e-9), 1.0, static_cast<double>(most_samples)));
  }

  Status open() {
    const auto add = [&](bool wanted, const char* name, bool srgb) -> Status {
      if (!wanted) return Done{};
      const std::filesystem::path file = options_.folder / name;
      Result<PngRows> png = PngRows::open(file.string() + ".part", options_.width, options_.height, 3, options_.bits);
      if (!png) return png.error();
      outputs_.push_back(
          {file, std::move(*png), CodeTable(options_.bits, srgb), std::vector<std::uint16_t>(std::size_t{3} * options_.width * band_rows)});
      return Done{};
    };
    Status done = add(true, "base_colour.png", true);
    if (done) done = add(true, "surface.png", false);
    if (done) done = add(plan_.normal, "normal.png", false);
    if (done) done = add(plan_.specular, "specular.png", true);
    if (done) done = add(plan_.emissive, "emissive.png", true);
    return done;
  }

  // What one thread works with.
  struct Desk {
    explicit Desk(std::size_t layers) : values(layers), masks(layers) {}
    std::vector<LayerValue> values;
    std::vector<double> masks;
    SurfaceFits fits;
  };

  LayerValue value_at(Vec2d uv, Desk& desk) const {
    for (std::size_t i = 0; i < material_.layers.size(); ++i) {
      const MaterialLayer& layer = material_.layers[i];
      desk.masks[i] = layer.opacity * pictures_.at(layer.mask, uv).r;
      if (i == 0 || desk.masks[i] > 0)
        desk.values[i] = layer_value(layer.material, pictures_, {uv.x * layer.uv_scale, uv.y * layer.uv_scale}, desk.fits);
    }
    return blended(desk.values, desk.masks, material_.normals, material_.blend);
  }

  // Roughness as filter_normals() has it: the root of the mean alpha^2, widened by what the mean normal lacks of 1.
  LayerValue texel(std::uint32_t x, std::uint32_t y, Desk& desk) const {
    const auto at = [&](int i, int j) {
      return value_at({(x + (i + 0.5) / samples_) / options_.width, (y + (j + 0.5) / samples_) / options_.height}, desk);
    };
    if (samples_ == 1) return at(0, 0);
    LayerValue mean;
    mean.surface = {{0, 0, 0}, 0, 0, 0};
    mean.normal = {0, 0, 0};
    mean.occlusion = 0;
    const double share = 1.0 / (samples_ * samples_);
    for (int j = 0; j < samples_; ++j) {
      for (int i = 0; i < samples_; ++i) {
        const LayerValue one = at(i, j);
        const double r2 = one.surface.roughness * one.surface.roughness;
        mean.surface.base_colour += one.surface.base_colour * share;
        mean.surface.metal += one.surface.metal * share;
        mean.surface.reflectance += one.surface.reflectance * share;
        mean.surface.roughness += r2 * r2 * share;
        mean.normal += one.normal * share;
        mean.occlusion += one.occlusion * share;
        mean.emissive += one.emissive * share;
      }
    }
    const double norm = std::min(length(mean.normal), 1.0);
    mean.surface.roughness = std::sqrt(filtered_lobe(std::sqrt(mean.surface.roughness), norm).alpha);
    mean.normal = norm > 0 ? mean.normal / norm : Vec3d{0, 0, 1};
    return mean;
  }

  void put(std::size_t at, const LayerValue& value) {
    const Standard& s = value.surface;
    std::size_t next = 0;
    outputs_[next++].put(at, s.base_colour);
    outputs_[next++].put(at, {value.occlusion, s.roughness, s.metal});
    if (plan_.normal) outputs_[next++].put(at, (value.normal + Vec3d{1, 1, 1}) * 0.5);
    if (plan_.specular) outputs_[next++].put(at, Rgb{1, 1, 1} * (s.reflectance * s.reflectance));
    if (plan_.emissive) outputs_[next++].put(at, value.emissive / plan_.emission);
  }

  void bake_band(std::uint32_t first, std::uint32_t rows) {
    std::atomic<std::uint32_t> next{0};
    const auto work = [&] {
      Desk desk(material_.layers.size());
      for (std::uint32_t row = next++; row < rows; row = next++)
        for (std::uint32_t x = 0; x < options_.width; ++x) put(std::size_t{row} * options_.width + x, texel(x, first + row, desk));
    };
    const unsigned wanted = options_.threads > 0 ? options_.threads : std::max(std::thread::hardware_concurrency(), 1u);
    std::vector<std::thread> others;
    for (unsigned i = 1; i < std::min(wanted, rows); ++i) others.emplace_back(work);
    work();
    for (std::thread& other : others) other.join();
  }

  Status write() {
    for (std::uint32_t first = 0; first < options_.height; first += band_rows) {
      if (options_.progress != nullptr && !options_.progress->report("layers", static_cast<double>(first) / options_.height))
        return Error{"CANCELLED", "cancelled", {}, {}, {}};
      const std::uint32_t rows = std::min(band_rows, options_.height - first);
      bake_band(first, rows);
      for (Output& output : outputs_) {
        if (Status done = output.png.write(rows, std::span(output.rows).first(std::size_t{3} * options_.width * rows)); !done) return done;
      }
    }
    for (Output& output : outputs_) {
      if (Status done = output.png.close(); !done) return done;
    }
    for (const Output& output : outputs_) {
      std::error_code failed;
      std::filesystem::rename(output.part(), output.file, failed);
      if (failed) return Error{"FILE_UNWRITABLE", failed.message(), {output.file.string(), 0, 0, {}}, {}, {}};
    }
    if (options_.progress != nullptr) options_.progress->report("layers", 1);
    return Done{};
  }

  BakedMaterial result() const {
    BakedMaterial baked;
    baked.samples = samples_;
    baked.images_decoded = pictures_.count();
    for (const Output& output : outputs_) baked.images.push_back({output.file.string(), {}, "image/png", output.file.stem().string()});
    std::uint32_t next = 0;
    const auto texture = [&next](Encoding encoding) {
      Texture t;
      t.image = next++;
      t.encoding = encoding;
      return t;
    };
    Material& m = baked.material;
    m.name = material_.name;
    // .5 is the index 1.5, which readers take without being told.
    const double ior = plan_.specular                                          ? baked_ior
                       : std::abs(plan_.reflectance - 0.5) <= same_reflectance ? MetalRough{}.ior
                                                                               : ior_of_f0(f0_of_reflectance(plan_.reflectance));
    m.model = MetalRough{{1, 1, 1}, 1, 1, ior};
    m.base_colour_texture = texture(Encoding::srgb);
    m.metal_rough_texture = texture(Encoding::linear);
    const auto& layers = material_.layers;
    if (std::any_of(layers.begin(), layers.end(), [](const MaterialLayer& layer) { return layer.material.occlusion.has_value(); }))
      m.occlusion = Occlusion{*m.metal_rough_texture, 1};
    if (plan_.normal) m.normal_map = NormalMap{texture(Encoding::linear), 1};
    if (plan_.specular) {
      m.lobes.specular = Specular{};
      m.lobes.specular->colour_texture = texture(Encoding::srgb);
    }
    if (plan_.emissive) {
      m.emissive = Rgb{1, 1, 1} * plan_.emission;
      m.emissive_texture = texture(Encoding::srgb);
    }
    m.double_sided = std::all_of(layers.begin(), layers.end(), [](const MaterialLayer& layer) { return layer.material.double_sided; });
    for (const MaterialLayer& layer : layers) {
      const auto lose = [&](std::string_view what, std::string_view effect) {
        baked.losses.add(fmt::format("layer \"{}\": {}", layer.material.name, what), std::string(effect));
      };
      const auto* model = std::get_if<MetalRough>(&layer.material.model);
      if (model != nullptr && f0_of_ior(model->ior) > largest_dielectric_f0)
        lose("its index of refraction", fmt::format("f0 {:.3f} becomes .16", f0_of_ior(model->ior)));
      for (const Loss& loss : unshown_losses(layer.material)) lose(loss.what, loss.effect);
      if (layer.material.alpha_cutoff || layer.material.blended || layer.material.base_alpha != 1)
        lose("its alpha", "the layer is opaque where its mask is");
    }
    return baked;
  }

  const LayeredMaterial& material_;
  const BakeOptions& options_;
  const LayerPictures& pictures_;
  Plan plan_;
  int samples_;
  std::vector<Output> outputs_;
};

Status check(const LayeredMaterial& material, const BakeOptions& options) {
  constexpr std::uint32_t largest = 1u << 15;
  if (material.layers.empty()) return invalid("expected a layer at least");
  for (const std::uint32_t size : {options.width, options.height})
    if (size == 0 || size > largest) return invalid(fmt::format("expected a width and height from 1 to {}, found {}", largest, size));
  if (options.bits != 8 && options.bits != 16) return invalid(fmt::format("expected 8 or 16 bits, found {}", options.bits));
  for (const MaterialLayer& layer : material.layers) {
    if (!(layer.uv_scale > 0) || !std::isfinite(layer.uv_scale))
      return invalid(fmt::format("layer \"{}\": expected a positive uv scale, found {}", layer.material.name, layer.uv_scale));
    if (!(layer.opacity >= 0 && layer.opacity <= 1))
      return invalid(fmt::format("layer \"{}\": expected an opacity from 0 to 1, found {}", layer.material.name, layer.opacity));
  }
  return Done{};
}

}  // namespace

Result<BakedMaterial> bake_layers(const LayeredMaterial& material, std::span<const ImageRef> images, const BakeOptions& options) {
  if (Status good = check(material, options); !good) return good.error();
  LayerPictures pictures(images);
  for (const MaterialLayer& layer : material.layers) {
    const Material& m = layer.material;
    std::vector<std::optional<Texture>> all{m.base_colour_texture, m.metal_rough_texture, m.specular_gloss_texture, m.emissive_texture,
                                            layer.mask};
    if (m.normal_map) all.emplace_back(m.normal_map->texture);
    if (m.occlusion) all.emplace_back(m.occlusion->texture);
    for (const std::optional<Texture>& texture : all)
      if (Status loaded = pictures.load(texture); !loaded) return loaded.error();
  }
  return Baker(material, options, pictures).bake();
}

}  // namespace etendue
