// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace adasplats {

/// Differences between two estimates of the same poses, per scan.
struct PoseDisagreement {
  std::size_t scans = 0;
  double median_shift_m = 0, largest_shift_m = 0;
  double median_rotation_rad = 0, largest_rotation_rad = 0;
};

/// One window of a long drive.
struct WindowReport {
  std::size_t drive = 0;
  std::size_t begin = 0, end = 0;  ///< its scans, numbered within the drive
  std::size_t planes = 0, points = 0;
  /// Median distance of held-out points from the planes, m: as given; with the common lasers and
  /// mount; with the window's own poses. 0: not measured.
  double given_m = 0, common_m = 0, calibrated_m = 0;
  double weakest_share = 0;
  bool constrains_lasers = false;  ///< its laser offsets were pooled
  std::string objection;  ///< why the poses of its scans are not corrected; empty if they are
  /// Differences from the previous window, if both have pose corrections, after their alignment.
  PoseDisagreement overlap;
};

/// Report of a calibration window by window.
struct WindowsReport {
  std::size_t window_scans = 0;  ///< maximum number of scans in a window
  std::vector<WindowReport> windows;
  PoseDisagreement overlaps;  ///< of all overlaps together
  /// Number of windows whose lasers or mount were pooled, and their differences from the pooled
  /// values (lasers: RMS over lasers and windows; mount: maximum).
  std::size_t laser_windows = 0, mount_windows = 0;
  double range_disagreement_m = 0, elevation_disagreement_rad = 0;
  double mount_disagreement_rad = 0, mount_disagreement_m = 0;

  std::size_t without_evidence() const {
    std::size_t count = 0;
    for (const WindowReport& window : windows) count += window.objection.empty() ? 0 : 1;
    return count;
  }
};

/// A limitation of calibration by windows, as part of a sentence.
inline constexpr const char* kNotClosed =
    "places that a drive comes back to in another window are not made to agree";

}  // namespace adasplats
