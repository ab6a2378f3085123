// A table of run times: contenders for the same task take turns in one process, so that what slows the machine down slows all of them, and
// each is told by its median time an element and by its median ratio to the first.
//   Task& task = bench.task("EV100 to luminance", elements);
//   task.contender("bare multiply", Kind::anchor, "", [&] { ... });
//   task.contender("etendue", Kind::ours, "5e-7 EV", [&] { ... });
#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

namespace etendue::bench {

// Whose: an anchor is what the machine can do at best, a peer a published formula or a foreign library's.
enum class Kind { anchor, ours, peer };

struct Contender {
  std::string name;
  Kind kind;
  std::string error;  // measured in this run, with its unit and over what: "2e-7 du'v', 800 K to 100000 K"
  std::function<void()> run;
  std::string note;  // for a peer that is faster: which mode of ours answers it, or why nobody needs one
  double ns = 0, ratio = 0;
};

class Task {
 public:
  Task(std::string name, std::size_t elements) : name_(std::move(name)), elements_(elements) {}
  void contender(std::string name, Kind kind, std::string error, std::function<void()> run, std::string note = "");
  // Median of `rounds` turns, in each of which every contender runs for about `turn_ms`.
  void measure(int rounds, double turn_ms);

  const std::string& name() const { return name_; }
  const std::vector<Contender>& contenders() const { return contenders_; }

 private:
  std::string name_;
  std::size_t elements_;
  std::vector<Contender> contenders_;
};

class Bench {
 public:
  Task& task(std::string name, std::size_t elements) { return tasks_.emplace_back(std::move(name), elements); }
  // Options: --json, --only TEXT (tasks whose name has it), --rounds N, --turn-ms X. The exit status.
  int run(int argc, char** argv);

 private:
  std::list<Task> tasks_, left_out_;
};

// Keeps the compiler from leaving out work whose result nobody reads.
inline void keep(const void* memory) { asm volatile("" : : "r"(memory) : "memory"); }

// Processor, its best instruction set among those that kernels are compiled for, compiler.
std::string machine();

}  // namespace etendue::bench
