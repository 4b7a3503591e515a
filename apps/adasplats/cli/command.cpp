// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "adasplats/core/error.h"
#include "adasplats/jobs/output/output_check.h"
#include "cli/command_entry.h"

namespace adasplats::app {

namespace fs = std::filesystem;

Command::Command(CLI::App& parent, const std::string& name, const std::string& description,
                 const std::string& examples)
    : options_(*parent.add_subcommand(name, description)) {
  CLI::App& app = options_.parser();
  app.allow_extras();  // so that the program can name the nearest known option
  app.footer("Examples:\n" + examples);
}

std::string Command::full_name() const {
  const CLI::App* app = &options_.parser();
  std::string name = app->get_name();
  for (app = app->get_parent(); app->get_parent() != nullptr; app = app->get_parent()) {
    name = app->get_name() + " " + name;
  }
  return name;
}

void Command::check_required() const {
  for (const Option* required : required_) {
    const CLI::Option& option = required->parser();
    if (option.count() == 0) {
      throw Error(ErrorKind::usage,
                  option.get_name() + " is required; see adasplats " + full_name() + " --help");
    }
  }
}

void Command::reject(std::initializer_list<const char*> names, const std::string& why) const {
  for (const char* name : names) {
    if (is_given(name)) {
      throw Error(ErrorKind::usage, std::string(name) + " has no effect " + why);
    }
  }
}

void Command::mark_required() const {
  for (const Option* option : required_) option->parser().required();
}

void Command::add_common_options() {
  app::add_common_options(options_, common_);
  outputs_.push_back({options_.parser().get_option("--report"), {".json"}});
}

Option* Command::writes(Option* option, std::vector<std::string> endings) {
  outputs_.push_back({&option->parser(), std::move(endings)});
  return option;
}

Option* Command::writes_folder(Option* option) { return writes(option, {}); }

std::vector<fs::path> Command::inputs() const {
  std::vector<fs::path> found;
  for (const CLI::Option* option : options_.parser().get_options()) {
    const bool is_output = std::ranges::any_of(
        outputs_, [option](const Output& output) { return output.option == option; });
    if (is_output || !names_files(*option)) continue;
    for (const std::string& value : option->results()) {
      std::error_code ignored;
      const fs::path path = fs::exists(value, ignored) ? value : value.substr(value.find('=') + 1);
      if (fs::exists(path, ignored)) found.push_back(path);
    }
  }
  return found;
}

void Command::check_outputs() const {
  const std::vector<fs::path> read = inputs();
  for (const auto& [option, endings] : outputs_) {
    if (option->count() == 0) continue;
    const fs::path path = option->as<std::string>();
    if (endings.empty()) {
      require_folder_apart(path, read);
      continue;
    }
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    // Anything but a regular file is rejected later by check_output_file, whatever its name.
    if (!fs::exists(status) || fs::is_regular_file(status)) require_ending(path, endings);
    require_no_input(path, read);
  }
}

std::vector<CLI::Option*> settings_of(CLI::App& app) {
  std::vector<CLI::Option*> settings = app.get_options([](const CLI::Option* option) {
    const auto& names = option->get_lnames();
    return std::none_of(names.begin(), names.end(), [](const std::string& name) {
      return name == "help" || name == "help-all" || name == "version" || name == "config";
    });
  });
  return settings;
}

}  // namespace adasplats::app
