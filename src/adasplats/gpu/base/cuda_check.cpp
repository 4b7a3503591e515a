// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/cuda_check.h"

#include <cstdio>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats::gpu {
namespace {

std::string gigabytes(std::size_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", static_cast<double>(bytes) / 1e9);
  return text;
}

std::string out_of_memory() {
  std::size_t free_bytes = 0, total_bytes = 0;
  int device = 0;
  std::string message = "the GPU has not enough memory";
  if (cudaGetDevice(&device) == cudaSuccess && gpu_memory_limit(device) > 0) {
    message += " (the limit is " + gigabytes(gpu_memory_limit(device)) + ")";
  } else if (cudaMemGetInfo(&free_bytes, &total_bytes) == cudaSuccess) {
    message += " (" + gigabytes(free_bytes) + " of " + gigabytes(total_bytes) + " are free)";
  }
  return message + "; use `device` cpu, fewer points or splats, or a GPU with more memory";
}

}  // namespace

void cuda_check(cudaError_t status, std::string_view doing) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // the error is reported here: the next call starts without it
  const std::string where = "cannot " + std::string(doing) + ": ";
  if (status == cudaErrorMemoryAllocation) {
    throw Error(ErrorKind::unavailable, where + out_of_memory());
  }
  throw Error(ErrorKind::unavailable, where + "CUDA reports '" + cudaGetErrorString(status) +
                                          "' (" + cudaGetErrorName(status) + ")");
}

DeviceGuard::DeviceGuard(int device) {
  cuda_check(cudaGetDevice(&before_), "ask for the current GPU");
  if (device != before_) cuda_check(cudaSetDevice(device), "use GPU " + std::to_string(device));
}

DeviceGuard::~DeviceGuard() {
  // A device that was current once can be made current again.
  static_cast<void>(cudaSetDevice(before_));
}

DeviceGuard enter_gpu(int device, const std::string& doing) {
  const GpuSearch search = find_gpus();
  if (search.devices.empty())
    throw Error(ErrorKind::unavailable, "cannot " + doing + " on a GPU: " + search.reason);
  return DeviceGuard(device);
}

}  // namespace adasplats::gpu
#endif
