// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/progress.h"

// Runs other programs.
namespace adasplats {

/// The first executable file of that name in the folders of PATH.
std::optional<std::filesystem::path> find_on_path(const std::string& name);

/// A program of that name in the folder of the running program.
std::optional<std::filesystem::path> find_next_to_program(const std::string& name);

/// Limits of a child and all processes that it starts.
struct ChildLimits {
  double seconds = 3600;
  std::uint64_t memory_bytes = 0;  ///< resident; 0: no limit
};

struct ChildProgram {
  std::vector<std::string> arguments;      ///< the first is the program's file
  std::vector<std::string> environment;    ///< "NAME=VALUE", overrides this process's
  std::filesystem::path log;               ///< of stdout and stderr
  std::optional<ChildLimits> limits = {};  ///< limits make it a process group
};

/// Exit code of a program that cannot be started, as in shells.
inline constexpr int kCannotStart = 127;

enum class ChildEnd { done, failed, timeout, out_of_memory };

struct ChildResult {
  ChildEnd end = ChildEnd::failed;
  int exit_code = 0;       ///< as in shells: 128 + the number of a signal
  bool signalled = false;  ///< ended by a signal, but not by a limit
  double seconds = 0;
  /// Of the child; with limits the largest observed sum over the child and its children.
  std::uint64_t peak_memory_bytes = 0;
  /// The last line of its output, or the limit or signal that ended it; empty on success.
  std::string message;
};

/// Runs a program to its end. Kills it (with limits: its process group) if a limit is exceeded, if
/// `progress`, which is called repeatedly, throws to cancel, and if this process is killed.
/// Errors: unavailable (no new process), cannot_create (the log).
ChildResult run_child(const ChildProgram& child, ProgressSink& progress);

}  // namespace adasplats
