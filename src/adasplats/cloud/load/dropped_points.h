// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Warns of the dropped points of `input` (its name in messages), with reason and figures. Errors:
/// data if more than options.max_dropped of them were far or not finite. Points with three NaN
/// coordinates do not count: organised clouds have them for missing returns.
void report_dropped(const std::string& input, const LoadReport& report, const LoadOptions& options,
                    ProgressSink& progress);

/// Warns of points that were removed because they are on the recording vehicle or in its path.
void report_own_body(const std::string& input, const LoadReport& report, const LoadOptions& options,
                     ProgressSink& progress);

/// Throws data if the box of all points can only be geocentric (ECEF), or in degrees: within 180
/// and 90 without (0, 0), and more than a thousand times as high as wide. (A degree is 111 km, so a
/// scene whose heights vary by 1 % of its width looks like that.) Warns if it can be in degrees or
/// a pole: less than 1 wide, more than ten times as high, and without a coordinate system.
void require_metres(const std::string& input, Vec3d low, Vec3d high, const Crs& crs,
                    ProgressSink& progress);

}  // namespace adasplats
