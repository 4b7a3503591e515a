// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/load/sensor_frame.h"
#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/scan_beams.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Beyond it doubles do not resolve 0.1 mm, and nothing on Earth has such coordinates.
inline constexpr double kMaxCoordinate_m = 1e12;

/// Whether coordinates are usable: finite and within that limit.
inline bool is_valid_position(Vec3d p) {
  // False for NaN as well.
  return std::fabs(p.x) <= kMaxCoordinate_m && std::fabs(p.y) <= kMaxCoordinate_m &&
         std::fabs(p.z) <= kMaxCoordinate_m;
}

/// Consecutive points of a part that came from one file.
struct PartRun {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::filesystem::path file;
  RigidTransform world_from_local;
  std::size_t scan = 0;  ///< of the sequence
};

/// The points of one input of load_cloud before the common origin is chosen.
struct CloudPart {
  /// Attributes in their final form. `positions` are in the sensor frames of the runs for sequences
  /// (the scans' own floats, so nothing is lost) and empty for files. `sensor_positions` are not
  /// set yet: empty, or memory for later.
  PointCloud cloud;
  std::vector<Vec3d> world_positions;  ///< of files
  std::vector<Vec3d> world_sensors;    ///< of files that have them
  std::vector<double> times_s;         ///< of files that have them, in the file's clock
  DeclaredClock declared_clock = DeclaredClock::none;  ///< which is this, if the file declares it
  /// Of files without sensor positions (read_file_part()): why they are one scan.
  std::optional<SensorFrame> sensor_frame;
  std::vector<Vec3f> scan_origins;      ///< of sequences with an origin per point, sensor frames
  std::vector<std::uint16_t> in_boxes;  ///< KittiScan::in_boxes; empty: none
  std::vector<std::string> remarks;     ///< warnings on columns, without the file's name
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

/// Reads the chosen scans of a sequence; `first_scan_index` is the number of the first.
CloudPart read_sequence_part(const KittiSequence& sequence, const LoadOptions& options,
                             std::uint32_t first_scan_index, const Executor& executor,
                             ProgressSink& progress);
/// Opens a sequence folder and recognises its beams (unless beams_from_poses). Errors: those of
/// open_kitti_sequence and verify_poses.
KittiSequence open_sequence(const std::filesystem::path& folder, const LoadOptions& options,
                            const Executor& executor);

/// Reads a file of points, on the threads of `executor` if given.
CloudPart read_file_part(const std::filesystem::path& path, const LoadOptions& options,
                         ProgressSink& progress, const Executor* executor = nullptr);

/// Points at exactly 0, 0, 0 in a grid of beams, or at least 100 and a thousandth of all, are
/// missing returns: they become NaN, as PCL writes them.
void mark_missing_returns(const Table& table, std::vector<Vec3d>& positions);

/// The same for columns in memory, with points at 0, 0, 0 as they are; `path` is for messages.
CloudPart part_of_table(const std::filesystem::path& path, const Table& table,
                        const LoadOptions& options, ProgressSink& progress);

}  // namespace adasplats
