// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/output/output_folder.h"
#include "cli/commands.h"
#include "cli/manual/completion.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

constexpr const char* kCompletionExamples =
    "  adasplats completion bash > ~/.local/share/bash-completion/completions/adasplats\n"
    "  adasplats completion zsh -o _adasplats\n"
    "  adasplats completion fish > ~/.config/fish/completions/adasplats.fish\n"
    "In a running bash: source <(adasplats completion bash). A package has installed them.\n";

enum class Shell : std::uint8_t { bash, zsh, fish };

std::string completion_of(Shell shell, const CommandEntry& program) {
  switch (shell) {
    case Shell::bash: return bash_completion(program);
    case Shell::zsh: return zsh_completion(program);
    case Shell::fish: break;
  }
  return fish_completion(program);
}

class CompletionCommand final : public Command {
 public:
  explicit CompletionCommand(CLI::App& program)
      : Command(program, "completion",
                "Print what makes a shell complete commands, options, words and files",
                kCompletionExamples),
        program_(program) {
    OptionSet& app = options();
    require(add_choice<Shell>(app, "SHELL", shell_,
                              {{"bash", Shell::bash}, {"zsh", Shell::zsh}, {"fish", Shell::fish}},
                              "Whose language it is in")
                ->default_str(""));
    add_path(app, "-o,--output", output_, "File to write instead");
  }

  void run(Session& /*session*/) override {
    if (!output_.empty()) check_output_file(output_);
    const std::string script = completion_of(shell_, entry_for_completion(program_));
    if (output_.empty()) {
      print(script);
    } else {
      write_file(output_, script);
    }
  }

 private:
  CLI::App& program_;
  Shell shell_ = Shell::bash;
  std::filesystem::path output_;
};

}  // namespace

std::unique_ptr<Command> make_completion_command(CLI::App& program) {
  return std::make_unique<CompletionCommand>(program);
}

}  // namespace adasplats::app
