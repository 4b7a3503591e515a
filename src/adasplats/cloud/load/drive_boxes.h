// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "adasplats/cloud/load/drive_settings.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// How the times of boxes relate to those of points.
struct BoxClock {
  double later_s = 0;         ///< time offset: subtract it from the box times
  bool are_of_scans = false;  ///< BoxContent::are_of_scans
  std::size_t points = 0;     ///< in boxes of fast objects
  std::size_t as_given = 0;   ///< the same with the times as given
};

/// Finds the clock in which most points are in boxes of objects faster than 3 m/s, within 0.2 s.
/// Nothing unless it holds 2 % more of them than the given times, and at least 500, in boxes of at
/// least three objects.
std::optional<BoxClock> fit_box_clock(const MovingBoxes& boxes, const KittiSequence& drive,
                                      const Executor& executor);

/// Reads the boxes that the settings of a drive name, if any, and corrects their times
/// (fit_box_clock()), which a warning states. `stamps_s`: of the scans, where their annotations
/// have other times than their poses. Errors: those of read_box_file(); data if no box has a time
/// within the scans, or if the clocks differ by 0.2 s or more.
void add_boxes(const DriveSettings& settings, std::span<const double> stamps_s,
               KittiSequence& drive, const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
