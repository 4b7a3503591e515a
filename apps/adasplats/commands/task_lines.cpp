// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/task_lines.h"

#include <cstddef>

#include "adasplats/core/error.h"
#include "adasplats/jobs/provenance/provenance.h"

namespace adasplats::app {
namespace {

/// Removes an option; `with_value`: and the next word, unless the value follows "=".
std::vector<std::string> without(const std::vector<std::string>& words, const std::string& option,
                                 bool with_value) {
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == option)
      k += with_value ? 1 : 0;
    else if (!words[k].starts_with(option + "="))
      kept.push_back(words[k]);
  }
  return kept;
}

}  // namespace

TaskLines::TaskLines(const std::vector<std::string>& words, bool has_value)
    : words_(without(words, "--plan", has_value)), for_task_(without(words_, "--report", true)) {
  if (words_.size() == words.size() || words_.empty())
    throw Error(ErrorKind::usage,
                "`plan` must be given on the command line, not in a configuration");
}

std::string TaskLines::task(const std::string& option, const std::string& value) const {
  // Directly after the subcommand: the last words may follow "--".
  std::vector<std::string> words = for_task_;
  words.insert(words.begin() + 1, {option, value});
  return command_text(words) + "\n";
}

std::string TaskLines::last() const {
  return "# when all are done: " + command_text(words_) + "\n";
}

}  // namespace adasplats::app
