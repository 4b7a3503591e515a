// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/jobs/session/scan_range.h"
#include "arrays.h"
#include "keywords.h"

namespace adasplats::python {

/// Vectors in world coordinates, stored relative to a nearby origin.
struct LocalVectors {
  Vec3d origin;
  std::vector<Vec3f> vectors;
};
/// `origin`: None for that of choose_origin(). Errors: ValueError (not finite).
LocalVectors local_vectors(const Rows& world, py::handle origin);

/// The keywords of a range of scans: first_scan, scan_count, scan_stride, each with `prefix`.
void take_scan_range(Keywords& keywords, ScanRange& range, const std::string& prefix = "");

/// The keywords of LoadOptions.
void take_load_options(Keywords& keywords, LoadOptions& options);

}  // namespace adasplats::python
