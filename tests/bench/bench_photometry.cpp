// Photometric files: reading, lookups and sampling, beside a bare loop and the usual way (strtod; bilinear with acos and atan2); then each
// figure beside its limit. Exit 1 beyond one. Nanoseconds are this machine's and its other work's; ratios are of one run.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <random>

#include "bench.h"
#include "etendue/io.h"
#include "etendue/web_batch.h"
#include "etendue/web_sampler.h"
#include "importers/ies/ies.h"
#include "photometry_builder.h"

namespace etendue::bench {
namespace {

// A file of `planes` x `angles` candelas with four significant digits, as programs write them.
std::string file_of(int planes, int angles) {
  std::string text =
      "IESNA:LM-63-2002\r\n[TEST] 1\r\n[TESTLAB] b\r\n[ISSUEDATE] c\r\n[MANUFAC] d\r\n[LUMCAT] e\r\n[LUMINAIRE] f\r\n[LAMP] "
      "g\r\nTILT=NONE\r\n";
  text += fmt::format("1 -1 1 {} {} 1 2 .3 .6 0\r\n1 1 50\r\n", angles, planes);
  const auto row = [&](int count, const auto& value) {
    for (int i = 0; i < count; ++i) text += fmt::format("{}{}", value(i), i + 1 == count || i % 12 == 11 ? "\r\n" : " ");
  };
  row(angles, [&](int i) { return fmt::format("{:.4g}", 180.0 * i / (angles - 1)); });
  row(planes, [&](int i) { return fmt::format("{:.4g}", 360.0 * i / (planes - 1)); });
  for (int j = 0; j < planes; ++j)
    row(angles, [&](int i) { return fmt::format("{:.1f}", 900 * (1.2 + std::cos(0.02 * i) * std::sin(0.3 + 0.01 * (j % (planes - 1))))); });
  return text;
}

double by_from_chars(const std::string& text) {
  const char* p = text.data();
  const char* const end = p + text.size();
  double sum = 0;
  while (p != end) {
    double x = 0;
    const auto [stop, code] = std::from_chars(p, end, x);
    if (code == std::errc()) {
      sum += x;
      p = stop;
    } else {
      ++p;
    }
  }
  return sum;
}

// The usual way: whole file through strtod into vectors, no check.
std::vector<double> by_strtod(const std::string& text) {
  std::vector<double> values;
  const char* p = std::strstr(text.c_str(), "TILT=NONE") + 9;
  for (char* stop = nullptr;; p = stop) {
    const double x = std::strtod(p, &stop);
    if (stop == p) return values;
    values.push_back(x);
  }
}

struct UsualTable {
  std::vector<double> gamma, c, candela;
  // Upper bound by bisection, bilinear, wrap by fmod.
  double at(double c_deg, double gamma_deg) const {
    c_deg = std::fmod(std::fmod(c_deg, 360) + 360, 360);
    const auto i = std::clamp<std::ptrdiff_t>(std::upper_bound(gamma.begin(), gamma.end(), gamma_deg) - gamma.begin() - 1, 0,
                                              static_cast<std::ptrdiff_t>(gamma.size()) - 2);
    const auto j = std::clamp<std::ptrdiff_t>(std::upper_bound(c.begin(), c.end(), c_deg) - c.begin() - 1, 0,
                                              static_cast<std::ptrdiff_t>(c.size()) - 2);
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const double s = (gamma_deg - gamma[a]) / (gamma[a + 1] - gamma[a]), t = (c_deg - c[b]) / (c[b + 1] - c[b]);
    const double* const p = &candela[b * gamma.size() + a];
    const double* const q = p + gamma.size();
    return (1 - t) * ((1 - s) * p[0] + s * p[1]) + t * ((1 - s) * q[0] + s * q[1]);
  }
  double towards(const Vec3d& u) const { return at(std::atan2(u.y, u.x) * 180 / pi, std::acos(-u.z) * 180 / pi); }
};

struct Data {
  std::string text;
  IntensityWeb web;
  UsualTable usual;
  std::vector<WebAngles> angles;
  std::vector<Vec3d> directions;
  std::vector<Vec2d> squares;
  std::vector<float> c{}, gamma{}, x{}, y{}, z{};  // of the directions
};

Data data_of(int planes, int angles) {
  Data d;
  d.text = file_of(planes, angles);
  const auto file = read_ies(std::as_bytes(std::span(d.text)), "bench");
  d.web = test::web_of(file->distribution);
  const IntensityGrid& grid = file->distribution.grid;
  d.usual = {grid.vertical_deg, grid.horizontal_deg, grid.values};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 4096; ++i) {
    const double z = 2 * uniform(random) - 1, phi = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
    d.directions.push_back({r * std::cos(phi), r * std::sin(phi), z});
    d.angles.push_back(angles_of(WebType::c, d.directions.back()));
    d.squares.push_back({uniform(random), uniform(random)});
    d.c.push_back(static_cast<float>(d.angles.back().horizontal_deg));
    d.gamma.push_back(static_cast<float>(d.angles.back().vertical_deg));
    d.x.push_back(static_cast<float>(d.directions.back().x));
    d.y.push_back(static_cast<float>(d.directions.back().y));
    d.z.push_back(static_cast<float>(d.directions.back().z));
  }
  return d;
}

// What a figure of the table has to be: at most, or at least, so much.
struct Limit {
  std::string what;
  const Task* task;
  std::function<double(const std::vector<Contender>&)> value;
  double limit;
  bool at_least;
};
std::vector<Limit> limits;

// False where one is missed. Tasks that were left out say nothing.
bool print_limits() {
  bool good = true;
  fmt::print("\n");
  for (const Limit& l : limits) {
    if (!(l.task->contenders().front().ns > 0)) continue;
    const double value = l.value(l.task->contenders());
    const bool met = l.at_least ? value >= l.limit : value <= l.limit;
    good = good && met;
    fmt::print("{:<78} {:>8.2f}  limit {} {:>5.2f}  {}\n", l.what, value, l.at_least ? ">=" : "<=", l.limit, met ? "ok" : "MISSED");
  }
  return good;
}

// By name, in nanoseconds; the peer is the last one of each task.
double ns_of(const std::vector<Contender>& all, const char* name) {
  return std::find_if(all.begin(), all.end(), [&](const Contender& c) { return c.name == name; })->ns;
}
void limit_of(const Task& task, const char* name, double most_ns) {
  limits.push_back(
      {fmt::format("{}, {}: ns", task.name(), name), &task, [name](const auto& all) { return ns_of(all, name); }, most_ns, false});
}
void limit_over(const Task& task, const char* slow, const char* fast, double limit, bool at_least) {
  limits.push_back({fmt::format("{}: {} over {}", task.name(), slow, fast), &task,
                    [=](const auto& all) { return ns_of(all, slow) / ns_of(all, fast); }, limit, at_least});
}

void rows(Bench& bench, const char* size, const Data& d) {
  static double sink = 0;
  const std::size_t bytes = d.text.size();
  Task& parse = bench.task(fmt::format("read {} ({} KB), ns a byte", size, bytes / 1024), bytes);
  parse.contender("from_chars loop", Kind::anchor, "", [&d] { keep(&(sink = by_from_chars(d.text))); });
  parse.contender("etendue, fully validated", Kind::ours, "", [&d] {
    const auto file = read_ies(std::as_bytes(std::span(d.text)), "bench");
    keep(&file->distribution);
  });
  parse.contender("etendue, header only", Kind::ours, "", [&d] {
    PhotometricOptions options;
    options.mode = PhotometricMode::header_only;
    const auto file = read_ies(std::as_bytes(std::span(d.text)), "bench", options);
    keep(&file->distribution);
  });
  parse.contender("strtod", Kind::peer, "", [&d] {
    const auto values = by_strtod(d.text);
    keep(values.data());
  });
  limit_over(parse, "etendue, fully validated", "from_chars loop", 1.25, false);
  limit_over(parse, "from_chars loop", "etendue, header only", 5, true);
  limit_over(parse, "strtod", "etendue, fully validated", 3, true);
  const std::size_t n = d.angles.size();
  Task& angles = bench.task(fmt::format("lookup {} from angles", size), n);
  angles.contender("etendue", Kind::ours, "", [&d] {
    for (const WebAngles& a : d.angles) sink += d.web.at(a.horizontal_deg, a.vertical_deg);
    keep(&sink);
  });
  static std::list<WebBatch> batches;
  const WebBatch* const batch = &batches.emplace_back(d.web);
  angles.contender("etendue, batch of floats", Kind::ours, "2e-6 of the peak, 1e-4 deg", [&d, batch] {
    static std::vector<float> cd;
    cd.resize(d.c.size());
    sink += batch->at(d.c, d.gamma, cd, 0) ? cd[0] : 0;
    keep(cd.data());
  });
  angles.contender("bisection, bilinear", Kind::peer, "", [&d] {
    for (const WebAngles& a : d.angles) sink += d.usual.at(a.horizontal_deg, a.vertical_deg);
    keep(&sink);
  });
  limit_of(angles, "etendue, batch of floats", 10);
  limit_over(angles, "bisection, bilinear", "etendue, batch of floats", 3, true);
  limit_over(angles, "bisection, bilinear", "etendue", 3, true);
  Task& vectors = bench.task(fmt::format("lookup {} from a vector", size), n);
  vectors.contender("etendue", Kind::ours, "", [&d] {
    for (const Vec3d& u : d.directions) sink += d.web.towards(u);
    keep(&sink);
  });
  vectors.contender("etendue, batch of floats", Kind::ours, "2e-6 of the peak, 1e-4 deg", [&d, batch] {
    static std::vector<float> cd;
    cd.resize(d.x.size());
    sink += batch->towards(d.x, d.y, d.z, cd, 0) ? cd[0] : 0;
    keep(cd.data());
  });
  vectors.contender("acos, atan2, bisection, bilinear", Kind::peer, "", [&d] {
    for (const Vec3d& u : d.directions) sink += d.usual.towards(u);
    keep(&sink);
  });
  limit_of(vectors, "etendue, batch of floats", 20);
  limit_over(vectors, "acos, atan2, bisection, bilinear", "etendue, batch of floats", 3, true);
  limit_over(vectors, "acos, atan2, bisection, bilinear", "etendue", 3, true);
  static std::list<WebSampler> samplers;
  const WebSampler* const sampler = &samplers.emplace_back(d.web);
  Task& sampling = bench.task(fmt::format("sample {}", size), n);
  sampling.contender("etendue", Kind::ours, "", [&d, sampler] {
    for (const Vec2d& u : d.squares) sink += sampler->sample(u).cd;
    keep(&sink);
  });
  sampling.contender("etendue, batch", Kind::ours, "1e-12", [&d, sampler] {
    static std::vector<WebSampler::Sample> samples;
    samples.resize(d.squares.size());
    sink += sampler->sample(d.squares, samples) ? samples[0].cd : 0;
    keep(samples.data());
  });
  // Without a sampler: uniform directions, kept in proportion to their intensity.
  sampling.contender("rejection, acos, atan2, bilinear", Kind::peer, "", [&d, n] {
    static std::minstd_rand random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t i = 0; i < n; ++i) {
      Vec3d u;
      double cd = 0;
      do {
        const double z = 2 * uniform(random) - 1, phi = 2 * pi * uniform(random), r = std::sqrt(1 - z * z);
        u = {r * std::cos(phi), r * std::sin(phi), z};
        cd = d.usual.towards(u);
      } while (uniform(random) * d.web.max_cd() > cd);
      sink += cd + u.x;
    }
    keep(&sink);
  });
  limit_of(sampling, "etendue, batch", 60);
  limit_over(sampling, "rejection, acos, atan2, bilinear", "etendue, batch", 3, true);
  limit_over(sampling, "rejection, acos, atan2, bilinear", "etendue", 3, true);
}

}  // namespace
}  // namespace etendue::bench

int main(int argc, char** argv) {
  using namespace etendue::bench;
  static const Data small = data_of(5, 37), large = data_of(361, 263);
  Bench bench;
  rows(bench, "5x37", small);
  rows(bench, "361x263", large);
  const int status = bench.run(argc, argv);
  const bool table = std::none_of(argv, argv + argc, [](const char* word) { return std::strcmp(word, "--json") == 0; });
  return status != 0 || !table || print_limits() ? status : 1;
}
