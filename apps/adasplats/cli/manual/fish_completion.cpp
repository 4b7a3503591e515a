// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/manual/manual.h"

namespace adasplats::app {
namespace {

constexpr const char* kFishBegin =
    R"(# Completion of adasplats in fish, printed by: adasplats completion fish

# The command so far: "evaluate c2c".
function __adasplats_command
  set -l path
  for word in (commandline -opc)[2..]
    switch "$path $word"
      case )";

constexpr const char* kFishPath = R"(
        set -a path $word
    end
  end
  echo "$path"
end

function __adasplats_at
  set -l path (__adasplats_command)
  test "$path" = "$argv"
end

complete -c adasplats -f
)";

std::string fish_text(const std::string& text) {
  std::string escaped = "'";
  for (const char c : text) {
    if (c == '\\' || c == '\'') escaped += '\\';
    escaped += c;
  }
  return escaped + "'";
}

/// The part of `complete` for a value.
std::string fish_value(const OptionEntry& option) {
  std::string text;
  if (!option.words.empty()) text += " -a '" + joined(option.words, " ") + "'";
  return text + (option.takes_files ? " -F" : "");
}

std::string fish_option(const OptionEntry& option, const std::string& begin) {
  if (option.is_positional) {
    const std::string value = fish_value(option);
    return value.empty() ? "" : begin + value + "\n";
  }
  std::string text = begin;
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (option.takes_value) text += " -r" + fish_value(option);
  return text + " -d " + fish_text(option.description) + "\n";
}

}  // namespace

std::string fish_completion(const CommandEntry& program) {
  std::string paths;
  std::string lines;
  for_each_command(program, [&](const CommandEntry& command) {
    const std::string begin = "complete -c adasplats -n '__adasplats_at " + command.joined_path();
    const std::string at = begin.substr(0, begin.find_last_not_of(' ') + 1) + "'";
    for (const CommandEntry& part : command.parts) {
      paths += (paths.empty() ? "'" : " \\\n        '") + command.joined_path() + " " +
               part.path.back() + "'";
      lines += at + " -a " + part.path.back() + " -d " + fish_text(part.description) + "\n";
    }
    for (const OptionEntry& option : command.options) lines += fish_option(option, at);
  });
  return kFishBegin + paths + kFishPath + lines;
}

}  // namespace adasplats::app
