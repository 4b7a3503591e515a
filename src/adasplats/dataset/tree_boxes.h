// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// An object of the world with a point in a scan, as listed in data sets.
struct TreeBox {
  ObjectBox box;           ///< in the world
  std::string type;        ///< kitti_type() of its class
  bool moves = false;      ///< by its class, or by its position a tenth of a second later
  std::size_t points = 0;  ///< points of the scan in the box: sensed_boxes()
};

/// The objects with a point in scan `index`.
std::vector<TreeBox> boxes_with_points(const BoxesOfScan& boxes, std::size_t index,
                                       const ScanView& scan, const LabelScheme* labels);

}  // namespace adasplats
