// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace adasplats::app {

/// The commands of the tasks that --plan prints: the same command, each for one part of the work.
class TaskLines {
 public:
  /// `words`: the command line (own_arguments()) with --plan. `has_value`: --plan has a value.
  /// Errors: usage (no --plan: it came from a configuration, which the tasks would read, too).
  TaskLines(const std::vector<std::string>& words, bool has_value);

  /// "adasplats model --only-tile x3_y-2 ...", a line for a shell.
  std::string task(const std::string& option, const std::string& value) const;
  /// The command that finishes when all tasks are done, as a comment for a shell.
  std::string last() const;

 private:
  std::vector<std::string> words_;     ///< without --plan
  std::vector<std::string> for_task_;  ///< also without --report: tasks would overwrite one file
};

}  // namespace adasplats::app
