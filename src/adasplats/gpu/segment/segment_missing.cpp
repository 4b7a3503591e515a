// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/segment/gpu_segment.h"

namespace adasplats {

std::unique_ptr<SegmentEngine> make_cuda_segment_engine(int) {
  throw Error(ErrorKind::unavailable, "cannot run networks on a GPU: " + find_gpus().reason);
}

}  // namespace adasplats
#endif
