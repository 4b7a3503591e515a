// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/imls.h"

#ifndef ADASPLATS_HAVE_OPENVDB

#include "adasplats/core/error.h"

namespace adasplats {

TriangleMesh imls_surface(std::span<const Vec3f>, std::span<const Vec3f>, const ImlsOptions&,
                          const Executor&) {
  throw Error(ErrorKind::unavailable,
              "IMLS needs OpenVDB, which was not there when adasplats was built: install the "
              "packages libopenvdb-dev and libboost-dev and build again");
}

}  // namespace adasplats

#endif
