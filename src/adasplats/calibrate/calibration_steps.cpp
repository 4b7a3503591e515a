// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/calibration_steps.h"

#include "adasplats/calibrate/calibration_steps_on.h"
#include "adasplats/core/cpu_arrays.h"

namespace adasplats {

std::unique_ptr<CalibrationSteps> make_cpu_calibration_steps(const Executor& executor) {
  return std::make_unique<CalibrationStepsOn<CpuArrays>>(executor);
}

}  // namespace adasplats
