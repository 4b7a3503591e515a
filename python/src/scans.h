// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "adasplats/simulate/scan.h"
#include "bindings.h"

namespace adasplats::python {

/// Scans of one drive, as a sequence.
struct ScanList {
  std::vector<std::shared_ptr<Scan>> scans;
};

}  // namespace adasplats::python
