// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/progress.h"

namespace adasplats {

/// Private to baselines/. Runs a program, with its output in `log`; returns its peak memory in
/// bytes. OpenMP programs use `threads` threads, which sleep while they wait. The program is killed
/// if `progress` throws to cancel or if this process is killed. Errors: unavailable (it does not
/// start or fails; with the last line of its output).
std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress);

}  // namespace adasplats
