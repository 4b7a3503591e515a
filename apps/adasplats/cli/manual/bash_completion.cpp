// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/manual/manual.h"

namespace adasplats::app {
namespace {

constexpr const char* kBashBegin =
    R"(# Completion of adasplats in bash, printed by: adasplats completion bash
_adasplats() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  # Bash makes three words of --option=value.
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  # The command so far: "evaluate c2c".
  local command='' word
  for word in "${COMP_WORDS[@]:1:COMP_CWORD - 1}"; do
    case "$command $word" in
)";

constexpr const char* kBashEnd = R"(  esac
  if [[ -z $value && $current == -* ]]; then
    words=$options
    files=
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [[ $files ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
    # The shell itself completes words in quotes.
    [[ ${#COMPREPLY[@]} != 0 ]] || compopt -o default 2>/dev/null
  fi
}
complete -F _adasplats adasplats
)";

/// "words='a b' files=1": what completes a value.
std::string bash_value(const std::vector<std::string>& words, bool files) {
  return "words='" + joined(words, " ") + "' files=" + (files ? "1" : "");
}

/// A `case` over the option before the cursor; options that are completed in one way share a line.
std::string bash_values(const CommandEntry& command) {
  std::vector<std::pair<std::string, std::vector<std::string>>> lines;
  for (const OptionEntry& option : command.options) {
    if (option.is_positional || !option.takes_value) continue;
    const std::string value = bash_value(option.words, option.takes_files);
    auto line = std::ranges::find(lines, value, [](const auto& each) { return each.first; });
    if (line == lines.end()) line = lines.insert(lines.end(), {value, {}});
    line->second.insert(line->second.end(), option.names.begin(), option.names.end());
  }
  if (lines.empty()) return "";
  std::string text = "      case $previous in\n";
  for (const auto& [value, names] : lines)
    text += "        " + joined(names, " | ") + ") value=1 " + value + " ;;\n";
  return text + "      esac\n";
}

/// The lines of a `case` that complete behind a command.
std::string bash_command(const CommandEntry& command) {
  std::vector<std::string> options;
  std::vector<std::string> words;
  bool files = false;
  for (const OptionEntry& option : command.options) {
    if (option.is_positional) {
      words.insert(words.end(), option.words.begin(), option.words.end());
      files = files || option.takes_files;
    } else {
      options.insert(options.end(), option.names.begin(), option.names.end());
    }
  }
  for (const CommandEntry& part : command.parts) words.push_back(part.path.back());
  return "    '" + command.joined_path() + "')\n      options='" + joined(options, " ") + "' " +
         bash_value(words, files) + "\n" + bash_values(command) + "      ;;\n";
}

}  // namespace

std::string bash_completion(const CommandEntry& program) {
  std::string paths;
  std::string cases;
  for_each_command(program, [&](const CommandEntry& command) {
    cases += bash_command(command);
    if (command.path.empty()) return;
    paths += std::string(paths.empty() ? "      " : " | \\\n        ") + "'" +
             joined(command.above(), " ") + " " + command.path.back() + "'";
  });
  return kBashBegin + paths +
         ") command=\"${command:+$command }$word\" ;;\n    esac\n  done\n"
         "  local options='' words='' files='' value=''\n  case $command in\n" +
         cases + kBashEnd;
}

}  // namespace adasplats::app
