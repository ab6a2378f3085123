// etendue filter: the mip levels of a normal map, with the roughness that each needs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <vector>

#include "etendue/normal_filter.h"
#include "etendue/picture_write.h"
#include "number_text.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct Options {
  std::string normals, out, roughness = "0.3", channel = "g", method = "ggx";
  double scale = 1;
  bool force = false;
};

Error bad(const std::string& file, std::string text, std::string hint = {}) {
  return {"PICTURE_UNSUITABLE", std::move(text), {file, 0, 0, {}}, std::move(hint), {}};
}

// The vectors 2 t - 1, their x and y scaled, as glTF has them.
Result<std::vector<Vec3f>> normals_of(const DecodedImage& image, const Options& options) {
  std::vector<Vec3f> normals;
  const std::size_t count = image.rgba.size() / 4;
  normals.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* t = image.rgba.data() + 4 * i;
    const auto scale = static_cast<float>(options.scale);
    const Vec3f n{scale * (2 * t[0] - 1), scale * (2 * t[1] - 1), 2 * t[2] - 1};
    const float norm = std::hypot(n.x, n.y, n.z);
    // Codes of 8 bits hold a unit vector to 1 / 255 a channel; a picture of something else is off by far.
    if (!(norm > 0.5f && norm < 1.8f))
      return bad(options.normals, fmt::format("column {}, row {}: expected a unit vector as 2 rgb - 1, found one of length {:.3g}",
                                              i % image.width, i / image.width, norm));
    normals.push_back(n);
  }
  return normals;
}

// One alpha, or one for each texel of the normal map.
Result<std::vector<float>> alphas_of(const Options& options, const DecodedImage& normals) {
  std::string_view text = options.roughness;
  if (double value = 0; take_number(text, value) == nullptr && text.empty()) {
    if (!(value >= 0 && value <= 1))
      return Error{"USAGE", fmt::format("--roughness: expected a number from 0 to 1 or a file, found {}", options.roughness), {}, {}, {}};
    return std::vector<float>{static_cast<float>(value * value)};
  }
  const Result<DecodedImage> image = decode({options.roughness, {}, {}, {}}, Encoding::linear);
  if (!image) return image.error();
  if (image->width > normals.width || image->height > normals.height)
    return bad(options.roughness,
               fmt::format("expected at most as many texels as the normal map, {} x {}, found {} x {}", normals.width, normals.height,
                           image->width, image->height),
               "make it smaller, or the normal map larger");
  const std::size_t channel = std::string_view("rgba").find(options.channel);
  const Texture lookup;
  std::vector<float> alphas;
  alphas.reserve(std::size_t{normals.width} * normals.height);
  for (std::uint32_t y = 0; y < normals.height; ++y) {
    for (std::uint32_t x = 0; x < normals.width; ++x) {
      const Rgba t = sample(*image, lookup, {(x + 0.5) / normals.width, (y + 0.5) / normals.height});
      const double value = channel == 0 ? t.r : channel == 1 ? t.g : channel == 2 ? t.b : t.a;
      if (!(value >= 0 && value <= 1))
        return bad(options.roughness, fmt::format("column {}, row {}: expected a roughness from 0 to 1, found {:.4g}", x, y, value));
      alphas.push_back(static_cast<float>(value * value));
    }
  }
  return alphas;
}

Picture picture_of(const NormalLevel& level, NormalFilter filter) {
  Picture picture;
  picture.width = level.width, picture.height = level.height;
  picture.texts["etendue:layers"] =
      "normal: mean of the texels' unit normals, as long as it is; roughness: square root of the filtered alpha; authored: of the mean "
      "alpha^2; misplaced: share of the lobe that the filtered one has elsewhere";
  Layer& normal = picture.add("normal", 3);
  for (std::size_t i = 0; i < level.means.size(); ++i) {
    for (int c = 0; c < 3; ++c) normal.pixels[3 * i + static_cast<std::size_t>(c)] = level.means[i][c];
  }
  const auto add = [&](const char* name, const std::vector<float>& values, bool root) {
    Layer& layer = picture.add(name, 1);
    std::transform(values.begin(), values.end(), layer.pixels.begin(), [root](float v) { return root ? std::sqrt(v) : v; });
  };
  add("roughness", level.alphas, true);
  add("authored", level.authored_alphas, true);
  if (filter == NormalFilter::ggx) add("misplaced", level.misplaced, false);
  return picture;
}

struct Summary {
  double shortest = 1, length = 0, authored = 0, filtered = 0, roughest = 0, misplaced = 0;
};
Summary summary_of(const NormalLevel& level) {
  Summary s;
  const auto count = static_cast<double>(level.means.size());
  for (std::size_t i = 0; i < level.means.size(); ++i) {
    const Vec3f& n = level.means[i];
    const double norm = static_cast<double>(std::hypot(n.x, n.y, n.z)), roughness = std::sqrt(static_cast<double>(level.alphas[i]));
    s.shortest = std::min(s.shortest, norm);
    s.length += norm / count;
    s.authored += std::sqrt(static_cast<double>(level.authored_alphas[i])) / count;
    s.filtered += roughness / count;
    s.roughest = std::max(s.roughest, roughness);
    s.misplaced += static_cast<double>(level.misplaced[i]) / count;
  }
  return s;
}

int run_filter(const Common& common, const Options& options) {
  Session session("filter", common);
  if (!options.out.empty() && !options.force && std::filesystem::exists(options.out))
    return session.fail({"USAGE", fmt::format("{} is there already", options.out), {}, "--force replaces it", {}});
  const NormalFilter filter = *normal_filter_named(options.method);
  const Result<DecodedImage> image = decode({options.normals, {}, {}, {}}, Encoding::linear);
  if (!image) return session.fail(image.error());
  const Result<std::vector<Vec3f>> normals = normals_of(*image, options);
  if (!normals) return session.fail(normals.error());
  const Result<std::vector<float>> alphas = alphas_of(options, *image);
  if (!alphas) return session.fail(alphas.error());
  const auto levels = filter_normals({image->width, image->height, *normals, *alphas}, filter);
  if (!levels) return session.fail(levels.error());
  if (!options.out.empty()) {
    std::vector<Picture> pictures;
    pictures.reserve(levels->size());
    std::transform(levels->begin(), levels->end(), std::back_inserter(pictures),
                   [filter](const NormalLevel& level) { return picture_of(level, filter); });
    if (const Status written = write_exr_levels(pictures, options.out); !written) return session.fail(written.error());
  }
  session.print(fmt::format("{:>5} {:>13}  {:^19}  {:^27}{}", "", "", "length of means", "roughness",
                            filter == NormalFilter::ggx ? "   misplaced" : ""));
  session.print(fmt::format("{:>5} {:>13}  {:>9} {:>9}  {:>8} {:>9} {:>8}{}", "level", "texels", "least", "mean", "authored", "filtered",
                            "highest", filter == NormalFilter::ggx ? "   mean, %" : ""));
  session.result = {{"method", options.method}, {"levels", Json::array()}};
  for (std::size_t i = 0; i < levels->size(); ++i) {
    const NormalLevel& level = (*levels)[i];
    const Summary s = summary_of(level);
    session.print(fmt::format("{:>5} {:>13}  {:>9.6f} {:>9.6f}  {:>8.4f} {:>9.4f} {:>8.4f}{}", i,
                              fmt::format("{} x {}", level.width, level.height), s.shortest, s.length, s.authored, s.filtered, s.roughest,
                              filter == NormalFilter::ggx ? fmt::format("   {:>7.2f}", 100 * s.misplaced) : ""));
    Json row{{"width", level.width},           {"height", level.height},           {"length_least", s.shortest},
             {"length_mean", s.length},        {"roughness_authored", s.authored}, {"roughness_mean", s.filtered},
             {"roughness_highest", s.roughest}};
    if (filter == NormalFilter::ggx) row["misplaced_mean"] = s.misplaced;
    session.result["levels"].push_back(std::move(row));
  }
  if (!options.out.empty()) {
    session.result["file"] = options.out;
    session.print(
        fmt::format("{}: normal, roughness, authored{} of each level", options.out, filter == NormalFilter::ggx ? ", misplaced" : ""));
  }
  session.stats["images_decoded"] = alphas->size() == 1 ? 1 : 2;
  session.stats["texels"] = image->rgba.size() / 4;
  return session.finish(exit_done);
}

}  // namespace

void add_filter(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("filter", "A normal map's mip levels, with the roughness that each of them needs");
  auto options = std::make_shared<Options>();
  verb->add_option("NORMALS", options->normals, "A normal map in tangent space, 2 rgb - 1 (any picture that OpenImageIO reads)")
      ->required();
  verb->add_option("OUT", options->out,
                   "OpenEXR file with mip levels: mean normals, roughness, roughness as authored, share that is misplaced");
  verb->add_option("--roughness", options->roughness, "A number from 0 to 1, or a picture of at most the normal map's size (glTF's: green)")
      ->capture_default_str();
  verb->add_option("--channel", options->channel, "Of the roughness picture")
      ->capture_default_str()
      ->check(CLI::IsMember({"r", "g", "b", "a"}));
  verb->add_option("--scale", options->scale, "Of the normals' x and y, as glTF's normalTexture.scale")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--method", options->method,
                   "ggx: the lobe nearest to the average one; slopes: alpha^2 + 2 / kappa; listing32: as Frostbite's notes print it")
      ->capture_default_str()
      ->check(CLI::IsMember({"ggx", "slopes", "listing32"}));
  verb->add_flag("--force", options->force, "Replace OUT");
  verb->footer(
      "\nExamples:\n  etendue filter bricks_normal.png --roughness 0.35\n"
      "  etendue filter bricks_normal.png bricks.exr --roughness bricks_metal_rough.png\n"
      "  etendue filter bricks_normal.png --method listing32 --json\n"
      "\nA lobe's alpha is roughness squared. The means' lengths tell how far normals spread; sdk/docs/normal-filtering.md derives the "
      "rest.");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_filter(common, *options); }; });
}

}  // namespace etendue::cli
