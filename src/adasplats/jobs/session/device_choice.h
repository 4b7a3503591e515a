// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/function_ref.h"
#include "adasplats/core/progress.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats {

/// The device that computes.
enum class DeviceKind : std::uint8_t {
  automatic,  ///< cuda if there is a GPU, else cpu
  cpu,
  cuda,
  optix,  ///< casts rays with OptiX; everything else as cuda
};

/// auto, cpu, cuda and optix.
std::span<const std::pair<std::string_view, DeviceKind>> device_words();
std::string device_word(DeviceKind kind);

/// The device as users choose it.
struct DeviceOptions {
  DeviceKind kind = DeviceKind::automatic;
  std::vector<int> gpus;  ///< by CUDA's numbers; empty: the first one
  bool all_gpus = false;
  double memory_gb = 0;  ///< that each GPU may give, 10^9 bytes; 0: all that it has
};

/// The device of a run.
struct DeviceChoice {
  DeviceKind kind = DeviceKind::cpu;  ///< never automatic
  bool is_automatic = false;          ///< not requested by the user: the CPU may replace it
  std::vector<GpuDevice> gpus;        ///< at least one unless `kind` is cpu
  std::string driver;                 ///< CUDA version that the driver supports; empty: no driver
  std::string reason;                 ///< why automatic chose the CPU; else empty

  bool on_gpu() const { return kind != DeviceKind::cpu; }
  /// The GPUs by CUDA's numbers.
  std::vector<int> gpu_numbers() const;
};

/// Finds the devices that the options name. Errors: usage (GPU numbers together with the CPU, or a
/// number that no GPU has), unavailable (cuda, optix or GPU numbers without a GPU), with a remedy.
DeviceChoice choose_device(const DeviceOptions& options);

/// Runs `work` if a GPU is chosen. Returns whether it was done; if not, the CPU has to do it. If a
/// GPU that the user did not request fails (out of memory, for example), warns and chooses the CPU
/// from then on; the failure of a requested GPU is thrown.
bool try_on_gpu(DeviceChoice& device, ProgressSink& progress, FunctionRef<void()> work);

/// Names of the GPUs, separated by commas.
std::string names_of(const std::vector<GpuDevice>& gpus);

/// A key for each choice; different devices have different keys.
std::string device_key(const DeviceChoice& device);

}  // namespace adasplats
