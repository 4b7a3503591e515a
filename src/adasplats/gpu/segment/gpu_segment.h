// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/segment/segment_engine.h"

namespace adasplats {

/// Runs networks on a GPU with CUDA: the grids and neighbourhoods of the CPU bit by bit; products
/// of matrices add up in another order (docs/segmentation.md says by how much logits differ).
/// Errors: unavailable (no such GPU, not enough memory), with what helps.
std::unique_ptr<SegmentEngine> make_cuda_segment_engine(int device);

}  // namespace adasplats
