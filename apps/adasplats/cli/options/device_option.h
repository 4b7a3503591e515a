// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/jobs/session/device_choice.h"
#include "cli/options/option_set.h"

namespace adasplats::app {

/// How many GPUs a subcommand can use.
enum class GpuCount : std::uint8_t { one, several };

/// Adds --device, and --gpus where several can be used.
void add_device_options(OptionSet& app, DeviceOptions& options, GpuCount count);

}  // namespace adasplats::app
