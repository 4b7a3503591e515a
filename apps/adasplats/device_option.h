// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

#include "adasplats/pipeline/device_choice.h"

namespace adasplats::app {

/// How many GPUs a subcommand can use.
enum class GpuCount : std::uint8_t { one, several };

/// Adds --device, and --gpus where several can be used.
void add_device_options(CLI::App& app, DeviceOptions& options, GpuCount count);

}  // namespace adasplats::app
