// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/config_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "cli/command.h"
#include "cli/options/option_types.h"

namespace adasplats::app {
namespace {

constexpr std::ptrdiff_t kMaxDotsInLine = 1000;

/// One file while it is applied.
struct Source {
  const std::filesystem::path& file;
  CLI::App& program;
  CLI::App& chosen;
  std::map<const CLI::Option*, std::string> given;  ///< options set so far, and their keys
};

Error config_error(const std::filesystem::path& file, toml::source_index line,
                   const std::string& message) {
  return Error(ErrorKind::config, file.string() + ":" + std::to_string(line) + ": " + message);
}

/// Dotted keys make one table a dot, and toml++ destroys tables recursively: a key of a million
/// dots would end in a stack overflow. (Brackets are limited by toml++ itself.)
void reject_deep_keys(const std::filesystem::path& file, const std::string& text) {
  toml::source_index line_number = 1;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    if (std::count(line.begin(), line.end(), '.') > kMaxDotsInLine) {
      throw config_error(file, line_number, "the key is nested too deeply");
    }
    begin = end + 1;
    ++line_number;
  }
}

toml::table parse(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  reject_deep_keys(file, text);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw config_error(file, error.source().begin.line, std::string(error.description()));
  }
}

std::vector<std::string> names_of(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : settings_of(app)) {
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  }
  return names;
}

CLI::Option* find_setting(CLI::App& app, const std::string& name) {
  for (CLI::Option* option : settings_of(app)) {
    if (option->check_lname(name)) return option;
  }
  return nullptr;
}

CLI::App* find_subcommand(CLI::App& app, const std::string& name) {
  for (CLI::App* subcommand : app.get_subcommands({})) {
    if (subcommand->get_name() == name) return subcommand;
  }
  return nullptr;
}

/// A scalar as written on the command line.
std::string scalar_text(const Source& source, const std::string& key, const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return std::to_string(number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* number = node.as_floating_point()) {
    std::array<char, 32> text{};
    const auto [end, failure] =
        std::to_chars(text.data(), text.data() + text.size(), number->get());
    return {text.data(), end};
  }
  throw config_error(source.file, node.source().begin.line,
                     "'" + key + "' must be a string, a number, true or false, or a list of them");
}

/// The values as written on the command line. A list for an option with one value, such as
/// offset = [1, 1, -0.5], becomes that value with commas.
std::vector<std::string> value_texts(const Source& source, const std::string& key,
                                     const toml::node& node, const CLI::Option& option) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return {scalar_text(source, key, node)};
  std::vector<std::string> texts;
  for (const toml::node& item : *list) texts.push_back(scalar_text(source, key, item));
  if (option.get_items_expected_max() > 1) return texts;
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : ",") + text;
  return {joined};
}

void set_option(Source& source, const std::string& key, const toml::node& node,
                CLI::Option& option) {
  const toml::source_index line = node.source().begin.line;
  const auto [before, is_new] = source.given.emplace(&option, key);
  if (!is_new) {
    throw config_error(source.file, line,
                       "'" + key + "' is a duplicate: '" + before->second + "' already sets it");
  }
  std::vector<std::string> values = value_texts(source, key, node, option);
  const bool is_flag = option.get_items_expected_max() == 0;
  if (is_flag && !node.is_boolean()) {
    throw config_error(source.file, line, "'" + key + "' must be true or false");
  }
  if (option.count() > 0 || values.empty()) return;
  try {
    if (is_flag) values = {option.get_flag_value(key, values.front())};
    option.add_result(values);
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    throw config_error(source.file, line, "'" + key + "': " + error.what());
  }
}

void apply_table(Source& source, const toml::table& table, CLI::App& app);

void apply_subtable(Source& source, const std::string& key, const toml::table& table,
                    toml::source_index line, CLI::App& app) {
  CLI::App* subcommand = find_subcommand(app, key);
  if (subcommand == nullptr) {
    std::vector<std::string> known;
    for (const CLI::App* other : app.get_subcommands({})) known.push_back(other->get_name());
    throw config_error(source.file, line, unknown_word("table", key, known));
  }
  apply_table(source, table, *subcommand);
}

/// Keys at the top of the file are for the chosen subcommand, keys of a table for the table's.
void apply_table(Source& source, const toml::table& table, CLI::App& app) {
  CLI::App& target = &app == &source.program ? source.chosen : app;
  for (const auto& [key_node, node] : table) {
    const std::string key(key_node.str());
    const toml::source_index line = key_node.source().begin.line;
    if (const toml::table* subtable = node.as_table()) {
      apply_subtable(source, key, *subtable, line, app);
      continue;
    }
    CLI::Option* option = find_setting(target, key);
    if (option == nullptr) {
      throw config_error(source.file, line, unknown_word("key", key, names_of(target)));
    }
    if (&target == &source.chosen) set_option(source, key, node, *option);
  }
}

}  // namespace

void apply_config(const std::filesystem::path& file, CLI::App& program, CLI::App& chosen) {
  Source source{file, program, chosen, {}};
  const toml::table table = parse(file);
  apply_table(source, table, program);
}

}  // namespace adasplats::app
