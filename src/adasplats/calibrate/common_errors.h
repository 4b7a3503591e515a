// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "adasplats/calibrate/calibrate.h"

namespace adasplats {

/// What windows of one recording found of its unit: what all of them have in common.
struct WindowFinding {
  LaserOffsets lasers;  ///< empty: none
  double weight = 0;    ///< of them: points on planes
  std::optional<MountReport> mount;
};

struct CommonErrors {
  LaserOffsets lasers;
  std::size_t laser_windows = 0;
  double range_disagreement_m = 0, elevation_disagreement_rad = 0;  ///< RMS from the pooled ones
  std::optional<MountReport> mount;
  std::size_t mount_windows = 0;
  double mount_disagreement_rad = 0, mount_disagreement_m = 0;  ///< the largest from the pooled one
};

/// Pools them. Offsets of a laser: the mean of the windows, by their points, in which those far
/// from the weighted median hardly count. The mount: by least squares, each window in the
/// directions that it observes; nothing, with an objection, where not more than half of the windows
/// that could tell found one to correct.
CommonErrors pooled(std::span<const WindowFinding> findings, const MountOptions& options);

}  // namespace adasplats
