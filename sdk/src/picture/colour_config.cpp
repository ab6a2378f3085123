#include "etendue/colour_config.h"

#include "built_in_config.h"
#include "edit_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace etendue {
namespace {

namespace ocio = OCIO_NAMESPACE;

Error invalid(const std::string& what, const std::string& file = {}) {
  return {"COLOUR_CONFIG_INVALID", fmt::format("OpenColorIO: {}", what), {file, 0, 0, {}}, {}, {}};
}

// What it is called with may throw; nothing leaves.
template <class Make>
auto guarded(Make make, const std::string& file = {}) -> decltype(make()) {
  try {
    return make();
  } catch (const std::exception& problem) {
    return invalid(problem.what(), file);
  }
}

// OpenColorIO writes warnings to the error stream unless it is told not to.
void silence() { ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE); }

bool is_finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

ocio::MatrixTransformRcPtr exposed(const ViewSettings& settings) {
  const Matrix3 m = transposed(settings.white_balance);
  const double e = settings.exposure;
  const double values[16] = {m.a.x * e, m.a.y * e, m.a.z * e, 0, m.b.x * e, m.b.y * e, m.b.z * e, 0,
                             m.c.x * e, m.c.y * e, m.c.z * e, 0, 0,         0,         0,         1};
  ocio::MatrixTransformRcPtr made = ocio::MatrixTransform::Create();
  made->setMatrix(values);
  return made;
}

ocio::TransformRcPtr display_view(const ViewSettings& settings) {
  ocio::DisplayViewTransformRcPtr made = ocio::DisplayViewTransform::Create();
  made->setSrc(settings.from.c_str());
  made->setDisplay(settings.display.c_str());
  made->setView(settings.view.c_str());
  return made;
}

// s = (log2(x + 2^least) - least) / (greatest - least).
ocio::TransformRcPtr shaper(const TableSettings& table) {
  const double slope = 1 / (table.greatest_stop - table.least_stop), offset = -table.least_stop * slope,
               black = std::exp2(table.least_stop);
  ocio::LogAffineTransformRcPtr made = ocio::LogAffineTransform::Create();
  made->setBase(2);
  made->setLogSideSlopeValue({slope, slope, slope});
  made->setLogSideOffsetValue({offset, offset, offset});
  made->setLinSideOffsetValue({black, black, black});
  return made;
}
double unshaped(double s, const TableSettings& table) {
  return std::exp2(table.least_stop + s * (table.greatest_stop - table.least_stop)) - std::exp2(table.least_stop);
}

void run(const ocio::ConstCPUProcessorRcPtr& processor, std::span<Vec3f> pixels) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  if (pixels.empty()) return;
  ocio::PackedImageDesc picture(pixels.data(), static_cast<long>(pixels.size()), 1, 3);
  processor->apply(picture);
}

// Exact powers and logarithms: the default's fast ones are off by some 1e-5.
ocio::ConstCPUProcessorRcPtr cpu(const ocio::ConstProcessorRcPtr& processor) {
  return processor->getOptimizedCPUProcessor(ocio::BIT_DEPTH_F32, ocio::BIT_DEPTH_F32, ocio::OPTIMIZATION_LOSSLESS);
}

}  // namespace

struct ColourStep::Implementation {
  ocio::ConstConfigRcPtr config;
  ocio::ConstProcessorRcPtr processor;
  ocio::ConstCPUProcessorRcPtr run;
};
struct ColourConfig::Implementation {
  ocio::ConstConfigRcPtr config;

  Result<ColourStep> step(const ocio::ConstTransformRcPtr& transform) const {
    return guarded([&]() -> Result<ColourStep> {
      const ocio::ConstProcessorRcPtr processor = config->getProcessor(transform);
      return ColourStep(std::make_shared<const ColourStep::Implementation>(ColourStep::Implementation{config, processor, cpu(processor)}));
    });
  }
};

void ColourStep::apply(std::span<Vec3f> pixels) const { run(made_->run, pixels); }

Status ColourStep::write(const std::filesystem::path& file) const {
  const auto unwritable = [&](const std::string& text) { return Error{"COLOUR_STEP_UNWRITABLE", text, {file.string(), 0, 0, {}}, {}, {}}; };
  const char* format = file.extension() == ".clf"   ? "Academy/ASC Common LUT Format"
                       : file.extension() == ".ctf" ? "Color Transform Format"
                                                    : nullptr;
  if (format == nullptr) return unwritable("expected a name that ends in .clf or .ctf");
  try {
    std::ofstream out(file);
    made_->processor->createGroupTransform()->write(made_->config, format, out);
    out.flush();
    if (!out) return unwritable("expected a file that can be written");
  } catch (const std::exception& problem) {
    return unwritable(problem.what());
  }
  return Done{};
}

Result<ColourConfig> ColourConfig::built_in() {
  silence();
  return guarded(
      []() -> Result<ColourConfig> { return ColourConfig(std::make_shared<const Implementation>(Implementation{built_in_config()})); });
}

Result<ColourConfig> ColourConfig::from_file(const std::filesystem::path& file) {
  silence();
  return guarded(
      [&]() -> Result<ColourConfig> {
        const ocio::ConstConfigRcPtr read = ocio::Config::CreateFromFile(file.string().c_str());
        read->validate();
        return ColourConfig(std::make_shared<const Implementation>(Implementation{read}));
      },
      file.string());
}

Result<ColourConfig> ColourConfig::from_environment() {
  const char* file = std::getenv("OCIO");
  return file != nullptr && *file != '\0' ? from_file(file) : built_in();
}

namespace {

// The names that a numbered question gives.
template <class Name>
std::vector<std::string> names_of(int count, Name name) {
  std::vector<std::string> names(static_cast<std::size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i) names[static_cast<std::size_t>(i)] = name(i);
  return names;
}

}  // namespace

std::vector<std::string> ColourConfig::spaces() const {
  return names_of(made_->config->getNumColorSpaces(), [&](int i) { return made_->config->getColorSpaceNameByIndex(i); });
}
std::vector<std::string> ColourConfig::displays() const {
  return names_of(made_->config->getNumDisplays(), [&](int i) { return made_->config->getDisplay(i); });
}
std::vector<std::string> ColourConfig::views(const std::string& display) const {
  return names_of(made_->config->getNumViews(display.c_str()), [&](int i) { return made_->config->getView(display.c_str(), i); });
}

namespace {

// Whether a name is among those there are.
Status known(const char* what, const std::string& name, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return Done{};
  std::vector<Candidate> candidates(names.size());
  std::transform(names.begin(), names.end(), candidates.begin(), [](const std::string& other) { return Candidate{other, other}; });
  return Error{"COLOUR_NAME_UNKNOWN",
               fmt::format("\"{}\" is no {} of this configuration", name, what),
               {},
               fmt::format("nearest: {}", fmt::join(nearest_candidates(name, candidates, 3), ", ")),
               {}};
}

Status valid(const ColourConfig& config, const ViewSettings& settings) {
  for (const auto& [what, name, names] : {std::tuple{"colour space", &settings.from, config.spaces()},
                                          {"display", &settings.display, config.displays()},
                                          {"view", &settings.view, config.views(settings.display)}})
    if (Status found = known(what, *name, names); !found) return found;
  const Matrix3& m = settings.white_balance;
  if (!(std::isfinite(settings.exposure) && is_finite(m.a) && is_finite(m.b) && is_finite(m.c)))
    return Error{"VIEW_INVALID",
                 fmt::format("expected an exposure and a white balance that are finite, found an exposure of {}", settings.exposure),
                 {},
                 {},
                 {}};
  return Done{};
}

}  // namespace

Result<ColourStep> ColourConfig::conversion(const std::string& from, const std::string& to) const {
  for (const std::string& name : {from, to})
    if (const Status found = known("colour space", name, spaces()); !found) return found.error();
  ocio::ColorSpaceTransformRcPtr transform = ocio::ColorSpaceTransform::Create();
  transform->setSrc(from.c_str());
  transform->setDst(to.c_str());
  return made_->step(transform);
}

Result<ColourStep> ColourConfig::to_linear_rec709(const std::string& from) const {
  if (const Status found = known("colour space", from, spaces()); !found) return found.error();
  return guarded([&]() -> Result<ColourStep> {
    const ocio::ConstConfigRcPtr target = built_in_config();
    const ocio::ConstProcessorRcPtr processor =
        ocio::Config::GetProcessorFromConfigs(made_->config, from.c_str(), target, "linear Rec.709");
    return ColourStep(std::make_shared<const ColourStep::Implementation>(ColourStep::Implementation{target, processor, cpu(processor)}));
  });
}

Result<ColourStep> ColourConfig::view(const ViewSettings& settings) const {
  if (const Status checked = valid(*this, settings); !checked) return checked.error();
  ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
  group->appendTransform(exposed(settings));
  group->appendTransform(display_view(settings));
  return made_->step(group);
}

// Exposure and white balance are a matrix before the shaper. Within the table the matrix' negative terms would be interpolated over
// logarithms: half of the display's range off beside saturated lights. In front of it they are exact, and the table's domain is relative to
// white.
Result<ColourStep> ColourConfig::baked(const ViewSettings& settings, const TableSettings& table) const {
  if (const Status checked = valid(*this, settings); !checked) return checked.error();
  if (!(table.grid >= 3 && table.grid <= 129 && table.least_stop >= -100 && table.greatest_stop <= 100 &&
        table.least_stop < table.greatest_stop))
    return Error{"TABLE_INVALID",
                 fmt::format("expected 3 to 129 points between stops from -100 to 100, found {} between {} and {}", table.grid,
                             table.least_stop, table.greatest_stop),
                 {},
                 {},
                 {}};
  const ViewSettings inside{.from = settings.from, .display = settings.display, .view = settings.view};
  const Result<ColourStep> direct = view(inside);
  if (!direct) return direct.error();

  const auto size = static_cast<std::size_t>(table.grid);
  std::vector<float> axis(size);
  for (std::size_t i = 0; i < size; ++i)
    axis[i] = static_cast<float>(unshaped(static_cast<double>(i) / static_cast<double>(size - 1), table));
  std::vector<Vec3f> lattice;
  lattice.reserve(size * size * size);
  for (const float r : axis)
    for (const float g : axis)
      for (const float b : axis) lattice.push_back({r, g, b});
  direct->apply(lattice);

  return guarded([&]() -> Result<ColourStep> {
    ocio::Lut3DTransformRcPtr lut = ocio::Lut3DTransform::Create(static_cast<unsigned long>(size));
    lut->setInterpolation(ocio::INTERP_TETRAHEDRAL);
    for (std::size_t i = 0; i < lattice.size(); ++i)
      lut->setValue(i / (size * size), i / size % size, i % size, lattice[i].x, lattice[i].y, lattice[i].z);
    ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
    group->appendTransform(exposed(settings));
    group->appendTransform(shaper(table));
    group->appendTransform(lut);
    return made_->step(group);
  });
}

}  // namespace etendue
