// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "cli/options/option_set.h"

namespace adasplats::app {

/// What every subcommand understands.
struct CommonOptions {
  int threads = 0;
  std::uint64_t seed = 1;
  std::filesystem::path report;
  std::filesystem::path config;
};

void add_common_options(OptionSet& app, CommonOptions& options);

}  // namespace adasplats::app
