// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/segment/segment_engine.h"
#include "adasplats/splats/model_engine.h"

namespace adasplats {

// CUDA implementations of the engines of other stages. `device`: CUDA device number. Engines, and
// the steps they create, free their device memory on destruction. Errors: unavailable (no such GPU,
// not enough memory), with a remedy.

/// Builds models: the steps of build_model(), bit-identical to the CPU.
std::unique_ptr<ModelEngine> make_cuda_model_engine(int device);

/// The steps of calibrate(), bit-identical to the CPU. Points are copied to the GPU once.
std::unique_ptr<CalibrationSteps> make_cuda_calibration_steps(int device);

/// Runs networks: grids and neighbourhoods are bit-identical to the CPU; matrix products are summed
/// in a different order (docs/segmentation.md gives the differences of logits).
std::unique_ptr<SegmentEngine> make_cuda_segment_engine(int device);

}  // namespace adasplats
