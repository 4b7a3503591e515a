// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/progress.h"

namespace adasplats {

/// Private to baselines/. Runs a program to its end, its output in `log`; gives back its largest
/// resident memory in bytes. One that uses OpenMP runs on `threads` threads, which sleep where they
/// wait. It is killed where `progress` throws to cancel, and where this process is killed. Errors:
/// unavailable (it cannot be started or fails; with the last line of its output).
std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress);

}  // namespace adasplats
