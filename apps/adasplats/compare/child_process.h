// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/progress.h"

namespace adasplats::app {

/// What a child may use, with all the processes it starts itself.
struct ChildLimits {
  double seconds = 3600;
  std::uint64_t memory_bytes = 0;  ///< resident; 0: no limit
};

enum class ChildEnd { done, failed, timeout, out_of_memory };

struct ChildResult {
  ChildEnd end = ChildEnd::failed;
  int exit_code = 0;  ///< as shells have it: 128 + the number of a signal
  double seconds = 0;
  std::uint64_t peak_memory_bytes = 0;  ///< largest sum seen over the child and its children
  /// The last line of its output, or which limit or signal ended it; empty where it went well.
  std::string message;
};

/// Runs a program in a process group of its own, with stdout and stderr in `log`, and ends the
/// whole group where a limit is passed, this process is interrupted (throws Interrupted then) or
/// killed. `progress` hears again and again that it goes on. The first argument is the program's
/// file; one that cannot be started ends with exit code 127. Errors: software (no new process),
/// cannot_create (the log).
ChildResult run_child(const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const std::filesystem::path& log, ProgressSink& progress);

}  // namespace adasplats::app
