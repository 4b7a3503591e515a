// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/calibrate_on_device.h"

#include <utility>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/gpu/base/engines.h"

namespace adasplats {

CalibrateCloud calibrate_on(Session& session) {
  return [&session](const PointCloud& cloud, const CalibrateOptions& options) {
    std::pair<Calibration, CalibrationReport> result;
    const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
      const auto steps = make_cuda_calibration_steps(session.device.gpu_numbers().front());
      result = calibrate(cloud, options, *steps, session.executor);
    });
    return on_gpu ? result : calibrate(cloud, options, session.executor);
  };
}

}  // namespace adasplats
