// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/calibrate/windows_report.h"
#include "adasplats/cloud/sequence/calibration.h"

namespace adasplats {

/// Pose corrections of the scans of one window, determined up to a rigid motion of the window.
struct WindowPoses {
  std::size_t begin = 0;              ///< number of its first scan in the drive
  std::vector<PoseCorrection> poses;  ///< scan by scan; may be empty

  std::size_t end() const { return begin + poses.size(); }
};

/// Trust in the given poses: standard deviations per scan.
struct GivenPoseTrust {
  double rotation_sigma_rad = 0.01, translation_sigma_m = 0.3;
};

/// Moves every window rigidly so that neighbours agree where they overlap, with the given poses as
/// priors. Solves one small system for all windows of a drive; time and memory grow linearly with
/// their number. A window without overlap is aligned to the given poses. `windows`: in order, each
/// overlapping at most the next. Returns the remaining difference of each from the previous one.
std::vector<PoseDisagreement> settle_windows(std::span<WindowPoses> windows,
                                             const GivenPoseTrust& trust);

/// One correction for each of `given`'s scans. Windows are cross-faded where they overlap (squared
/// sines that sum to 1), so there are no steps at their edges. Scans without a window are
/// interpolated in time between their neighbours, or take the nearest one's correction at the ends.
/// Empty if no window has corrections.
std::vector<PoseCorrection> blended(std::span<const WindowPoses> windows, const Trajectory& given);

/// Median and maximum of the differences per scan.
PoseDisagreement disagreement_of(std::span<const PoseCorrection> a,
                                 std::span<const PoseCorrection> b);

/// Aligns the corrected poses to the given ones by one rigid motion.
void align_to_given(std::vector<PoseCorrection>& poses);

}  // namespace adasplats
