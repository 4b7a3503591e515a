// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/command_entry.h"

#include <algorithm>
#include <sstream>

#include "cli/options/option_set.h"

namespace adasplats::app {
namespace {

bool is_literal(const std::string& word) {
  return !word.empty() && std::ranges::all_of(word, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

/// The lower-case words of a type: "auto" and "cpu" of "auto|cpu", "all" of "LIST|all".
std::vector<std::string> words_of_type(const std::string& type) {
  std::vector<std::string> words;
  std::istringstream parts(type);
  for (std::string word; std::getline(parts, word, '|');)
    if (is_literal(word)) words.push_back(word);
  return words;
}

OptionEntry option_entry(const CLI::Option& option) {
  OptionEntry entry;
  entry.names = names_of(option);
  entry.heading = option.get_group();
  entry.type = option.get_type_name();
  entry.initial = option.get_default_str();
  entry.description = option.get_description();
  entry.words = words_of_type(entry.type);
  entry.is_positional = option.get_positional();
  entry.is_required = option.get_required();
  entry.is_basic = entry.is_positional || entry.is_required || is_basic(option);
  entry.takes_value = option.get_items_expected_max() > 0;
  entry.takes_files = names_files(option);
  entry.takes_more = option.get_items_expected_max() > 1 ||
                     option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return entry;
}

/// The names alone of a command and of its subcommands, after the words `before`.
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

std::string CommandEntry::joined_path() const { return joined(path, " "); }

CommandEntry command_entry(const CLI::App& app) {
  CommandEntry entry;
  for (const CLI::App* part = &app; part->get_parent() != nullptr; part = part->get_parent())
    entry.path.insert(entry.path.begin(), part->get_name());
  entry.description = app.get_description();
  entry.examples = app.get_footer();
  for (const CLI::Option* option : app.get_options())
    entry.options.push_back(option_entry(*option));
  for (const CLI::App* part : app.get_subcommands({})) entry.parts.push_back(command_entry(*part));
  return entry;
}

CommandEntry entry_for_completion(const CLI::App& program) {
  CommandEntry entry = command_entry(program);
  const std::vector<CommandEntry> commands = entry.parts;
  for (CommandEntry& command : entry.parts) {
    if (!takes_commands(command)) continue;
    for (const CommandEntry& named : commands)
      command.parts.push_back(bare_entry(named, command.path));
  }
  return entry;
}

void for_each_command(const CommandEntry& entry,
                      const std::function<void(const CommandEntry&)>& visit) {
  visit(entry);
  for (const CommandEntry& part : entry.parts) for_each_command(part, visit);
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool names_files(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.find("PATH") != std::string::npos || type.find("FILE") != std::string::npos ||
         type.find("SCHEME") != std::string::npos;
}

}  // namespace adasplats::app
