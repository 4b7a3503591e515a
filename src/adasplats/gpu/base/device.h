// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace adasplats {

/// A GPU that CUDA can use.
struct GpuDevice {
  int index = 0;  ///< CUDA device number in this process
  std::string name;
  int compute_major = 0;  ///< compute capability
  int compute_minor = 0;
  std::size_t memory_bytes = 0;
};

/// Result of a search for GPUs.
struct GpuSearch {
  std::vector<GpuDevice> devices;
  std::string driver;  ///< highest CUDA version that the driver supports, "13.0"; empty: no driver
  std::string reason;  ///< why there are none, and the remedy; empty if there are GPUs
};

/// Searches for GPUs. Never throws and changes nothing; without a GPU, with an old driver or in a
/// build without CUDA, `reason` explains it.
GpuSearch find_gpus();

/// Free memory of a GPU, bytes; 0 if CUDA does not report it. Starts CUDA on the GPU, which takes
/// a while and some memory.
std::size_t free_memory_bytes(int device);

/// Limits the memory of a GPU that this process takes, without what CUDA itself needs (about half a
/// gigabyte); 0: no limit. What exceeds it fails as if the GPU had no more.
void limit_gpu_memory(int device, std::size_t bytes);
/// 0 without a limit.
std::size_t gpu_memory_limit(int device);
/// What can still be taken: as free_memory_bytes(), within the limit.
std::size_t usable_gpu_memory(int device);
/// Most memory of a GPU that this process has taken at a time, without what CUDA itself needs.
std::size_t peak_gpu_memory(int device);

/// Whether this build has CUDA code.
bool built_with_cuda();

}  // namespace adasplats
