// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "cli/manual/manual.h"

namespace adasplats::app {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kIndent = 30;
/// A command with so few options of its own shows all of them in the short help.
constexpr std::size_t kFewOptions = 12;
constexpr int kShortExamples = 3;

/// "  NAME TYPE       description", wrapped to the right of the names.
std::string line_of(const std::string& left, const std::string& right) {
  std::string text = "  " + left;
  if (text.size() + 2 > kIndent) text += "\n";
  text.append(kIndent - (text.back() == '\n' ? 0 : text.size()), ' ');
  return text + wrapped(right, kIndent) + "\n";
}

std::string names_and_type(const OptionEntry& option) {
  std::string text = joined(option.names, ", ");
  if (option.takes_value && !option.is_positional) text += " " + option.type;
  if (option.takes_value && option.takes_more) text += " ...";
  return text;
}

std::string description_of(const OptionEntry& option) {
  std::string text = option.description;
  if (option.takes_value && !option.initial.empty()) text += " (default: " + option.initial + ")";
  if (!option.takes_value && option.initial == "true") text += " (default: on)";
  return option.is_required && !option.is_positional ? text + " (required)" : text;
}

std::string usage_of(const CommandEntry& command) {
  std::string text = "Usage: adasplats";
  for (const std::string& word : command.path) text += " " + word;
  text += " [OPTIONS]";
  for (const OptionEntry& option : command.options) {
    if (!option.is_positional) continue;
    const std::string name = option.names.front() + (option.takes_more ? " ..." : "");
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return text + (command.parts.empty() ? "" : " COMMAND") + "\n";
}

bool asks_for_help(const OptionEntry& option) {
  return option.names.back() == "--help" || option.names.back() == "--help-all";
}

bool is_own(const OptionEntry& option) {
  return option.heading != kInputHeading && option.heading != kCommonHeading &&
         !asks_for_help(option);
}

std::vector<OptionEntry> basic_options(const CommandEntry& command) {
  const bool has_few =
      std::ranges::count_if(command.options, is_own) <= static_cast<std::ptrdiff_t>(kFewOptions);
  std::vector<OptionEntry> options;
  for (const OptionEntry& option : command.options) {
    if (!option.is_basic && !(has_few && is_own(option))) continue;
    const std::string& name = option.names.back();
    if (name == "--help-all" || (name == "--version" && !command.path.empty())) continue;
    options.push_back(option);
    if (!option.is_positional) options.back().heading = kOptionsHeading;
    if (name != "--help") continue;
    options.back().names.push_back("--help-all");
    options.back().description = "Print these options, or all, and exit";
  }
  return options;
}

/// Each heading in the order in which it first occurs, with its options.
std::string sections_of(const std::vector<OptionEntry>& options) {
  std::vector<std::pair<std::string, std::vector<OptionEntry>>> sections;
  for (const OptionEntry& option : options) {
    const std::string heading = option.is_positional ? "Arguments" : option.heading;
    auto section =
        std::ranges::find(sections, heading, [](const auto& each) { return each.first; });
    if (section == sections.end()) section = sections.insert(section, {heading, {}});
    section->second.push_back(option);
  }
  std::string text;
  for (const auto& [heading, members] : sections)
    text += "\n" + heading + ":\n" + options_text(members);
  return text;
}

/// The first examples, without the notes that follow them.
std::string short_examples(const std::string& examples) {
  std::string text;
  std::istringstream lines(examples);
  int commands = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool is_command = line.starts_with("  adasplats ");
    if (is_command && ++commands > kShortExamples) break;
    if (is_command || line.starts_with("  ") || line == "Examples:") text += line + "\n";
  }
  return text;
}

bool has_input_options(const CommandEntry& command) {
  return std::ranges::find(command.options, kInputHeading, &OptionEntry::heading) !=
         command.options.end();
}

/// Where to read on.
std::string last_line(const CommandEntry& command) {
  std::string name = "adasplats ";
  for (const std::string& word : command.path) name += word + " ";
  if (!command.parts.empty())
    return "Help on a command: " + name + "COMMAND --help" +
           (command.path.empty() ? "; on options of input data: adasplats help input\n" : "\n");
  const auto options = std::ranges::count_if(command.options, std::not_fn(asks_for_help));
  const auto basic = basic_options(command);
  if (std::ranges::count_if(basic, std::not_fn(asks_for_help)) == options) return "";
  return "More options: " + name + "--help-all" +
         (has_input_options(command) ? "; input options: adasplats help input\n" : "\n");
}

}  // namespace

std::string wrapped(const std::string& text, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kColumns) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

std::string options_text(const std::vector<OptionEntry>& options) {
  std::string text;
  for (const OptionEntry& option : options)
    text += line_of(names_and_type(option), description_of(option));
  return text;
}

std::string help_text(const CommandEntry& command, HelpLength length) {
  const bool is_short = length == HelpLength::short_help;
  std::string text = wrapped(command.description, 0) + "\n\n" + usage_of(command) +
                     sections_of(is_short ? basic_options(command) : command.options);
  if (!command.parts.empty()) {
    text += "\nCommands:\n";
    for (const CommandEntry& part : command.parts)
      text += line_of(part.path.back(), part.description);
  }
  text += "\n" + (is_short ? short_examples(command.examples) : command.examples);
  if (text.back() != '\n') text += "\n";
  return is_short ? text + last_line(command) : text;
}

}  // namespace adasplats::app
