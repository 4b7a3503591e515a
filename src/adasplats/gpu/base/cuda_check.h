// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <string>
#include <string_view>

namespace adasplats::gpu {

/// Private to gpu/: throws an Error (`unavailable`) if a CUDA call failed. `doing` names the action
/// ("copy the rays to the GPU"). Out-of-memory errors report the free memory and a remedy. Also
/// used after a kernel launch: cuda_check(cudaGetLastError(), "sort the points").
void cuda_check(cudaError_t status, std::string_view doing);

/// Makes a device the current one of this thread and restores the previous one on destruction.
class DeviceGuard {
 public:
  explicit DeviceGuard(int device);
  ~DeviceGuard();
  DeviceGuard(const DeviceGuard&) = delete;
  DeviceGuard& operator=(const DeviceGuard&) = delete;

 private:
  int before_ = 0;
};

/// Makes a GPU the current one. Errors: unavailable ("cannot <doing> on a GPU: ...": no GPU, or no
/// such device).
[[nodiscard]] DeviceGuard enter_gpu(int device, const std::string& doing);

}  // namespace adasplats::gpu
