// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace adasplats {

/// How far apart two estimates of the same poses are: what single scans differ by.
struct PoseDisagreement {
  std::size_t scans = 0;
  double median_shift_m = 0, largest_shift_m = 0;
  double median_rotation_rad = 0, largest_rotation_rad = 0;
};

/// One window of a long drive.
struct WindowReport {
  std::size_t drive = 0;
  std::size_t begin = 0, end = 0;  ///< of its scans, by their numbers in the drive
  std::size_t planes = 0, points = 0;
  /// Median distance of points that were left out from planes, m: as given; with the lasers and the
  /// mount that all windows have in common; with the window's own poses. 0: not judged.
  double given_m = 0, common_m = 0, calibrated_m = 0;
  double weakest_share = 0;
  bool constrains_lasers = false;  ///< it was among those whose lasers were pooled
  std::string objection;           ///< why its scans get nothing of their own; empty: they do
  /// From the window before, where both have poses of their own, once both lie as well as they can
  /// on one another as a whole.
  PoseDisagreement overlap;
};

/// How a long drive was calibrated window by window.
struct WindowsReport {
  std::size_t window_scans = 0;  ///< the most that a window has
  std::vector<WindowReport> windows;
  PoseDisagreement overlaps;  ///< of all overlaps together
  /// Windows whose lasers or mount were pooled, and how far they are from what all have in common
  /// (RMS over lasers and windows; the largest of a mount).
  std::size_t laser_windows = 0, mount_windows = 0;
  double range_disagreement_m = 0, elevation_disagreement_rad = 0;
  double mount_disagreement_rad = 0, mount_disagreement_m = 0;

  std::size_t without_evidence() const {
    std::size_t count = 0;
    for (const WindowReport& window : windows) count += window.objection.empty() ? 0 : 1;
    return count;
  }
};

/// What windows do not do; a sentence's part.
inline constexpr const char* kNotClosed =
    "places that a drive comes back to in another window are not made to agree";

}  // namespace adasplats
