// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scenes.h"

namespace adasplats::python {

/// The keywords of simulate(), iter_scans() and scan_batches().
struct SimulateArguments {
  ScanChoice scan;
  DriveArguments drive;
  std::uint64_t seed = 1;
  std::uint64_t first_number = 0;
  py::object progress = py::none();

  void take(Keywords& keywords) {
    drive.take(keywords);
    take_settings(keywords, scan);
    keywords.take("seed", seed);
    keywords.take("first_number", first_number);
    keywords.take("progress", progress);
  }
};

}  // namespace adasplats::python
