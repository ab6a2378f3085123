// Another program as a child: started directly, never through a shell.
#pragma once

#include "etendue/result.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

struct ProcessCall {
  std::vector<std::string> arguments;                            // the program's path first
  std::vector<std::pair<std::string, std::string>> environment;  // beside our own
  // Called with every line of the child's standard output and error, without the line break.
  std::function<void(std::string_view line)> on_line;
  // Asked at least every tenth of a second; false ends the child. May be empty.
  std::function<bool()> keep_going;
};

struct ProcessEnd {
  int exit_status = 0;  // 128 + the signal's number where a signal ended it
  bool cancelled = false;
};

// Returns when the child has ended. Its standard input is a pipe that stays open as long as we live and nothing is written to, so a child
// that reads it learns of our death. Error: PROCESS_FAILED where it could not be started.
Result<ProcessEnd> run_process(const ProcessCall& call);

// The folder of the program that is running.
std::filesystem::path program_folder();

// Another program takes the place of this one, with the same arguments. Returns where it could not: PROCESS_FAILED.
Error become_program(const std::filesystem::path& program, char** arguments);

// A program by its bare name, in the folders of the PATH variable.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace etendue
