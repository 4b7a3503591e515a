// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/manual/command_entry.h"
#include "cli/terminal.h"
#include "commands/about/find_command.h"

namespace adasplats::app {
namespace {

constexpr const char* kHelpExamples =
    "  adasplats help\n"
    "  adasplats help model\n"
    "  adasplats help evaluate c2c\n";

class HelpCommand final : public Command {
 public:
  explicit HelpCommand(CLI::App& program)
      : Command(program, "help", "Print the help of the program or of a command", kHelpExamples),
        program_(program) {
    options()
        .add_option("SUBCOMMAND", names_, "What to tell of; without it the program")
        ->type_name(kCommandType);
  }

  void run(Session& /*session*/) override { print(help_text(find_command(program_, names_))); }

 private:
  CLI::App& program_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<Command> make_help_command(CLI::App& program) {
  return std::make_unique<HelpCommand>(program);
}

}  // namespace adasplats::app
