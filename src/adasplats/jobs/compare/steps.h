// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// One command of adasplats, run as a child of its own.
struct Step {
  std::string name;                            ///< of the files that keep its result
  std::vector<std::string> arguments;          ///< of the program, without --report
  std::vector<std::filesystem::path> inputs;   ///< done again where one of them changes
  std::vector<std::filesystem::path> outputs;  ///< done again where one is not there
  std::string device = {};                     ///< done again where it is another one
};

struct StepResult {
  ChildResult child;
  nlohmann::ordered_json report;   ///< what --report wrote; null where it failed
  std::string command;             ///< as a user would type it
  nlohmann::ordered_json made_by;  ///< "version", "commit" and "dirty" of the program, "date"
  bool done() const { return child.end == ChildEnd::done; }
};

/// The program that runs the steps: the one that is named, else adasplats on PATH. Errors:
/// no_input.
std::filesystem::path program_of(const std::filesystem::path& named);

/// "version", "commit" and "dirty" of a program, which it gives in a report in `folder`. Errors:
/// no_input (it cannot be started), usage (it is not adasplats of our version).
nlohmann::ordered_json build_of_program(const std::filesystem::path& program,
                                        const std::filesystem::path& folder,
                                        ProgressSink& progress);

/// How all steps are run.
struct StepRules {
  std::filesystem::path program;
  nlohmann::ordered_json made_by;  ///< build_of_program()
  ChildLimits limits;
  bool retry = false;                              ///< also those that have failed before
  std::vector<std::string> common_arguments = {};  ///< --threads and --seed, where they are given
};

/// Runs steps and remembers in `folder` what has been done: NAME.json with a key of the command,
/// the program and the inputs' sizes and times, NAME.log with the output. A step whose key is the
/// same is not run again; one that failed is, where the limit that ended it is now higher or
/// `retry` is set.
class StepRunner {
 public:
  /// `progress` hears of every step that is run: "basic: generate".
  StepRunner(std::filesystem::path folder, StepRules rules, ProgressSink& progress);

  StepResult run(const Step& step) const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  StepRules rules_;
  ProgressSink& progress_;
};

/// "done", "failed", "timeout", "out of memory".
std::string end_name(ChildEnd end);

}  // namespace adasplats
