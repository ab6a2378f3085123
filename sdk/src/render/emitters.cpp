#include "emitters.h"

#include "etendue/render.h"

#include <array>
#include <optional>
#include <utility>

namespace etendue {
namespace {

// Texels joined as they stand.
bool is_plain(const Texture& texture) {
  const auto& m = texture.uv_transform;
  return !texture.nearest && m[0][0] == 1 && m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][1] == 1 && m[1][2] == 0;
}

Result<std::shared_ptr<const DecodedImage>> decoded_alone(const Scene& scene, const Texture& texture) {
  Result<DecodedImage> decoded = decode(scene.images[texture.image], texture.encoding);
  if (!decoded) return decoded.error();
  return std::make_shared<const DecodedImage>(std::move(*decoded));
}

}  // namespace

namespace rendering {

Result<PicturedEmitter> emitter_in(const Scene& scene, const Light& light, const TextureSource& texture, bool with_picture) {
  eval::EmitterParts parts;
  if (const auto* shape = std::get_if<MeshShape>(&light.shape)) {
    const Mesh& mesh = scene.meshes[shape->mesh];
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) { return vec_cast<double>(mesh.positions[mesh.indices[i + k]]); };
      parts.triangles.push_back({corner(0), corner(1), corner(2)});
      if (!light.emission.texture || mesh.uvs.empty()) continue;
      const auto uv = [&](std::size_t k) { return Vec2d{mesh.uvs[mesh.indices[i + k]].x, mesh.uvs[mesh.indices[i + k]].y}; };
      parts.uvs.push_back({uv(0), uv(1), uv(2)});
    }
  }
  const auto* environment = std::get_if<EnvironmentShape>(&light.shape);
  if (environment != nullptr && environment->image) {
    Result<DecodedImage> decoded = decode(scene.images[*environment->image], Encoding::linear);
    if (!decoded) return decoded.error();
    std::vector<Vec3f> pixels(std::size_t{decoded->width} * decoded->height);
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = {decoded->rgba[4 * i], decoded->rgba[4 * i + 1], decoded->rgba[4 * i + 2]};
    parts.environment = eval::make_environment(decoded->width, decoded->height, std::move(pixels));
  }
  std::uint32_t width = 0, height = 0;
  if (light.emission.texture) {
    Result<std::shared_ptr<const DecodedImage>> decoded = texture(*light.emission.texture);
    if (!decoded) return decoded.error();
    width = (*decoded)->width, height = (*decoded)->height;
    parts.pattern = [pixels = std::move(*decoded), where = *light.emission.texture](Vec2d uv) {
      const Rgba texel = sample(*pixels, where, uv);
      return Rgb{texel.r, texel.g, texel.b};
    };
  }
  Result<eval::Emitter> emitter = eval::emitter_of(light, parts);
  if (!emitter) return emitter.error();
  PicturedEmitter made{std::move(*emitter), nullptr};
  if (with_picture && light.emission.texture && is_plain(*light.emission.texture) && eval::carries_picture(made.emitter))
    made.picture = std::make_shared<const eval::PictureMoments>(made.emitter.pattern, width, height);
  return made;
}

}  // namespace rendering

Result<std::vector<eval::Emitter>> emitters_of(const Scene& scene, std::span<const std::uint32_t> lights) {
  std::vector<eval::Emitter> emitters;
  for (const std::uint32_t light : lights) {
    Result<PicturedEmitter> made = rendering::emitter_in(
        scene, scene.lights[light], [&](const Texture& t) { return decoded_alone(scene, t); }, false);
    if (!made) return made.error();
    emitters.push_back(std::move(made->emitter));
  }
  return emitters;
}

Result<std::vector<PicturedEmitter>> pictured_emitters_of(const Scene& scene, std::span<const std::uint32_t> lights) {
  std::vector<PicturedEmitter> emitters;
  for (const std::uint32_t light : lights) {
    Result<PicturedEmitter> made = rendering::emitter_in(
        scene, scene.lights[light], [&](const Texture& t) { return decoded_alone(scene, t); }, true);
    if (!made) return made.error();
    emitters.push_back(std::move(*made));
  }
  return emitters;
}

Result<eval::LightCard> card_of(const Scene& scene, const Light& light) {
  std::optional<eval::LightCardBuilder> builder;
  if (!light.emission.texture) {
    constexpr std::array<float, 4> white{1, 1, 1, 1};
    builder.emplace(1, 1).add_row(white);
    return std::move(*builder).finish();
  }
  const Texture& texture = *light.emission.texture;
  if (!is_plain(texture)) {
    return Error{"EVALUATION_UNSUPPORTED",
                 "light '" + light.name + "': expected a texture without a transform, whose texels are joined, for a card",
                 {scene.file, 0, 0, {}},
                 {},
                 {}};
  }
  const Status read = decode_rows(scene.images[texture.image], texture.encoding, [&](const ImageRow& row) {
    if (!builder) builder.emplace(row.width, row.height);
    builder->add_row(row.rgba);
  });
  if (!read) return read.error();
  return std::move(*builder).finish();
}

}  // namespace etendue
