// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/pipeline/session/session.h"

namespace adasplats {

/// calibrate() on the session's device, with the same result on all; where a GPU that nobody asked
/// for fails, warns and goes on with the CPU.
std::pair<Calibration, CalibrationReport> calibrate_on_device(const PointCloud& cloud,
                                                              const CalibrateOptions& options,
                                                              Session& session);

}  // namespace adasplats
