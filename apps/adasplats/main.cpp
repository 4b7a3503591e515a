// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/output/output_folder.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/manual/manual.h"
#include "cli/options/config_file.h"
#include "cli/options/option_types.h"
#include "cli/report.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

constexpr int kExitNoMemory = 71;  // EX_OSERR
constexpr int kExitSignal = 128;   // plus the signal's number, as in shells
constexpr int kSigPipe = 13;

constexpr const char* kProgramExamples =
    "Examples:\n"
    "  adasplats demo\n"
    "  adasplats model scans/sequences/00 -o model.ply\n"
    "  adasplats simulate model.ply --trajectory scans/sequences/00 --offset 1,1,-0.5 -o new\n"
    "  adasplats evaluate c2c new scans/sequences/00\n"
    "Exit codes are those of sysexits(3).";

/// The program's command line: all commands with their options.
struct Program {
  CLI::App app{"Turn LiDAR recordings into splat models, and models into simulated scans",
               "adasplats"};
  std::vector<std::unique_ptr<Command>> commands;

  Program() {
    app.set_help_flag("-h,--help", "Print the basic options and exit");  // subcommands inherit it
    app.set_help_all_flag("--help-all", "Print all options and exit");
    app.footer(kProgramExamples);
    app.set_version_flag("--version", std::string("adasplats ") + ADASPLATS_VERSION,
                         "Print the version and exit");
    app.allow_extras();
    app.require_subcommand(0, 1);
    CLI::App& synth = group("synth", "Make synthetic data with exact ground truth",
                            "  adasplats synth street -o street\n"
                            "  adasplats synth world -o world --kind city\n"
                            "  adasplats synth city -o city --length 10km --points 1e9\n");
    commands.push_back(make_synth_street_command(synth));
    commands.push_back(make_synth_world_command(synth));
    commands.push_back(make_synth_city_command(synth));
    commands.push_back(make_info_command(app));
    commands.push_back(make_sensors_command(app));
    commands.push_back(make_model_command(app));
    commands.push_back(make_calibrate_command(app));
    commands.push_back(make_segment_command(app));
    commands.push_back(make_mesh_command(app));
    commands.push_back(make_simulate_command(app));
    commands.push_back(make_render_command(app));
    commands.push_back(make_view_command(app));
    commands.push_back(make_serve_sensor_command(app));
    commands.push_back(make_export_command(app));
    commands.push_back(make_send_command(app));
    CLI::App& evaluate = group("evaluate", "Measure simulations and models",
                               "  adasplats evaluate c2c scans street/mapping.ply\n"
                               "  adasplats evaluate resimulate model.ply sequences/01\n");
    for (auto& command : make_evaluate_commands(evaluate)) commands.push_back(std::move(command));
    commands.push_back(make_fit_drop_command(app));
    commands.push_back(make_fit_sensor_command(app));
    commands.push_back(make_simkitti32_command(app));
    commands.push_back(make_compare_command(app));
    commands.push_back(make_demo_command(app));
    for (const auto& command : commands) command->add_common_options();  // last in the help
    // These describe the program and compute nothing: no threads, seed or report.
    commands.push_back(make_help_command(app));
    commands.push_back(make_version_command(app));
    commands.push_back(make_completion_command(app));
    commands.push_back(make_man_command(app));
  }

  /// For help and manual pages. Not earlier: the parser would reject command lines that a
  /// configuration file completes.
  void mark_required() {
    for (const auto& command : commands) command->mark_required();
  }

  /// A subcommand that only has subcommands.
  CLI::App& group(const std::string& name, const std::string& description,
                  const std::string& examples) {
    CLI::App& parent = *app.add_subcommand(name, description);
    parent.allow_extras();
    parent.require_subcommand(0, 1);
    parent.footer("Examples:\n" + examples);
    return parent;
  }
};

/// The arguments, last one first as the parser wants them.
std::vector<std::string> reversed_arguments(int argc, char** argv) {
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  std::ranges::reverse(arguments);
  return arguments;
}

/// The innermost subcommand of the command line, or the program itself.
CLI::App& chosen_app(CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? app : chosen_app(*parsed.front());
}

std::vector<std::string> option_names(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// Rejects arguments that no option or subcommand accepted.
void check_extras(CLI::App& program, CLI::App& chosen) {
  std::vector<std::string> extras = program.remaining(true);
  if (extras.empty()) return;
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
  const auto option = std::find_if(extras.begin(), extras.end(), is_option);
  if (option != extras.end()) {
    const std::string name = option->substr(0, option->find('='));
    const std::vector<std::string> known = option_names(chosen);
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      throw Error(ErrorKind::usage, name + " must follow the subcommand");
    }
    throw Error(ErrorKind::usage, unknown_word("option", name, known));
  }
  std::vector<std::string> subcommands;
  for (const CLI::App* subcommand : chosen.get_subcommands({})) {
    subcommands.push_back(subcommand->get_name());
  }
  throw Error(ErrorKind::usage, subcommands.empty()
                                    ? "unexpected argument '" + extras.front() + "'"
                                    : unknown_word("subcommand", extras.front(), subcommands));
}

Command& find_command(Program& program, CLI::App& chosen) {
  for (const auto& command : program.commands) {
    if (&command->options().parser() == &chosen) return *command;
  }
  const std::string name = chosen.get_parent() == nullptr ? "" : chosen.get_name() + " ";
  throw Error(ErrorKind::usage, "a subcommand is missing; see adasplats " + name + "--help");
}

void run_command(Program& program, Command& command) {
  const CommonOptions& common = command.common();
  if (!common.config.empty()) apply_config(common.config, program.app, command.options().parser());
  command.check_required();
  command.check_outputs();
  if (!common.report.empty()) check_output_file(common.report);
  ProgressBar bar;
  ProgressMeter progress(bar);
  const Executor executor(common.threads, throw_if_interrupted, &progress);
  nlohmann::ordered_json report;
  DeviceChoice device;
  if (command.device()) device = choose_device(*command.device());
  Session session{{executor, progress, common.seed, device}, bar, report};
  command.run(session);
  if (!common.report.empty()) write_report(command, session);
}

int run(int argc, char** argv) {
  install_signal_handlers();
  Program program;
  try {
    program.app.parse(reversed_arguments(argc, argv));
  } catch (const CLI::CallForHelp&) {
    program.mark_required();
    print(help_text(command_entry(chosen_app(program.app)), HelpLength::short_help));
    return 0;
  } catch (const CLI::CallForAllHelp&) {
    program.mark_required();
    print(help_text(command_entry(chosen_app(program.app)), HelpLength::all));
    return 0;
  } catch (const CLI::CallForVersion& version) {
    print(std::string(version.what()) + "\n");
    return 0;
  }
  CLI::App& chosen = chosen_app(program.app);
  check_extras(program.app, chosen);
  program.mark_required();
  run_command(program, find_command(program, chosen));
  return 0;
}

int failed(int code, const std::string& message) {
  print_message("error: " + with_settings_as_options(message));
  return code;
}

/// The parser's "Could not convert: --cell = abc" as "--cell = abc: the value has the wrong type".
std::string conversion_message(const CLI::ConversionError& error) {
  constexpr std::string_view kPrefix = "Could not convert: ";
  std::string message = error.what();
  if (!message.starts_with(kPrefix)) return message;
  return message.substr(kPrefix.size()) + ": the value has the wrong type (see --help)";
}

/// Every way in which a run can end.
int guarded_run(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Interrupted& interrupted) {
    print_message("interrupted");
    return kExitSignal + interrupted.signal;
  } catch (const ClosedStdout&) {
    return kExitSignal + kSigPipe;
  } catch (const Error& error) {
    return failed(exit_code(error.kind()), error.what());
  } catch (const CLI::ConversionError& error) {
    return failed(exit_code(ErrorKind::usage), conversion_message(error));
  } catch (const CLI::ParseError& error) {
    return failed(exit_code(ErrorKind::usage), error.what());
  } catch (const std::bad_alloc&) {
    return failed(kExitNoMemory, "not enough memory");
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(exit_code(ErrorKind::io), error.what());
  } catch (const std::exception& error) {
    return failed(exit_code(ErrorKind::software),
                  std::string(error.what()) + " (a bug in adasplats; please report it)");
  }
}

std::terminate_handler default_terminate = nullptr;

[[noreturn]] void end_without_memory() {
  constexpr std::string_view kMessage = "adasplats: error: not enough memory\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(kExitNoMemory);
}

/// Memory can also run out where no exception may escape, such as in a library's destructor.
[[noreturn]] void terminate() {
  static std::atomic_flag entered;
  if (entered.test_and_set()) end_without_memory();  // rethrowing needs memory, too
  try {
    if (const std::exception_ptr failure = std::current_exception())
      std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    end_without_memory();
  } catch (...) {  // a bug
  }
  default_terminate();
  std::abort();
}

}  // namespace
}  // namespace adasplats::app

int main(int argc, char** argv) {
  adasplats::app::default_terminate = std::set_terminate(adasplats::app::terminate);
  return adasplats::app::guarded_run(argc, argv);
}
