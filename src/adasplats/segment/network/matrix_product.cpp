// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/network/matrix_product.h"

#include "adasplats/core/error.h"

#ifdef ADASPLATS_OPENBLAS
#include <cblas.h>
#endif

namespace adasplats {

#ifdef ADASPLATS_OPENBLAS

void require_products() {
  // Its own threads would share the cores with ours, and sum in an order that depends on them.
  static const bool kAlone = [] {
    openblas_set_num_threads(1);
    return true;
  }();
  static_cast<void>(kAlone);
}

void multiply(const float* a, const float* b, float* c, std::size_t rows, std::size_t inner,
              std::size_t columns) {
  require_products();
  const auto m = static_cast<blasint>(rows), k = static_cast<blasint>(inner),
             n = static_cast<blasint>(columns);
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, n, k, 1.0F, a, k, b, n, 0.0F, c, n);
}

#else

void require_products() {
  throw Error(ErrorKind::unavailable,
              "networks need OpenBLAS, which this program was built without (libopenblas-dev)");
}

void multiply(const float*, const float*, float*, std::size_t, std::size_t, std::size_t) {
  require_products();
}

#endif

}  // namespace adasplats
