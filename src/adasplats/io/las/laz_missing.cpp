// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz.h"

#ifndef ADASPLATS_HAVE_LASZIP

#include "adasplats/core/error.h"

namespace adasplats {

Table read_laz(const std::filesystem::path& path, const LasReadOptions&) {
  throw Error(ErrorKind::data,
              path.string() +
                  ": LAZ (compressed LAS) needs LASzip, which was not there when adasplats was "
                  "built: install the package liblaszip-dev and build again, or convert the file "
                  "to LAS");
}

}  // namespace adasplats

#endif
