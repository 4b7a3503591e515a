// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <string>
#include <string_view>

namespace adasplats::gpu {

/// Private to gpu/: throws an Error (`unavailable`) where a CUDA call failed. `doing` says what was
/// being done ("copy the rays to the GPU"). Out of memory is reported with what is free and with
/// what helps. Also used after a kernel launch: cuda_check(cudaGetLastError(), "sort the points").
void cuda_check(cudaError_t status, std::string_view doing);

/// Makes a device the current one of this thread and restores the former one.
class DeviceGuard {
 public:
  explicit DeviceGuard(int device);
  ~DeviceGuard();
  DeviceGuard(const DeviceGuard&) = delete;
  DeviceGuard& operator=(const DeviceGuard&) = delete;

 private:
  int before_ = 0;
};

/// Makes a GPU the current one. Errors: unavailable ("cannot <doing> on a GPU: ..."; there is none,
/// or not that one).
[[nodiscard]] DeviceGuard enter_gpu(int device, const std::string& doing);

}  // namespace adasplats::gpu
