// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/gpu_model.h"

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats {

std::unique_ptr<ModelEngine> make_cuda_model_engine(int) {
  throw Error(ErrorKind::unavailable, "cannot build models on a GPU: " + find_gpus().reason);
}

}  // namespace adasplats
#endif
