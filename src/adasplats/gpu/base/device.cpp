// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/device.h"

#include <cuda_runtime_api.h>

namespace adasplats {
namespace {

constexpr int kOldest = 75;  // Turing, as 10 * major + minor
static_assert(ADASPLATS_OLDEST_GPU >= kOldest);

std::string capability_text(int capability) {
  return std::to_string(capability / 10) + "." + std::to_string(capability % 10);
}

/// The reason why this build cannot use a GPU.
std::string why_too_old(const std::string& name, int capability) {
  if (capability < kOldest)
    return name + " is too old: compute capability 7.5 (Turing) or newer is needed";
  return name + " has compute capability " + capability_text(capability) +
         " and this build is made for " + capability_text(ADASPLATS_OLDEST_GPU) +
         " or newer; configure it with -DCMAKE_CUDA_ARCHITECTURES=" + std::to_string(capability);
}

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

std::string why_none(cudaError_t status, int driver_version) {
  int built = 0;
  cudaRuntimeGetVersion(&built);
  switch (status) {
    case cudaErrorInsufficientDriver:
      if (driver_version == 0)
        return "no NVIDIA driver was found; install one (in a container: start it with --gpus all)";
      return "the NVIDIA driver is too old: it supports CUDA " + version_text(driver_version) +
             " and this build needs " + version_text(built) + "; update the driver";
    case cudaErrorNoDevice:
      return "the NVIDIA driver sees no GPU (CUDA_VISIBLE_DEVICES, or a container started without "
             "--gpus all, may hide it)";
    default: return std::string("CUDA does not start: ") + cudaGetErrorString(status);
  }
}

}  // namespace

GpuSearch find_gpus() {
  GpuSearch search;
  int driver_version = 0;
  if (cudaDriverGetVersion(&driver_version) == cudaSuccess && driver_version > 0)
    search.driver = version_text(driver_version);
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess) {
    cudaGetLastError();  // clears the error for the next call
    search.reason = why_none(status, driver_version);
    return search;
  }
  for (int index = 0; index < count; ++index) {
    cudaDeviceProp properties{};
    if (cudaGetDeviceProperties(&properties, index) != cudaSuccess) continue;
    GpuDevice device;
    device.index = index;
    device.name = properties.name;
    device.compute_major = properties.major;
    device.compute_minor = properties.minor;
    device.memory_bytes = properties.totalGlobalMem;
    const int capability = 10 * properties.major + properties.minor;
    if (capability < ADASPLATS_OLDEST_GPU) {
      search.reason = why_too_old(device.name, capability);
      continue;
    }
    search.devices.push_back(std::move(device));
  }
  if (!search.devices.empty()) {
    search.reason.clear();
  } else if (search.reason.empty()) {
    search.reason = why_none(cudaErrorNoDevice, driver_version);
  }
  return search;
}

std::size_t free_memory_bytes(int device) {
  int before = 0;
  std::size_t free_bytes = 0, total_bytes = 0;
  cudaGetDevice(&before);
  const bool has_info = cudaSetDevice(device) == cudaSuccess &&
                        cudaMemGetInfo(&free_bytes, &total_bytes) == cudaSuccess;
  cudaSetDevice(before);
  cudaGetLastError();  // clears the error for the next call
  return has_info ? free_bytes : 0;
}

bool built_with_cuda() { return true; }

}  // namespace adasplats
#endif
