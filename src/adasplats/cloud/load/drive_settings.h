// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include "adasplats/core/setting.h"
#include "adasplats/core/words.h"

namespace adasplats {

/// Which frame the points of a drive's files are in.
enum class PointsIn : std::uint8_t {
  found,   ///< what the points and the poses say
  sensor,  ///< each file in the frame of the sensor (or of the vehicle) at its scan
  world    ///< all files in one
};
inline constexpr std::pair<std::string_view, PointsIn> kPointsIn[] = {
    {"auto", PointsIn::found}, {"sensor", PointsIn::sensor}, {"world", PointsIn::world}};
inline Words<PointsIn> words_of(PointsIn) { return kPointsIn; }

/// Whether the motion of the sensor within a sweep is still in points of the sensor's frame.
enum class SweepPoints : std::uint8_t {
  found,       ///< what the cones of the sensor's beams say
  measured,    ///< each point in the frame of the sensor at its own time
  compensated  ///< all points of a scan in the frame of the sensor at one time
};
inline constexpr std::pair<std::string_view, SweepPoints> kSweepPoints[] = {
    {"auto", SweepPoints::found},
    {"measured", SweepPoints::measured},
    {"compensated", SweepPoints::compensated}};
inline Words<SweepPoints> words_of(SweepPoints) { return kSweepPoints; }

/// How the scans of a drive whose files are given with a trajectory are meant, for every struct
/// with these members.
template <class Drive, class Visit>
void visit_drive_settings(Drive& drive, const char* group, Visit&& visit) {
  visit(Setting{.name = "points_in",
                .help = "Which frame the points of a folder of scans with a trajectory are in",
                .group = group},
        drive.points_in);
  visit(Setting{.name = "sweep_points",
                .help = "Whether points of scans in the sensor's frame with times are as measured, "
                        "or motion-compensated",
                .group = group},
        drive.sweep_points);
  visit(Setting{.name = "scan_times",
                .help = "Times of the scans of a folder, s, one a line in the order of their "
                        "names, in the clock of the trajectory",
                .value = "FILE",
                .group = group},
        drive.scan_times);
}

}  // namespace adasplats
