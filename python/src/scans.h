// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/range_image.h"
#include "adasplats/simulate/scan/scan.h"
#include "bindings.h"

namespace adasplats::python {

/// Scans of one drive, with the size of their range images.
struct ScanList {
  std::vector<std::shared_ptr<Scan>> scans;
  ImageSize image_size;                       ///< of the sensor
  std::shared_ptr<const LabelScheme> labels;  ///< null: none
};

}  // namespace adasplats::python
