// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// The texts of calib.txt (with a Tr), poses.txt (camera frame) and times.txt of a sequence.
struct SemanticKittiPoses {
  std::string calib, poses, times;
};
/// `trajectory`: world_from_velodyne of each scan.
SemanticKittiPoses semantickitti_poses(const Trajectory& trajectory);

/// Writes scans as a SemanticKITTI sequence folder: velodyne/NNNNNN.bin, labels/NNNNNN.label (if
/// the scans have classes), poses.txt (camera frame), calib.txt (with a Tr), times.txt (if the
/// times ascend). Every file is atomic; poses are written last, in finish(), so a folder with poses
/// is complete. A resumed run gives the same bytes.
class SemanticKittiWriter {
 public:
  /// Creates `sequence_folder` and its parents. `more_poses`: a file for a copy of poses.txt;
  /// empty: none. Errors: cannot_create (also if the folder already contains a complete sequence).
  explicit SemanticKittiWriter(std::filesystem::path sequence_folder,
                               std::filesystem::path more_poses = {});

  /// The files of scan number `index`, named relative to the sequence folder. Thread-safe. `order`:
  /// indices of the points; empty: as in the scan.
  static EncodedScan encode(std::size_t index, const ScanView& scan,
                            std::span<const std::uint32_t> order = {});
  /// Stores the pose of the written scan number `index` for finish(). Not thread-safe. Either all
  /// or no scans have classes (otherwise std::logic_error); empty scans fit both.
  void note_written(std::size_t index, const EncodedScan& scan);
  /// Encodes, writes and records scan number `index`. Not thread-safe.
  void write_scan(std::size_t index, const ScanView& scan);
  /// Stores the pose of scan number `index`, which was written before an interruption, for
  /// finish(). Errors: io (its files are missing or have different numbers of points).
  void keep_scan(std::size_t index, const TimedPose& pose);
  /// Every index from 0 to the largest must have been written (std::logic_error otherwise).
  void finish();

 private:
  void require_alike(const EncodedScan& scan);
  void note(std::size_t index, const TimedPose& pose, std::size_t points);

  std::filesystem::path folder_, more_poses_;
  Trajectory trajectory_;                                 ///< by index
  std::vector<std::optional<std::size_t>> point_counts_;  ///< by index; empty: not written yet
  bool has_labels_ = false;
  bool has_unlabelled_ = false;
};

}  // namespace adasplats
