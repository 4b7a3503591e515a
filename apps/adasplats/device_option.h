// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace adasplats::app {

/// Who computes.
enum class DeviceKind : std::uint8_t {
  automatic,  ///< cuda where there is a GPU, else cpu
  cpu,
  cuda,
  optix,  ///< rays are cast with OptiX; all else as cuda
};

/// What a user says of the device.
struct DeviceOptions {
  DeviceKind kind = DeviceKind::automatic;
  std::vector<int> gpus;  ///< CUDA's numbers; empty: the first one
  bool all_gpus = false;
};

/// How many GPUs a subcommand can use.
enum class GpuCount : std::uint8_t { one, several };

/// Adds --device, and --gpus where several can be used.
void add_device_options(CLI::App& app, DeviceOptions& options, GpuCount count);

/// The word of --device.
std::string device_word(DeviceKind kind);

}  // namespace adasplats::app
