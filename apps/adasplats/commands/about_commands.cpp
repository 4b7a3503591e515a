// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
// The commands that describe the program: help, version, completion and man.
#include <filesystem>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/point_format.h"
#include "adasplats/jobs/output/output_folder.h"
#include "cli/command_entry.h"
#include "cli/commands.h"
#include "cli/manual/manual.h"
#include "cli/options/option_types.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

/// The command that names lead to, such as "evaluate", "c2c"; no names: the program itself.
/// Errors: usage, with the nearest name.
const CLI::App& find_command(const CLI::App& program, const std::vector<std::string>& names) {
  const CLI::App* found = &program;
  for (const std::string& name : names) {
    std::vector<std::string> known;
    const CLI::App* next = nullptr;
    for (const CLI::App* part : found->get_subcommands({})) {
      known.push_back(part->get_name());
      if (part->get_name() == name) next = part;
    }
    if (known.empty())
      throw Error(ErrorKind::usage,
                  "'" + found->get_name() + "' has no subcommands, found '" + name + "'");
    if (next == nullptr) throw Error(ErrorKind::usage, unknown_word("subcommand", name, known));
    found = next;
  }
  return *found;
}

constexpr const char* kInputTopic = "input";

/// The help topic on what commands read and on the options of loading it.
std::string input_help() {
  CLI::App topic;
  OptionSet options(topic);
  std::string labels;
  LoadOptions load;
  add_labels_option(options, labels, "semantickitti for sequence folders, else none")
      ->group(kInputHeading);
  add_load_options(options, load);
  std::vector<OptionEntry> entries = command_entry(topic).options;
  std::erase_if(entries, [](const OptionEntry& option) { return option.heading != kInputHeading; });
  return wrapped(
             "Input of the commands that read points (model, segment, calibrate, mesh, info, "
             "export, view, evaluate presence): point files (" +
                 point_format_names() + "), SemanticKITTI sequence folders, recordings (" +
                 recording_format_names() +
                 ", PCAP), folders of scans with --trajectory, and drives of PandaSet, nuScenes "
                 "and Argoverse 2.",
             0) +
         "\n\nInput options:\n" + options_text(entries) +
         "\nExamples:\n"
         "  adasplats model sequences/00 -o model.ply --scans 0:100:2\n"
         "  adasplats model cloud.laz -o model.ply --viewpoint 652000,6861000,60\n"
         "  adasplats model frames/ -o model.ply --trajectory vehicle.csv --mount 0,0,1.9\n"
         "  adasplats info drive.pcap --packet-sensor velodyne-vlp-16\n";
}

class HelpCommand final : public Command {
 public:
  explicit HelpCommand(CLI::App& program)
      : Command(program, "help", "Print the help of the program, of a command or of a topic",
                "  adasplats help\n"
                "  adasplats help model --all\n"
                "  adasplats help evaluate c2c\n"
                "  adasplats help input\n"),
        program_(program) {
    options()
        .add_option("SUBCOMMAND", names_, "Command, or the topic 'input' (default: the program)")
        ->type_name(kCommandType);
    options().add_flag("--all", all_, "Show all options of a command");
  }

  void run(Session& /*session*/) override {
    if (names_ == std::vector<std::string>{kInputTopic}) return print(input_help());
    print(help_text(command_entry(find_command(program_, names_)),
                    all_ ? HelpLength::all : HelpLength::short_help));
  }

 private:
  CLI::App& program_;
  std::vector<std::string> names_;
  bool all_ = false;
};

class VersionCommand final : public Command {
 public:
  explicit VersionCommand(CLI::App& program)
      : Command(program, "version", "Print the version", "  adasplats version\n") {}

  void run(Session& /*session*/) override {
    print(std::string("adasplats ") + ADASPLATS_VERSION + "\n");
  }
};

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
      : Command(
            program, "completion",
            "Print a shell script that completes commands, options, words and files",
            "  adasplats completion bash > ~/.local/share/bash-completion/completions/adasplats\n"
            "  adasplats completion zsh -o _adasplats\n"
            "  adasplats completion fish > ~/.config/fish/completions/adasplats.fish\n"
            "In a running bash: source <(adasplats completion bash). Packages install them.\n"),
        program_(program) {
    OptionSet& app = options();
    require(add_choice<Shell>(app, "SHELL", shell_,
                              {{"bash", Shell::bash}, {"zsh", Shell::zsh}, {"fish", Shell::fish}},
                              "Shell to complete in")
                ->default_str(""));
    add_path(app, "-o,--output", output_, "File to write (default: print)");
  }

  void run(Session& /*session*/) override {
    if (!output_.empty()) check_output_file(output_);
    const std::string script = completion_of(shell_, entry_for_completion(program_));
    if (output_.empty()) return print(script);
    write_file(output_, script);
  }

 private:
  CLI::App& program_;
  Shell shell_ = Shell::bash;
  std::filesystem::path output_;
};

/// Writes the pages of a command and its subcommands as FOLDER/NAME.1, replacing older ones.
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
                "  adasplats man model | man -l -\n"
                "  adasplats man evaluate c2c > adasplats-evaluate-c2c.1\n"
                "  adasplats man -o man1\n"),
        program_(program) {
    OptionSet& app = options();
    app.add_option("SUBCOMMAND", names_, "Command (default: the program)")->type_name(kCommandType);
    add_path(app, "-o,--output", folder_,
             "Folder for the pages of the command and all its subcommands (default: print one)");
  }

  void run(Session& /*session*/) override {
    const CommandEntry entry = command_entry(find_command(program_, names_));
    if (folder_.empty()) return print(man_page(entry));
    write_man_pages(entry, folder_);
  }

 private:
  CLI::App& program_;
  std::vector<std::string> names_;
  std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<Command> make_help_command(CLI::App& program) {
  return std::make_unique<HelpCommand>(program);
}
std::unique_ptr<Command> make_version_command(CLI::App& program) {
  return std::make_unique<VersionCommand>(program);
}
std::unique_ptr<Command> make_completion_command(CLI::App& program) {
  return std::make_unique<CompletionCommand>(program);
}
std::unique_ptr<Command> make_man_command(CLI::App& program) {
  return std::make_unique<ManCommand>(program);
}

}  // namespace adasplats::app
