// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/scan_beams.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Beyond it doubles do not hold 0.1 mm, and no place on Earth has such coordinates.
inline constexpr double kLargestCoordinateM = 1e12;

/// Whether these are coordinates of a place: finite, and not beyond that.
inline bool is_place(Vec3d p) {
  // False for NaN as well.
  return std::fabs(p.x) <= kLargestCoordinateM && std::fabs(p.y) <= kLargestCoordinateM &&
         std::fabs(p.z) <= kLargestCoordinateM;
}

/// Consecutive points of a part that came from one file.
struct PartRun {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::filesystem::path file;
  RigidTransform world_from_local;
  std::size_t scan = 0;  ///< of the sequence
};

/// What one input of load_cloud gives while the common origin is not known yet.
struct CloudPart {
  /// Attributes as they will be. `positions` are in the sensor frames of the runs for sequences
  /// (the scans' own floats: nothing is lost) and empty for files. `sensor_positions` say nothing
  /// yet: they are empty, or memory for later.
  PointCloud cloud;
  std::vector<Vec3d> world_positions;         ///< of files
  std::vector<Vec3d> world_sensors;           ///< of files that have them
  std::vector<double> times_s;                ///< of files that have them, in whatever clock...
  SaidClock said_clock = SaidClock::nothing;  ///< ...and what the file says of that
  std::vector<Vec3f> scan_origins;            ///< of sequences whose scans say them, sensor frames
  std::vector<std::uint8_t> in_boxes;         ///< KittiScan::in_boxes; empty: none is
  std::vector<PartRun> runs;
  bool is_sequence = false;
  ScanBeams beams;  ///< of a sequence

  std::size_t size() const { return runs.empty() ? 0 : runs.back().end; }

  /// Calls visit(i, world position, run) for the points [begin, end).
  template <class Visit>
  void for_each(std::size_t begin, std::size_t end, Visit&& visit) const {
    auto run = std::ranges::upper_bound(runs, begin, {}, &PartRun::end);
    for (std::size_t i = begin; i < end; ++run) {
      for (; i < std::min(end, run->end); ++i) {
        if (is_sequence)
          visit(i, run->world_from_local * vec_cast<double>(cloud.positions[i]), *run);
        else
          visit(i, world_positions[i], *run);
      }
    }
  }
};

/// Reads the scans of a sequence that `options` choose; `first_scan_index` numbers the first.
CloudPart read_sequence_part(const KittiSequence& sequence, const LoadOptions& options,
                             std::uint32_t first_scan_index, const Executor& executor,
                             ProgressSink& progress);
/// A sequence folder with recognised beams (where options want it). Errors: those of
/// open_kitti_sequence and require_poses_that_fit.
KittiSequence open_sequence(const std::filesystem::path& folder, const LoadOptions& options,
                            const Executor& executor);

/// Reads a file of points, on the threads of `executor` where one is given.
CloudPart read_file_part(const std::filesystem::path& path, const LoadOptions& options,
                         ProgressSink& progress, const Executor* executor = nullptr);

/// The same of columns that are in memory; `path` is for messages.
CloudPart part_of_table(const std::filesystem::path& path, const Table& table,
                        const LoadOptions& options, ProgressSink& progress);

/// One cloud of all; `scan_poses` are of their scans. Inputs with and without an attribute together
/// lose it, with a warning; sensor positions stay (load_cloud).
PointCloud joined(std::vector<PointCloud>&& clouds, Vec3d origin, Trajectory scan_poses,
                  ProgressSink& progress);

}  // namespace adasplats
