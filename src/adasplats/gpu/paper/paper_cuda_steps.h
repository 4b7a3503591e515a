// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats::gpu {

/// Private to gpu/: the steps of the paper's methods on a GPU; all data stays in its memory between
/// load() and take_splats(). Errors: unavailable, usage (neighbourhoods too large for a GPU).
std::unique_ptr<PaperSteps> make_cuda_paper_steps(int device);

}  // namespace adasplats::gpu
