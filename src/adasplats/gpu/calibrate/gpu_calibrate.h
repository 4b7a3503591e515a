// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/calibrate/calibration_steps.h"

namespace adasplats {

/// The steps of calibrate() on a GPU with CUDA, with the CPU's bits. The points that are looked at
/// go there once; device memory is given back when the steps end. Errors: unavailable (no such GPU,
/// not enough memory), with what helps.
std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int device);

}  // namespace adasplats
