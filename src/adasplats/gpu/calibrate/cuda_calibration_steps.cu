// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibration_steps_on.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/gpu/neighbors/gpu_backend.cuh"

namespace adasplats {

std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int device) {
  const gpu::DeviceGuard guard = gpu::enter_gpu(device, "calibrate");
  return std::make_unique<CalibrationStepsOn<gpu::GpuBackend>>(device);
}

}  // namespace adasplats
