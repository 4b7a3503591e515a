// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "cli/commands.h"
#include "cli/manual/man_page.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "commands/about/find_command.h"

namespace adasplats::app {
namespace {

constexpr const char* kManExamples =
    "  adasplats man model | man -l -\n"
    "  adasplats man evaluate c2c > adasplats-evaluate-c2c.1\n"
    "  adasplats man -o man1\n";

/// Writes the pages of a command and of all below it as FOLDER/NAME.1, in place of older ones.
void write_man_pages(const CommandEntry& program, const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    throw system_error(ErrorKind::cannot_create, folder, "cannot create the folder",
                       failure.value());
  }
  for_each_command(program, [&](const CommandEntry& command) {
    write_file(folder / (man_page_name(command) + ".1"), man_page(command));
  });
}

class ManCommand final : public Command {
 public:
  explicit ManCommand(CLI::App& program)
      : Command(program, "man", "Print a manual page, or write those of all commands",
                kManExamples),
        program_(program) {
    OptionSet& app = options();
    app.add_option("SUBCOMMAND", names_, "Whose page; without it the program's")
        ->type_name(kCommandType);
    add_path(app, "-o,--output", folder_,
             "Folder to write the pages into, its own and those of all commands below");
  }

  void run(Session& /*session*/) override {
    const CommandEntry entry = command_entry(find_command(program_, names_));
    if (folder_.empty()) {
      print(man_page(entry));
    } else {
      write_man_pages(entry, folder_);
    }
  }

 private:
  CLI::App& program_;
  std::vector<std::string> names_;
  std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<Command> make_man_command(CLI::App& program) {
  return std::make_unique<ManCommand>(program);
}

}  // namespace adasplats::app
