// The runner: pictures from several seeds, the cache, failures in Mitsuba's own words, cancelling.
#include "fixture.h"

#include "etendue/io.h"

#include <chrono>
#include <fstream>

namespace etendue::testing {
namespace {

namespace fs = std::filesystem;

// A lamp over a floor, seen from above.
fs::path lamp(const std::string& name, double cd) {
  Scene scene;
  Object floor;
  floor.geometry = PlaneGeometry{4};
  scene.objects.push_back(floor);
  Light light = light_of(SphereShape{0.3});
  light.emission.value = cd;
  light.transform.translation = {0, 1, 0};
  scene.lights.push_back(light);
  scene.cameras.push_back(look_at({0, 3, 2}, {0, 0, 0}, 0.8));
  ExportOptions options;
  options.width = 24, options.height = 16;
  exported(scene, name, options);
  return scratch() / (name + ".xml");
}

class Recorder : public Progress {
 public:
  bool report(std::string_view, double fraction) override {
    ++calls;
    rising = rising && fraction >= last;
    last = fraction;
    return calls < stop_at;
  }
  int calls = 0, stop_at = 1 << 30;
  bool rising = true;
  double last = 0;
};

// The variance layer is the variance of the mean: over 384 pixels, the squared differences of two independent runs are twice it.
TEST(Runner, VarianceIsThatOfTheMean) {
  ETENDUE_NEEDS_MITSUBA();
  const fs::path scene = lamp("variance", 1000);
  const MitsubaJob one{scene, "one", 8, 16, 0}, other{scene, "other", 8, 16, 16};
  Recorder progress;
  Result<std::vector<Picture>> pictures = run_mitsuba(*mitsuba(), {one, other}, {}, &progress);
  ASSERT_TRUE(pictures.ok()) << pictures.error().text;
  const Picture &a = (*pictures)[0], &b = (*pictures)[1];
  EXPECT_EQ(a.width, 24u);
  EXPECT_EQ(a.height, 16u);
  EXPECT_EQ(a.numbers.at("etendue:seeds"), 16);
  double squares = 0, variances = 0;
  for (std::size_t i = 0; i < a.find("")->pixels.size(); ++i) {
    const double d = a.find("")->pixels[i] - b.find("")->pixels[i];
    squares += d * d;
    variances += a.find("variance")->pixels[i] + b.find("variance")->pixels[i];
  }
  // The ratio of means over 1152 channels (a third of them independent) has a relative scatter of sqrt(2 / 384) = .07 and more where few
  // noisy pixels dominate.
  EXPECT_GT(squares, 0);
  EXPECT_NEAR(squares / variances, 1, 0.35);
  EXPECT_TRUE(progress.rising);
  EXPECT_GT(progress.calls, 2);
}

TEST(Runner, CacheKnowsWhatAPictureWasMadeFrom) {
  ETENDUE_NEEDS_MITSUBA();
  const fs::path cache = scratch() / "cache";
  const auto count = [&] {
    return fs::exists(cache) ? std::distance(fs::directory_iterator(cache), fs::directory_iterator()) : std::ptrdiff_t{0};
  };
  const auto run = [&](const fs::path& scene, std::uint32_t samples) {
    Result<std::vector<Picture>> pictures = run_mitsuba(*mitsuba(), {{scene, "lamp", samples, 5, 0}}, cache);
    EXPECT_TRUE(pictures.ok());
    return pictures ? (*pictures)[0].find("")->pixels : std::vector<float>{};
  };
  const std::vector<float> first = run(lamp("cached", 1000), 4);
  EXPECT_EQ(count(), 1);
  // The same scene under another name is the same picture.
  EXPECT_EQ(run(lamp("cached_too", 1000), 4), first);
  EXPECT_EQ(count(), 1);
  EXPECT_NE(run(lamp("cached", 2000), 4), first);
  EXPECT_EQ(count(), 2);
  run(lamp("cached", 1000), 5);
  EXPECT_EQ(count(), 3);
}

TEST(Runner, FailuresAreInMitsubasWords) {
  ETENDUE_NEEDS_MITSUBA();
  const fs::path scene = scratch() / "broken.xml";
  std::ofstream(scene) << R"(<scene version="3.0.0"><default name="spp" value="1"/><default name="seed" value="0"/>
    <sensor type="perspective"><sampler type="independent"><integer name="sample_count" value="$spp"/><integer name="seed" value="$seed"/>
    </sampler></sensor><emitter type="point"><float name="range" value="3"/></emitter></scene>)";
  const Result<std::vector<Picture>> pictures = run_mitsuba(*mitsuba(), {{scene, "broken", 4, 5, 0}}, {});
  ASSERT_FALSE(pictures.ok());
  EXPECT_EQ(pictures.error().code, "MITSUBA_FAILED");
  EXPECT_NE(pictures.error().text.find("range"), std::string::npos) << pictures.error().text;
}

TEST(Runner, CancellingEndsMitsubaSoonAndLeavesNothing) {
  ETENDUE_NEEDS_MITSUBA();
  const fs::path scene = lamp("long", 1000), cache = scratch() / "cancelled";
  Recorder progress;
  progress.stop_at = 3;
  const auto start = std::chrono::steady_clock::now();
  const Result<std::vector<Picture>> pictures = run_mitsuba(*mitsuba(), {{scene, "long", 10'000'000, 1000, 0}}, cache, &progress);
  ASSERT_FALSE(pictures.ok());
  EXPECT_EQ(pictures.error().code, "CANCELLED");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_FALSE(fs::exists(cache));
}

TEST(Runner, MissingMitsubaSaysWhatToDo) {
  const Result<Mitsuba> found = find_mitsuba({}, {scratch() / "nowhere", "no-such-program-anywhere"});
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().code, "MITSUBA_MISSING");
  EXPECT_NE(found.error().text.find("nowhere"), std::string::npos);
  EXPECT_NE(found.error().hint.find("pip install mitsuba"), std::string::npos);
  // An interpreter that has no Mitsuba is not taken for it.
  EXPECT_FALSE(find_mitsuba(fs::path("/bin/sh"), {}).ok());
}

}  // namespace
}  // namespace etendue::testing
