// What a verb has to say, as text or as one JSON document, and the wish to stop.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "session.h"

namespace etendue::cli {
namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

extern "C" void on_interrupt(int) {
  interrupt_seen = 1;
  std::signal(SIGINT, SIG_DFL);
}

const char* name_of(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

}  // namespace

void catch_interrupts() { std::signal(SIGINT, on_interrupt); }
bool interrupted() { return interrupt_seen != 0; }

void Session::print(std::string_view text) const {
  if (!common_.json) fmt::print("{}\n", text);
}

void Session::say(std::string_view text) const {
  if (!common_.quiet) fmt::print(stderr, "{}\n", text);
}

int exit_status_of(const Error& error) {
  static constexpr std::string_view outside[] = {"MITSUBA_MISSING", "MITSUBA_VARIANT", "MITSUBA_FAILED", "FILE_UNWRITABLE"};
  if (error.code == "CANCELLED") return exit_cancelled;
  if (error.code == "USAGE") return exit_usage;
  return std::find(std::begin(outside), std::end(outside), error.code) != std::end(outside) ? exit_outside : exit_bad_input;
}

int Session::fail(const Error& error) {
  diagnostics.add(to_diagnostic(error));
  for (const Diagnostic& note : error.notes) diagnostics.add(note);
  return finish(exit_status_of(error));
}

int Session::finish(int exit_status) {
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    const bool shown =
        diagnostic.severity == Severity::error || (diagnostic.severity == Severity::warning && !common_.quiet) || common_.verbose;
    if (shown) fmt::print(stderr, "{}\n", to_string(diagnostic));
  }
  if (common_.stats && !common_.json) {
    for (const auto& [key, value] : stats.items()) fmt::print(stderr, "{}: {}\n", key, value.dump());
  }
  if (common_.json) {
    Json document = {{"schema", "etendue." + verb_ + "/1"}};
    if (!result.is_null()) document["result"] = result;
    document["diagnostics"] = Json::array();
    for (const Diagnostic& diagnostic : diagnostics.all()) document["diagnostics"].push_back(to_json(diagnostic));
    if (!stats.empty()) document["stats"] = stats;
    fmt::print("{}\n", document.dump(2, ' ', false, Json::error_handler_t::replace));
  }
  return exit_status;
}

Json to_json(const Diagnostic& diagnostic) {
  Json json = {{"severity", name_of(diagnostic.severity)}, {"code", diagnostic.code}, {"text", diagnostic.text}};
  if (!diagnostic.where.file.empty()) json["file"] = diagnostic.where.file;
  if (diagnostic.where.line > 0) json["line"] = diagnostic.where.line;
  if (diagnostic.where.column > 0) json["column"] = diagnostic.where.column;
  if (diagnostic.where.offset >= 0) json["offset"] = diagnostic.where.offset;
  if (!diagnostic.where.pointer.empty()) json["pointer"] = diagnostic.where.pointer;
  if (!diagnostic.hint.empty()) json["hint"] = diagnostic.hint;
  return json;
}

}  // namespace etendue::cli
