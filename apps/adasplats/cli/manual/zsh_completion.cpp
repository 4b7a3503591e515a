// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/manual/manual.h"

namespace adasplats::app {
namespace {

constexpr const char* kZshBegin =
    R"(#compdef adasplats
# Completion of adasplats in zsh, printed by: adasplats completion zsh
)";

// A file of $fpath is the function itself; one that is sourced defines it.
constexpr const char* kZshEnd = R"(
if [[ $funcstack[1] == _adasplats ]]; then
  _adasplats "$@"
else
  compdef _adasplats adasplats
fi
)";

/// Text for the inside of '[explanation]' or 'name:explanation' between single quotes.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
      continue;
    }
    if (c == '\\' || c == '[' || c == ']' || c == ':') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// ":TYPE:ACTION" of a value.
std::string zsh_value(const OptionEntry& option) {
  std::string action = " ";
  if (!option.words.empty()) action = "(" + joined(option.words, " ") + ")";
  if (option.takes_files) action = "_files";
  return ":" + zsh_text(option.type) + ":" + action;
}

/// The specification of an option for _arguments, as words of the shell.
std::string zsh_option(const OptionEntry& option) {
  if (option.is_positional) {
    const std::string place = option.takes_more ? "*" : "";
    return "'" + place + ":" + zsh_text(option.names.front()) +
           zsh_value(option).substr(zsh_value(option).rfind(':')) + "'";
  }
  const std::string what =
      "[" + zsh_text(option.description) + "]" + (option.takes_value ? zsh_value(option) : "");
  const std::string names = joined(option.names, " ");
  std::string text;
  for (const std::string& name : option.names) {
    const bool has_equals = option.takes_value && name.starts_with("--");
    text += (text.empty() ? "'" : " \\\n    '") +
            (option.takes_more ? std::string("*") : "(" + names + ")") + name +
            (has_equals ? "=" : "") + what + "'";
  }
  return text;
}

std::string zsh_function(const std::vector<std::string>& path) {
  std::string name = "_adasplats";
  for (const std::string& word : path) name += "_" + word;
  return name;
}

/// The function that completes behind a command.
std::string zsh_command(const CommandEntry& command) {
  std::string text = "\n" + zsh_function(command.path) + "() {\n";
  if (!command.parts.empty()) {
    text += "  local -a commands=(\n";
    for (const CommandEntry& part : command.parts)
      text += "    '" + part.path.back() + ":" + zsh_text(part.description) + "'\n";
    text += "  )\n  local state line\n";
  }
  text += "  _arguments -S";
  if (!command.parts.empty()) text += " -C";
  for (const OptionEntry& option : command.options) {
    if (option.is_positional && !command.parts.empty()) continue;
    text += " \\\n    " + zsh_option(option);
  }
  if (command.parts.empty()) return text + "\n}\n";
  return text +
         " \\\n    '1: :->command' '*:: :->rest'\n"
         "  case $state in\n"
         "    command) _describe command commands ;;\n"
         "    rest) (( $+functions[" +
         zsh_function(command.path) + "_$words[1]] )) && " + zsh_function(command.path) +
         "_$words[1] ;;\n"
         "  esac\n}\n";
}

}  // namespace

std::string zsh_completion(const CommandEntry& program) {
  std::string text = kZshBegin;
  for_each_command(program, [&](const CommandEntry& command) { text += zsh_command(command); });
  return text + kZshEnd;
}

}  // namespace adasplats::app
