// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// How scans lie on each other with the translations of the poses times a factor.
struct ScaleEvidence {
  double factor = 1;
  std::size_t pairs = 0;       ///< of scans 3 to 15 m apart, were the factor right
  std::size_t points = 0;      ///< on upright things in the later scans of the pairs
  std::size_t met = 0;         ///< of these, how many meet the earlier scan with the factor
  std::size_t met_given = 0;   ///< with the poses as given
  std::size_t met_turned = 0;  ///< with the rotations alone

  /// Whether the factor is right, and the poses as given are not.
  bool contradicts() const;
};

/// How the scans of a sequence lie on each other: with the poses as they are, and as faults that
/// poses commonly have would have it.
struct PoseEvidence {
  /// As given, without motion (points that are in world coordinates already), poses of the camera
  /// taken for the LiDAR's, the LiDAR's taken for the camera's, inverse poses.
  static constexpr std::size_t kWays = 5;

  std::size_t pairs = 0;                 ///< of scans that could be judged
  std::size_t points = 0;                ///< on upright things in the later scans of the pairs
  std::array<std::size_t, kWays> met{};  ///< of these, how many meet the earlier scan
  std::size_t met_turned = 0;            ///< the same with the rotations of the poses alone

  /// Share of the points that meet, 0 to 1; 0 without points.
  double share(std::size_t way) const;
  /// The way other than the given one that most points meet in.
  std::size_t best_other() const;
  /// Whether the poses cannot be those of the scans.
  bool contradicts() const;
  /// Whether the translations of the poses are seen to be right: far better than none.
  bool confirms() const;
};

/// Up to four pairs of scans, earlier and later, that are 3 to 15 m apart.
std::vector<std::pair<std::size_t, std::size_t>> scan_pairs(const Trajectory& trajectory);

/// Judges up to four pairs of scans that are 3 to 15 m apart by their poses. Ground looks the same
/// from everywhere, so only points in columns of 1 m that something of at least 1 m fills count. A
/// vehicle that stands, scans farther apart and places without upright things give no pairs,
/// nor do scans that cannot be read.
PoseEvidence weigh_poses(const KittiSequence& sequence, const Executor& executor);

/// Judges translations in other units than metres (millimetres, centimetres, decimetres, feet, and
/// what metres taken for these become): for each factor up to four pairs that are 3 to 15 m apart
/// by it. Without a pair there is no entry.
std::vector<ScaleEvidence> weigh_scales(const KittiSequence& sequence, const Executor& executor);

/// Throws data if the poses of consecutive scans are farther apart than a vehicle drives
/// (find_pose_jump()). Scans that the numbers in their names show as dropped are accepted.
void require_no_jump(const KittiSequence& sequence);

/// require_no_jump(). Throws data with the figures where weigh_poses(sequence) contradicts, or,
/// unless it confirms, mirrored or exchanged axes or a factor of weigh_scales(sequence) do; also
/// where the times of the poses are no seconds: neighbouring scans more than 20 s apart and a
/// vehicle slower than 0.5 m/s, or less than 2 ms and faster than 150 m/s; and where the poses
/// stand but no two distant scans align. Returns in one line what could not be checked; empty: all
/// was.
std::string verify_poses(const KittiSequence& sequence, const Executor& executor);

}  // namespace adasplats
