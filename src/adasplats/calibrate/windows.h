// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/calibrate/windows_report.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"

namespace adasplats {

/// How long drives are split.
struct CalibrateWindowOptions {
  /// Maximum number of scans solved together. 200 scans are 20 s at 10 Hz, longer than any surface
  /// stays in view; at the 40,000 points per scan that calibrate() uses they need about 1 GB.
  std::size_t window_scans = 200;
};

template <class Visit>
void visit_settings(CalibrateWindowOptions& windows, Visit&& visit) {
  visit(Setting{.name = "window_scans",
                .help = "Number of scans solved together; longer drives are split into windows "
                        "that overlap by half",
                .value = "N",
                .min = 8,  // windows then share four scans
                .max = 1e6,
                .basic = true},
        windows.window_scans);
}

/// Splits a drive into windows of at most `window_scans` (2 or more) scans. Their lengths differ by
/// at most one scan, and each overlaps the next by half. A short drive has one window.
std::vector<ScanSpan> cut_windows(std::size_t scans, std::size_t window_scans);

/// A drive that is read in parts.
struct DriveSource {
  std::size_t scans = 0;
  /// Reads the points of a span of scans, which are numbered from 0, with the poses of these scans.
  std::function<PointCloud(ScanSpan)> read;
};

struct WindowedCalibration {
  Calibration calibration;
  CalibrationReport report;  ///< with `windows`
  Trajectory given;          ///< poses of all scans, drive by drive
};

/// Calibrates one cloud with calibrate(), on any device.
using CalibrateCloud = std::function<std::pair<Calibration, CalibrationReport>(
    const PointCloud& cloud, const CalibrateOptions& options)>;

/// Calibrates drives window by window with `calibrate_cloud`. Laser offsets and mount are pooled
/// from at most eight windows spread over the drives and are the same for all windows. The poses of
/// each window are estimated separately, aligned where windows overlap (settle_windows) and
/// blended; windows without evidence keep their poses. Finally, each drive is aligned to its given
/// poses. Loops are not closed: neither drives nor windows that revisit a scene are tied to one
/// another. Memory: the points of half a window as read, points_a_scan of a window, and the memory
/// of calibrate() for one window. Only the poses grow with the length of the drives.
WindowedCalibration calibrate_windows(std::span<const DriveSource> drives,
                                      const CalibrateOptions& options,
                                      const CalibrateWindowOptions& windows,
                                      const CalibrateCloud& calibrate_cloud,
                                      const Executor& executor, ProgressSink& progress);

/// Calibrates a cloud in memory: all scans together if no drive is longer than a window, otherwise
/// window by window. The sensors of a rig: calibrate_rig().
std::pair<Calibration, CalibrationReport> calibrate_drives(
    const PointCloud& cloud, const CalibrateOptions& options, const CalibrateWindowOptions& windows,
    const CalibrateCloud& calibrate_cloud, const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
