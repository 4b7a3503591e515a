// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibration_steps_on.h"
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/calibrate/gpu_calibrate.h"
#include "adasplats/gpu/neighbors/gpu_backend.cuh"

namespace adasplats {

std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int device) {
  const GpuSearch found = find_gpus();
  if (found.devices.empty())
    throw Error(ErrorKind::unavailable, "cannot calibrate on a GPU: " + found.reason);
  const gpu::DeviceGuard guard(device);
  return std::make_unique<CalibrationStepsOn<gpu::GpuBackend>>(device);
}

}  // namespace adasplats
