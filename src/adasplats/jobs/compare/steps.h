// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// The output folder of a comparison. It grows step by step and is kept after an interruption:
/// OUTPUT/work for the results of steps, OUTPUT/pictures, and a file adasplats.json that identifies
/// it. Locked during the lifetime of the object.
class WorkFolder {
 public:
  /// Errors: cannot_create (not empty and not a comparison, a comparison of data with another
  /// title, or used by another run).
  WorkFolder(const std::filesystem::path& folder, const std::string& title);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::filesystem::path work() const { return folder_ / "work"; }
  std::filesystem::path pictures() const { return folder_ / "pictures"; }

 private:
  std::filesystem::path folder_;
  int lock_ = -1;
};

/// Lets `write` make a new file and replaces `file` only if the bytes differ, so steps that use it
/// need not be run again.
void write_if_changed(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// One command of adasplats, run as a child process.
struct Step {
  std::string name;                            ///< of the files that store its result
  std::vector<std::string> arguments;          ///< of the program, without --report
  std::vector<std::filesystem::path> inputs;   ///< the step is run again if one changes
  std::vector<std::filesystem::path> outputs;  ///< ... or if one is missing
  std::string device = {};                     ///< ... or if it is another one
};

struct StepResult {
  ChildResult child;
  nlohmann::ordered_json report;   ///< the step's --report; null if it failed
  std::string command;             ///< as a user would type it
  nlohmann::ordered_json made_by;  ///< "version", "commit" and "dirty" of the program, "date"
  bool done() const { return child.end == ChildEnd::done; }
};

/// The program that runs the steps: `named`, or adasplats on PATH. Errors: no_input.
std::filesystem::path program_of(const std::filesystem::path& named);

/// "version", "commit" and "dirty" of a program, which writes a report into `folder`. Errors:
/// no_input (it cannot be started), usage (it is not adasplats of our version).
nlohmann::ordered_json build_of_program(const std::filesystem::path& program,
                                        const std::filesystem::path& folder,
                                        ProgressSink& progress);

/// How all steps are run.
struct StepRules {
  std::filesystem::path program;
  nlohmann::ordered_json made_by;  ///< build_of_program()
  ChildLimits limits;
  bool retry = false;                              ///< also run steps that have failed before
  std::vector<std::string> common_arguments = {};  ///< --threads and --seed, if given
};

/// Runs steps and stores their results in `folder`: NAME.json with a key made from the command, the
/// program and the sizes and times of the inputs, NAME.log with the output. A step with the same
/// key is not run again, except one that failed, if the limit that ended it is higher now or
/// `retry` is set.
class StepRunner {
 public:
  /// `progress` is informed of every step that is run: "basic: generate".
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
