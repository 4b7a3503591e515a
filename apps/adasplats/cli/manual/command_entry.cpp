// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/manual/command_entry.h"

#include <algorithm>

namespace adasplats::app {
namespace {

OptionEntry option_entry(const CLI::Option& option, const std::string& heading) {
  OptionEntry entry;
  entry.names = names_of(option);
  entry.heading = heading;
  entry.type = option.get_type_name();
  entry.initial = option.get_default_str();
  entry.description = option.get_description();
  entry.words = words_of_value(option);
  entry.is_positional = option.get_positional();
  entry.is_required = option.get_required();
  entry.takes_value = option.get_items_expected_max() > 0;
  entry.takes_files = names_files(option);
  entry.takes_more = option.get_items_expected_max() > 1 ||
                     option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return entry;
}

/// Adds the options of a command and of its groups, which have headings of their own.
void add_options(const CLI::App& app, const std::string& group, std::vector<OptionEntry>& options) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // CLI11's way to hide one
    options.push_back(option_entry(*option, group.empty() ? option->get_group() : group));
  }
  const auto is_group = [](const CLI::App* part) { return part->get_name().empty(); };
  for (const CLI::App* part : app.get_subcommands(is_group))
    add_options(*part, part->get_group(), options);
}

/// The names alone of a command and of those below it, behind the words `before`.
CommandEntry bare_entry(const CommandEntry& entry, std::vector<std::string> before) {
  CommandEntry bare;
  before.insert(before.end(), entry.path.begin(), entry.path.end());
  bare.path = before;
  bare.description = entry.description;
  before.resize(before.size() - entry.path.size());
  for (const CommandEntry& part : entry.parts) bare.parts.push_back(bare_entry(part, before));
  return bare;
}

bool takes_commands(const CommandEntry& entry) {
  return std::ranges::any_of(entry.options,
                             [](const OptionEntry& option) { return option.type == kCommandType; });
}

}  // namespace

CommandEntry command_entry(const CLI::App& app) {
  CommandEntry entry;
  for (const CLI::App* part = &app; part->get_parent() != nullptr; part = part->get_parent())
    entry.path.insert(entry.path.begin(), part->get_name());
  entry.description = app.get_description();
  entry.examples = app.get_footer();
  add_options(app, "", entry.options);
  const auto is_command = [](const CLI::App* part) { return !part->get_name().empty(); };
  for (const CLI::App* part : app.get_subcommands(is_command))
    entry.parts.push_back(command_entry(*part));
  return entry;
}

CommandEntry entry_for_completion(const CLI::App& program) {
  CommandEntry whole = command_entry(program);
  const std::vector<CommandEntry> commands = whole.parts;
  for (CommandEntry& command : whole.parts) {
    if (!takes_commands(command)) continue;
    for (const CommandEntry& named : commands)
      command.parts.push_back(bare_entry(named, command.path));
  }
  return whole;
}

void for_each_command(const CommandEntry& entry,
                      const std::function<void(const CommandEntry&)>& visit) {
  visit(entry);
  for (const CommandEntry& part : entry.parts) for_each_command(part, visit);
}

}  // namespace adasplats::app
