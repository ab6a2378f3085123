#include "process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): not every C library declares it

namespace etendue {
namespace {

Error failed(const std::string& program, const std::string& what, int error_number) {
  return {"PROCESS_FAILED", what + ": " + std::strerror(error_number), {program, 0, 0, {}}, {}, {}};
}

// Both ends close in children and when the value goes.
struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() = default;
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() { close_read(), close_write(); }

  bool open() {
    int ends[2];
    if (::pipe(ends) != 0) return false;
    read_end = ends[0], write_end = ends[1];
    ::fcntl(read_end, F_SETFD, FD_CLOEXEC);
    ::fcntl(write_end, F_SETFD, FD_CLOEXEC);
    return true;
  }
  void close_read() { close(read_end); }
  void close_write() { close(write_end); }

 private:
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
};

std::vector<std::string> merged_environment(const std::vector<std::pair<std::string, std::string>>& added) {
  std::vector<std::string> merged;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& [name, value] : added) replaced = replaced || text.substr(0, text.find('=')) == name;
    if (!replaced) merged.emplace_back(text);
  }
  for (const auto& [name, value] : added) merged.emplace_back(name).append(1, '=').append(value);
  return merged;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// A process group of its own: Ctrl-C in the terminal reaches us alone, and we end the child. 0 or an error number.
int spawn(const ProcessCall& call, Pipe& input, Pipe& output, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, input.read_end, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.write_end, STDERR_FILENO);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);

  std::vector<std::string> arguments = call.arguments;
  std::vector<std::string> environment = merged_environment(call.environment);
  std::vector<char*> argv = pointers_to(arguments), envp = pointers_to(environment);
  const int error_number = ::posix_spawn(&pid, argv[0], &actions, &attributes, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error_number;
}

void hand_out_lines(std::string& pending, const ProcessCall& call, bool at_end) {
  std::size_t start = 0;
  for (std::size_t end; (end = pending.find('\n', start)) != std::string::npos; start = end + 1) {
    if (call.on_line) call.on_line(std::string_view(pending).substr(start, end - start));
  }
  pending.erase(0, start);
  if (at_end && !pending.empty() && call.on_line) call.on_line(pending);
}

// Reads until the child closes its output. True if it was cancelled.
bool follow(const ProcessCall& call, int descriptor) {
  std::string pending;
  char buffer[4096];
  while (true) {
    if (call.keep_going && !call.keep_going()) return true;
    pollfd waiting{descriptor, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, 100);
    if (ready < 0 && errno != EINTR) break;
    if (ready <= 0) continue;
    const ssize_t count = ::read(descriptor, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    pending.append(buffer, static_cast<std::size_t>(count));
    hand_out_lines(pending, call, false);
  }
  hand_out_lines(pending, call, true);
  return false;
}

}  // namespace

Result<ProcessEnd> run_process(const ProcessCall& call) {
  if (call.arguments.empty()) return failed("", "no program", EINVAL);
  Pipe input, output;
  if (!input.open() || !output.open()) return failed(call.arguments[0], "cannot make a pipe", errno);
  pid_t pid = 0;
  if (const int error_number = spawn(call, input, output, pid); error_number != 0) {
    return failed(call.arguments[0], "cannot start it", error_number);
  }
  input.close_read();
  output.close_write();

  ProcessEnd end;
  end.cancelled = follow(call, output.read_end);
  if (end.cancelled) ::kill(-pid, SIGKILL);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  end.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return end;
}

std::filesystem::path program_folder() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
}

Error become_program(const std::filesystem::path& program, char** arguments) {
  ::execv(program.c_str(), arguments);
  return failed(program.string(), "cannot start it", errno);
}

std::optional<std::filesystem::path> find_program(const std::string& name) {
  const char* variable = std::getenv("PATH");
  const std::string_view folders = variable ? variable : "";
  for (std::size_t start = 0; start <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', start), folders.size());
    const std::filesystem::path candidate = std::filesystem::path(folders.substr(start, end - start)) / name;
    if (end > start && ::access(candidate.c_str(), X_OK) == 0) return candidate;
    start = end + 1;
  }
  return std::nullopt;
}

}  // namespace etendue
