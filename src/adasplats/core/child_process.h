// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/progress.h"

// Programs that do work for us.
namespace adasplats {

/// The first executable file of that name in the folders of PATH.
std::optional<std::filesystem::path> find_on_path(const std::string& name);

/// A program of that name beside the one that runs.
std::optional<std::filesystem::path> find_beside_own(const std::string& name);

/// What a child may use, with all the processes it starts itself.
struct ChildLimits {
  double seconds = 3600;
  std::uint64_t memory_bytes = 0;  ///< resident; 0: no limit
};

struct ChildProgram {
  std::vector<std::string> arguments;      ///< the first is the program's file
  std::vector<std::string> environment;    ///< "NAME=VALUE", in place of what this process has
  std::filesystem::path log;               ///< of stdout and stderr
  std::optional<ChildLimits> limits = {};  ///< with them it is a process group of its own
};

/// Exit code of a program that cannot be started, as shells have it.
inline constexpr int kCannotStart = 127;

enum class ChildEnd { done, failed, timeout, out_of_memory };

struct ChildResult {
  ChildEnd end = ChildEnd::failed;
  int exit_code = 0;       ///< as shells have it: 128 + the number of a signal
  bool signalled = false;  ///< a signal that is no limit's ended it
  double seconds = 0;
  /// The child's, or with limits the largest sum seen over the child and its children.
  std::uint64_t peak_memory_bytes = 0;
  /// The last line of its output, or which limit or signal ended it; empty where it went well.
  std::string message;
};

/// Runs a program to its end. It (with limits: its whole group) is killed where a limit is passed,
/// where `progress`, which hears again and again that it goes on, throws to cancel, and where this
/// process is killed. Errors: unavailable (no new process), cannot_create (the log).
ChildResult run_child(const ChildProgram& child, ProgressSink& progress);

}  // namespace adasplats
