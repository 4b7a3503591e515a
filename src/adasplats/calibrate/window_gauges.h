// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/calibrate/windows_report.h"
#include "adasplats/cloud/sequence/calibration.h"

namespace adasplats {

/// The corrections that one window has for its scans; nothing observes where it is as a whole.
struct WindowPoses {
  std::size_t begin = 0;              ///< the number of its first scan in the drive
  std::vector<PoseCorrection> poses;  ///< scan by scan; empty: it has none

  std::size_t end() const { return begin + poses.size(); }
};

/// How far given poses are believed: standard deviations of a scan.
struct GivenPoseTrust {
  double rotation_sigma_rad = 0.01, translation_sigma_m = 0.3;
};

/// Moves every window as a whole so that neighbours agree where they overlap, as far as the given
/// poses are believed: one small system for all windows of a drive, whose time and memory grow with
/// their number. A window that overlaps with no other lies on the given poses. `windows`: in their
/// order, every one overlapping at most with the next. Gives how far each then is from the one
/// before.
std::vector<PoseDisagreement> settle_windows(std::span<WindowPoses> windows,
                                             const GivenPoseTrust& trust);

/// One correction for each of `given`'s scans: windows fade into one another where they overlap
/// (squared sines, that add up to 1), so their edges do not show; scans that no window has lie by
/// time between the scans around them that one has, and have the next one's at the ends. Empty
/// where no window has any.
std::vector<PoseCorrection> blended(std::span<const WindowPoses> windows, const Trajectory& given);

/// Median and largest of disagreements, scan by scan.
PoseDisagreement disagreement_of(std::span<const PoseCorrection> a,
                                 std::span<const PoseCorrection> b);

/// The whole turned and shifted so that it lies on the given poses in the mean.
void align_to_given(std::vector<PoseCorrection>& poses);

}  // namespace adasplats
