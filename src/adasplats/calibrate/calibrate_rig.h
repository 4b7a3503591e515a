// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "adasplats/calibrate/windows.h"

namespace adasplats {

/// Calibrates the sensors of a rig one after another. The first one is calibrated alone, as
/// calibrate_drives() does. Every other one follows the corrections of the first in time and is
/// then aligned with the map of the corrected points of those before it: mount and clock
/// (align_with_map()), poses and lasers, and mount and clock once more (refine_alignment()). Its
/// scans therefore do not change the estimates of those before it. Sensors whose lasers are unknown
/// get offsets of cells of directions. Calibration::others and CalibrationReport::others have one
/// entry for every sensor but the first. Errors: data for a sensor whose points do not fit the map
/// with any mount and clock that was searched.
std::pair<Calibration, CalibrationReport> calibrate_rig(
    const PointCloud& cloud, const CalibrateOptions& options, const CalibrateWindowOptions& windows,
    const CalibrateCloud& calibrate_cloud, const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
