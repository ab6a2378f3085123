// What every verb shares: the formats it knows, what it says at the end (text or one JSON document), progress, and cancelling.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "etendue/io.h"
#include "etendue/result.h"

namespace etendue::cli {

using Json = nlohmann::ordered_json;

// Exit status of the command (CLI.md).
enum Exit : int { exit_done = 0, exit_bad_input = 1, exit_usage = 2, exit_outside = 3, exit_undecided = 4, exit_cancelled = 130 };

// Options that stand on every verb.
struct Common {
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  bool stats = false;
};

// One run of a verb: collects what it has to say and says it once.
class Session {
 public:
  Session(std::string verb, const Common& common) : verb_(std::move(verb)), common_(common) {}

  Json result;  // "result" of the JSON document
  Json stats = Json::object();
  Diagnostics diagnostics;

  const Common& common() const { return common_; }
  // For people: on stdout; nothing with --json.
  void print(std::string_view text) const;
  // For people: what is being done, on stderr; nothing with -q.
  void say(std::string_view text) const;

  int fail(const Error& error);  // adds the error, finishes with the exit status that its code stands for
  int finish(int exit_status);   // prints diagnostics (and the JSON document); returns exit_status
 private:
  std::string verb_;
  Common common_;
};

// Error codes that mean that something outside is missing or failed.
int exit_status_of(const Error& error);

// A bar on stderr, only where that is a terminal; elsewhere one line for each finished stage. Ctrl-C makes report() return false.
class Bar : public Progress {
 public:
  explicit Bar(const Session& session);
  ~Bar() override;
  bool report(std::string_view what, double fraction) override;

 private:
  void end_stage();
  const Session& session_;
  bool terminal_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_, drawn_;
};

// Makes Ctrl-C a request that Bar::report() passes on; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

// Every format that can be read.
const Registry& importers();

// Reads an asset with whatever importer knows it; diagnostics and stats go into the session.
Result<Imported> read_asset(Session& session, const std::string& file, const ImportOptions& options = {});

Json to_json(const Diagnostic& diagnostic);

// "512x512" -> width, height. Error USAGE.
struct Size {
  std::uint32_t width = 512, height = 512;
};
Result<Size> parse_size(const std::string& text);

// "key,fill" -> indices of lights. Error LIGHT_UNKNOWN names those that there are.
Result<std::vector<std::uint32_t>> lights_by_name(const Scene& scene, const std::string& list);

// The lights that --lights and --mute leave lit.
Result<std::vector<std::uint32_t>> lit_lights(const Scene& scene, const std::string& lights, const std::string& mute);

// The camera called `name`, or, for "auto" or where the scene has none, one that is added and frames the scene.
Result<std::uint32_t> choose_camera(Scene& scene, const std::string& name, double aspect);

}  // namespace etendue::cli
