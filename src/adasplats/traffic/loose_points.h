// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/traffic/seen_space.h"

namespace adasplats {

/// The points of one scan where the beams of other scans show free space.
struct LoosePoints {
  std::size_t scan = 0;         ///< its number in the drive
  double time_s = 0;            ///< of the scan
  Vec3d sensor;                 ///< its position at that time, world coordinates, m
  std::vector<Vec3d> points;    ///< world coordinates, m
  std::vector<double> times_s;  ///< one per point
  std::vector<Vec3f> firm;  ///< one in kFirmEvery of the points that others saw, too, from sensor
  static constexpr std::size_t kFirmEvery = 16;
};

struct LooseOptions {
  double min_range_m = 2.5;  ///< nearer points are on the recording vehicle
  double max_range_m = 80;
  std::size_t min_free = 3;  ///< scans that saw the place free; at least as many as occupied
};

/// Loose points of scan number `index`; `others`: what other scans saw. The same for any number of
/// threads.
LoosePoints loose_points(const KittiSequence& drive, std::size_t index, const KittiScan& scan,
                         std::span<const SeenSpace* const> others, const LooseOptions& options,
                         const Executor& executor);

}  // namespace adasplats
