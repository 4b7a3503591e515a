// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/setting.h"

namespace adasplats {

/// How a drive is cut into windows of scans.
struct WindowOptions {
  /// Points that are looked at together: two thirds of scans that get labels, a sixth each of the
  /// scans before and after, and no more than three scans beyond that.
  std::size_t points = 30'000'000;
};

template <class Visit>
void visit_settings(WindowOptions& window, Visit&& visit) {
  visit(Setting{.name = "window_points",
                .help = "Maximum number of points of a drive processed together; longer drives are "
                        "split into windows of scans",
                .value = "N",
                .min = 60,
                .max = 1e9},
        window.points);
}

/// Scans that are looked at together, put in place by their poses.
struct ScanWindow {
  struct Scan {
    std::size_t index = 0;        ///< of the sequence
    std::vector<bool> has_place;  ///< of its points: those that the cloud has
  };
  PointCloud cloud;         ///< the points of `scans` first, behind them those of their neighbours
  std::vector<Scan> scans;  ///< that get labels
  std::size_t points = 0;   ///< of these, in the cloud
};

/// Reads a drive window by window, every scan once: memory depends on WindowOptions alone. Every
/// chosen scan gets labels in one window; the scans before and after are its context. What would be
/// less than a context at the end belongs to the window before.
class ScanWindows {
 public:
  /// Points that are not finite or farther than this from the sensor have no place. `sequence` must
  /// outlive the object.
  ScanWindows(const KittiSequence& sequence, std::vector<std::size_t> chosen,
              const WindowOptions& options, double farthest_m);

  /// The next one; nothing behind the last. Errors: those of read_kitti_points.
  std::optional<ScanWindow> next();

 private:
  struct Placed {
    ScanWindow::Scan scan;
    std::vector<Vec3f> positions;  ///< in the frame of the sensor
    std::vector<float> intensities;
  };

  Placed read(std::size_t index) const;
  /// The scan of that number among the chosen ones, read when it is first asked for.
  const Placed& at(std::size_t place);
  std::size_t first_of_context(std::size_t place);
  void add_points(const Placed& placed, PointCloud& cloud) const;

  const KittiSequence& sequence_;
  std::vector<std::size_t> chosen_;
  std::size_t max_points_, max_context_;
  double farthest_m_;
  std::deque<Placed> read_;  ///< of the chosen scans from first_ on
  std::size_t first_ = 0;
  std::size_t next_ = 0;  ///< the first scan of the next window
};

}  // namespace adasplats
