// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/core/executor.h"
#include "adasplats/splats/model_engine.h"

namespace adasplats {

/// Builds models on a GPU with CUDA: the steps of build_model with the same maths. `executor` does
/// what is left on the CPU; it must outlive the engine. Device memory is given back when the steps
/// end. Errors: unavailable (no such GPU, not enough memory), with what helps.
std::unique_ptr<ModelEngine> make_cuda_model_engine(int device, const Executor& executor);

}  // namespace adasplats
