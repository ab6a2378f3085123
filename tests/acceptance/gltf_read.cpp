// Reads every glTF file that standard input names, a line each, and prints what came of it as a line of JSON: for gltf_import, and for
// the sanitizers. `gltf_read --tolerant` repairs what is harmless.
#include "etendue/scene.h"
#include "importers/gltf/gltf.h"

#include <chrono>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

namespace {

using namespace etendue;
using Json = nlohmann::json;

Json row(const Diagnostic& diagnostic) {
  Json json = {{"code", diagnostic.code}, {"pointer", diagnostic.where.pointer}, {"text", diagnostic.text}};
  if (diagnostic.where.line > 0) json["line"] = diagnostic.where.line;
  if (diagnostic.where.column > 0) json["column"] = diagnostic.where.column;
  if (diagnostic.where.offset >= 0) json["offset"] = diagnostic.where.offset;
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  ImportOptions options;
  options.tolerant = argc > 1 && std::strcmp(argv[1], "--tolerant") == 0;
  const auto importer = make_gltf_importer();
  for (std::string file; std::getline(std::cin, file);) {
    std::cerr << file << '\n';  // names the culprit of a crash
    const auto start = std::chrono::steady_clock::now();
    const Result<Imported> imported = importer->read(file, options);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    Json errors = Json::array(), warnings = Json::array();
    if (!imported) {
      errors.push_back(row(to_diagnostic(imported.error())));
      for (const Diagnostic& note : imported.error().notes)
        if (note.severity == Severity::error) errors.push_back(row(note));
    } else {
      for (const Diagnostic& diagnostic : imported->diagnostics.all())
        if (diagnostic.severity != Severity::note) (diagnostic.severity == Severity::error ? errors : warnings).push_back(row(diagnostic));
      // What is read without an error is a scene that can be used.
      const Diagnostics faults = errors.empty() ? validate(imported->scene) : Diagnostics();
      for (const Diagnostic& fault : faults.all())
        if (fault.severity == Severity::error) errors.push_back({{"code", "SCENE_INVALID"}, {"text", fault.text}});
    }
    const Json line = {{"file", file}, {"ms", took.count()}, {"errors", errors}, {"warnings", warnings}};
    std::cout << line.dump(-1, ' ', true, Json::error_handler_t::replace) << std::endl;
  }
}
