// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace adasplats {

/// A GPU that CUDA can use.
struct GpuDevice {
  int index = 0;  ///< CUDA's number of it, in this process
  std::string name;
  int compute_major = 0;  ///< compute capability
  int compute_minor = 0;
  std::size_t memory_bytes = 0;
};

/// What a search for GPUs found.
struct GpuSearch {
  std::vector<GpuDevice> devices;
  std::string driver;  ///< highest CUDA version that the driver supports, "13.0"; empty: no driver
  std::string reason;  ///< where there are none: why, and what to do about it
};

/// Looks for GPUs. Never throws and changes nothing: on a machine without a GPU, with an old driver
/// or in a build without CUDA it says so in `reason`.
GpuSearch find_gpus();

/// Free memory of a GPU, bytes; 0 if CUDA does not report it. Starts CUDA on the GPU, which takes
/// a while and some memory.
std::size_t free_memory_bytes(int device);

/// Whether this build has CUDA code.
bool built_with_cuda();

}  // namespace adasplats
