// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "adasplats/calibrate/calibrate.h"

namespace adasplats {

/// Sensor errors found in one window; all windows of a recording share them.
struct WindowFinding {
  LaserOffsets lasers;  ///< empty: none
  double weight = 0;    ///< of the laser offsets: points on planes
  std::optional<MountReport> mount;
};

struct CommonErrors {
  LaserOffsets lasers;
  std::size_t laser_windows = 0;
  double range_disagreement_m = 0, elevation_disagreement_rad = 0;  ///< RMS from the pooled offsets
  std::optional<MountReport> mount;
  std::size_t mount_windows = 0;
  double mount_disagreement_rad = 0, mount_disagreement_m = 0;  ///< maximum from the pooled mount
};

/// Pools the findings of all windows; `keeps_range_mean`: the mean range offset is observed, from a
/// map. Offsets of a laser: mean over the windows, weighted by their
/// points; windows far from the weighted median have little weight. Mount: least squares, each
/// window in the directions that it observes. Without a mount, and with an objection, unless more
/// than half of the windows with enough planes found a mount error.
CommonErrors pooled(std::span<const WindowFinding> findings, const MountOptions& options,
                    bool keeps_range_mean = false);

}  // namespace adasplats
