// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Poses of a sensor between which times are interpolated, and where they have gaps.
struct Track {
  Trajectory poses;  ///< one distance of poses farther than measured, before and behind each gap
  std::vector<TimeSpan> gaps;
  TimeSpan measured_s;

  TimeSpan covered_s() const { return {poses.front().time_s, poses.back().time_s}; }
  /// Whether there are poses for all of a span: within covered_s(), and not in a gap.
  bool covers(TimeSpan span_s) const;
  bool covers(double time_s) const { return covers(TimeSpan{time_s, time_s}); }
};

/// Whether a span has a part in one of the gaps, which ascend.
bool is_in_gap(const std::vector<TimeSpan>& gaps, TimeSpan span_s);

/// The median time between poses; 0 of a single one.
double pose_distance_s(const Trajectory& poses);

/// Gaps are of ten distances of poses or more, and of more than a second. A pose may be that of the
/// middle of a scan, so a track goes on for one distance beyond the poses, as fast as between the
/// last two, and nowhere farther.
Track track_of(const Trajectory& given);

}  // namespace adasplats
