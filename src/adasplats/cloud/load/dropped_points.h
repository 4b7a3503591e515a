// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Warns of every point of `input` (as messages name it) that was dropped, with the reason and the
/// figures. Errors: data where more than options.max_dropped of them were far or not finite; points
/// whose three coordinates are NaN do not count, as organised clouds hold so where no beam
/// returned.
void report_dropped(const std::string& input, const LoadReport& report, const LoadOptions& options,
                    ProgressSink& progress);

/// Warns of points on the vehicle that carried the sensor, which were left out.
void report_own_body(const std::string& input, const LoadReport& report, const LoadOptions& options,
                     ProgressSink& progress);

/// Throws data where the box of all points can only be one of degrees: within 180 and 90 without
/// holding 0, 0, and more than a thousand times as high as it is wide. (Degrees are 111 km, so that
/// points of a place whose heights differ by 1 % of its width look like that.) Warns where it can
/// be one of degrees or a pole: less than 1 wide and more than ten times as high, of files that say
/// no coordinate system.
void require_metres(const std::string& input, Vec3d low, Vec3d high, const Crs& crs,
                    ProgressSink& progress);

}  // namespace adasplats
