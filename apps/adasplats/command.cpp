// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "command.h"

#include <algorithm>

#include "adasplats/core/error.h"

namespace adasplats::app {

Command::Command(CLI::App& parent, const std::string& name, const std::string& description,
                 const std::string& examples)
    : app_(parent.add_subcommand(name, description)) {
  app_->allow_extras();  // so that the program can name the nearest known option
  app_->footer("Examples:\n" + examples);
}

std::string Command::full_name() const {
  std::string name = app_->get_name();
  for (const CLI::App* app = app_->get_parent(); app->get_parent() != nullptr;
       app = app->get_parent()) {
    name = app->get_name() + " " + name;
  }
  return name;
}

void Command::check_required() const {
  for (const CLI::Option* option : required_) {
    if (option->count() == 0) {
      throw Error(ErrorKind::usage,
                  option->get_name() + " is missing; see adasplats " + full_name() + " --help");
    }
  }
}

void Command::mark_required() const {
  for (CLI::Option* option : required_) option->required();
}

std::vector<CLI::Option*> settings_of(CLI::App& app) {
  std::vector<CLI::Option*> settings = app.get_options([](const CLI::Option* option) {
    const auto& names = option->get_lnames();
    return std::none_of(names.begin(), names.end(), [](const std::string& name) {
      return name == "help" || name == "version" || name == "config";
    });
  });
  return settings;
}

}  // namespace adasplats::app
