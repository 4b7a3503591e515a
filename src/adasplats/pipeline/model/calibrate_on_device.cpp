// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/model/calibrate_on_device.h"

#include "adasplats/gpu/calibrate/gpu_calibrate.h"

namespace adasplats {

std::pair<Calibration, CalibrationReport> calibrate_on_device(const PointCloud& cloud,
                                                              const CalibrateOptions& options,
                                                              Session& session) {
  std::pair<Calibration, CalibrationReport> result;
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    const auto steps = make_cuda_calibration_steps(session.device.gpu_numbers().front());
    result = calibrate(cloud, options, *steps, session.executor);
  });
  return on_gpu ? result : calibrate(cloud, options, session.executor);
}

}  // namespace adasplats
