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

/// How long drives are cut.
struct CalibrateWindowOptions {
  /// The most scans that are solved at once. 200 are 20 s: what one scan sees is out of sight long
  /// before, and the 40,000 points of each that calibrate() looks at take about 1 GB.
  std::size_t window_scans = 200;
};

template <class Visit>
void visit_settings(CalibrateWindowOptions& windows, Visit&& visit) {
  visit(Setting{.name = "window_scans",
                .help = "Number of scans solved together; longer drives are split into windows "
                        "that overlap by half",
                .value = "N",
                .min = 8,  // four scans are what a window shares with the next
                .max = 1e6,
                .basic = true},
        windows.window_scans);
}

/// Splits a drive into windows of at most `window_scans` (2 or more) scans. Their lengths differ by
/// at most one scan, and each overlaps the next by half. A short drive has one window.
std::vector<ScanSpan> cut_windows(std::size_t scans, std::size_t window_scans);

/// A drive whose scans need not be in memory.
struct DriveSource {
  std::size_t scans = 0;
  /// Points of some scans, numbered from 0, with the poses of all of them.
  std::function<PointCloud(ScanSpan)> read;
};

struct WindowedCalibration {
  Calibration calibration;
  CalibrationReport report;  ///< with `windows`
  Trajectory given;          ///< poses of all scans, drive by drive
};

/// Calibrates one cloud: calibrate() on some device.
using CalibrateCloud = std::function<std::pair<Calibration, CalibrationReport>(
    const PointCloud& cloud, const CalibrateOptions& options)>;

/// calibrate() window by window, by `calibrate_cloud`. What all windows have in common, lasers and
/// mount, is pooled from at most eight windows all over the drives and then the same for all; the
/// poses of each window are estimated alone, laid on one another where they overlap
/// (settle_windows) and blended; windows without evidence get nothing of their own. The whole lies
/// on the given poses. Drives are not tied to one another, nor places that a drive comes back to in
/// another window. Memory: points of half a window as they are read, points_a_scan of a window, and
/// what calibrate() needs for it; nothing but poses grows with the drives.
WindowedCalibration calibrate_windows(std::span<const DriveSource> drives,
                                      const CalibrateOptions& options,
                                      const CalibrateWindowOptions& windows,
                                      const CalibrateCloud& calibrate_cloud,
                                      const Executor& executor, ProgressSink& progress);

/// calibrate() of a cloud in memory: at once where no drive in it is longer than a window, else by
/// windows that are views of it.
std::pair<Calibration, CalibrationReport> calibrate_drives(
    const PointCloud& cloud, const CalibrateOptions& options, const CalibrateWindowOptions& windows,
    const CalibrateCloud& calibrate_cloud, const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
