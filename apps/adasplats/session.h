// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "adasplats/core/executor.h"
#include "device_choice.h"
#include "progress_bar.h"

namespace adasplats::app {

/// What one run of a subcommand works with.
struct Session {
  const Executor& executor;
  ProgressBar& progress;
  std::uint64_t seed;
  DeviceChoice& device;            ///< of scenes and models; the CPU where there is no --device
  nlohmann::ordered_json& report;  ///< keys that the subcommand adds to its --report
};

}  // namespace adasplats::app
