// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace adasplats::app {

/// The commands of the tasks that a command given with --plan leaves to be done: the same command,
/// for one part of the work each.
class TaskLines {
 public:
  /// `words`: the command as it was given (own_arguments()), --plan among them. Errors: usage
  /// (--plan is not: it came from a configuration, which the tasks would read, too).
  /// `has_value`: --plan takes one.
  TaskLines(const std::vector<std::string>& words, bool has_value);

  /// "adasplats model --only-tile x3_y-2 ...", a line for a shell.
  std::string task(const std::string& option, const std::string& value) const;
  /// The command that finishes when all tasks are done, as a comment for a shell.
  std::string last() const;

 private:
  std::vector<std::string> words_;     ///< without --plan
  std::vector<std::string> for_task_;  ///< without --report, too: tasks would write one file
};

}  // namespace adasplats::app
