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

/// Who computes.
enum class DeviceKind : std::uint8_t {
  automatic,  ///< cuda where there is a GPU, else cpu
  cpu,
  cuda,
  optix,  ///< rays are cast with OptiX; all else as cuda
};

/// auto, cpu, cuda and optix.
std::span<const std::pair<std::string_view, DeviceKind>> device_words();
std::string device_word(DeviceKind kind);

/// What a user says of the device.
struct DeviceOptions {
  DeviceKind kind = DeviceKind::automatic;
  std::vector<int> gpus;  ///< CUDA's numbers; empty: the first one
  bool all_gpus = false;
};

/// What a run computes on.
struct DeviceChoice {
  DeviceKind kind = DeviceKind::cpu;  ///< never automatic
  bool is_automatic = false;          ///< nobody asked for it: the CPU will do as well
  std::vector<GpuDevice> gpus;        ///< at least one where it is not the CPU
  std::string driver;                 ///< CUDA version that the driver supports; empty: none
  std::string reason;                 ///< where auto came to the CPU: why

  bool on_gpu() const { return kind != DeviceKind::cpu; }
  /// CUDA's numbers of the GPUs.
  std::vector<int> gpu_numbers() const;
};

/// Looks for what the options name. Errors: usage (GPUs by number with the CPU, or a number that no
/// GPU has), unavailable (cuda, optix or GPUs by number are asked for and there is no GPU), with
/// what helps.
DeviceChoice choose_device(const DeviceOptions& options);

/// Does `work` where a GPU is chosen, and says whether it was done; false: it is the CPU's. Where a
/// GPU that nobody asked for fails (not enough memory, say), warns and chooses the CPU from then
/// on; the failure of one that was asked for is the caller's.
bool try_on_gpu(DeviceChoice& device, ProgressSink& progress, FunctionRef<void()> work);

/// Names of the GPUs with commas between them.
std::string names_of(const std::vector<GpuDevice>& gpus);

/// One key a choice, for what was computed on another one.
std::string device_key(const DeviceChoice& device);

}  // namespace adasplats
