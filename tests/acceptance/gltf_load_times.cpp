// gltf_load_times FILE.glb RUNS: our full read, checks included, and tinygltf's plain load of the same file, one after the other in one
// process; medians and the median of the ratios as JSON.
#include <tiny_gltf.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "etendue/io.h"
#include "importers/gltf/gltf.h"

namespace {

template <class Work>
double milliseconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const char* file = argv[1];
  const int runs = std::atoi(argv[2]);
  const auto importer = etendue::make_gltf_importer();
  bool good = true;
  const auto ours = [&] {
    const auto imported = importer->read(file, {});
    good = good && imported && !imported->diagnostics.has_errors() && !imported->scene.meshes.empty();
  };
  const auto theirs = [&] {
    tinygltf::Model model;
    std::string errors, warnings;
    good = tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &errors, &warnings, file) && good;
  };
  ours();
  theirs();
  std::vector<double> a, b, ratios;
  for (int i = 0; i < runs; ++i) {
    a.push_back(milliseconds(ours));
    b.push_back(milliseconds(theirs));
    ratios.push_back(a.back() / b.back());
  }
  std::printf("{\"etendue_ms\": %.3f, \"tinygltf_ms\": %.3f, \"ratio\": %.4f}\n", median(a), median(b), median(ratios));
  return good ? 0 : 1;
}
