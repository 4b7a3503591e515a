// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/splats/model_engine.h"

namespace adasplats {

/// Builds models on a GPU with CUDA: the steps of build_model with the same maths. The steps free
/// their device memory when they end. Errors: unavailable (no such GPU, not enough memory), with
/// advice.
std::unique_ptr<ModelEngine> make_cuda_model_engine(int device);

}  // namespace adasplats
