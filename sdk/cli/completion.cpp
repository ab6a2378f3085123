// Shell completion, made from the command's own description so that it cannot fall behind.
#include <fmt/format.h>

#include "verbs.h"

namespace etendue::cli {
namespace {

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string bash(const CLI::App& app) {
  std::string verbs, cases;
  for (const CLI::App* const verb : app.get_subcommands({})) {
    verbs += verb->get_name() + " ";
    cases += fmt::format("    {}) words='{}' ;;\n", verb->get_name(), fmt::join(options_of(*verb), " "));
  }
  return fmt::format(
      "_etendue() {{\n"
      "  local words current=${{COMP_WORDS[COMP_CWORD]}}\n"
      "  if [ $COMP_CWORD -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W '{}--help --version' -- \"$current\"))\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}    *) words= ;;\n  esac\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "}}\n"
      "complete -o default -F _etendue etendue\n",
      verbs, cases);
}

std::string zsh(const CLI::App& app) { return "autoload -U +X bashcompinit && bashcompinit\n" + bash(app); }

std::string fish(const CLI::App& app) {
  std::string text = "complete -c etendue -n __fish_use_subcommand -l version -d 'Version'\n";
  for (const CLI::App* const verb : app.get_subcommands({})) {
    text += fmt::format("complete -c etendue -n __fish_use_subcommand -a {}\n", verb->get_name());
    for (const std::string& option : options_of(*verb)) {
      text += fmt::format("complete -c etendue -n '__fish_seen_subcommand_from {}' -l {}\n", verb->get_name(), option.substr(2));
    }
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& app, Run& run) {
  CLI::App* const verb = app.add_subcommand("completion", "Completion script for a shell: bash, zsh or fish");
  auto shell = std::make_shared<std::string>();
  verb->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->footer("\nExample:\n  source <(etendue completion bash)");
  verb->callback([&app, &run, shell] {
    run = [&app, shell] {
      fmt::print("{}", *shell == "bash" ? bash(app) : *shell == "zsh" ? zsh(app) : fish(app));
      return static_cast<int>(exit_done);
    };
  });
}

}  // namespace etendue::cli
