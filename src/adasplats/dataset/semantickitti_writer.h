// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Writes scans as a SemanticKITTI sequence folder: velodyne/NNNNNN.bin, labels/NNNNNN.label (where
/// the scans have classes), poses.txt (camera frame), calib.txt (with a Tr), times.txt (where the
/// times ascend). Every file is atomic; poses come last, in finish(), so a folder with poses is
/// whole, and the same scans written again after an interruption give the same bytes.
class SemanticKittiWriter {
 public:
  /// `sequence_folder` is created; the parent must exist or be creatable. `more_poses`: a file that
  /// gets the text of poses.txt, too; empty: none.
  /// Errors: cannot_create (also where the folder already holds a whole sequence).
  explicit SemanticKittiWriter(std::filesystem::path sequence_folder,
                               std::filesystem::path more_poses = {});

  /// The files of scan number `index`, named relative to the sequence folder. Several threads may
  /// call it at once. `order`: which point is the i-th; empty: the i-th.
  static EncodedScan encode(std::size_t index, const ScanView& scan,
                            std::span<const std::uint32_t> order = {});
  /// Scan number `index` is written: its pose is kept for finish(). One call at a time. Scans have
  /// classes all or none (std::logic_error otherwise; empty ones fit both).
  void note_written(std::size_t index, const EncodedScan& scan);
  /// Encodes, writes and notes scan number `index`. One call at a time.
  void write_scan(std::size_t index, const ScanView& scan);
  /// Scan number `index` was written before an interruption: keeps its pose for finish(). Throws
  /// Errors of kind io where its files are missing or have other numbers of points.
  void keep_scan(std::size_t index, const TimedPose& pose);
  /// Every index from 0 to the largest must have been written (std::logic_error otherwise).
  void finish();

 private:
  void require_alike(const EncodedScan& scan);
  void note(std::size_t index, const TimedPose& pose, std::size_t points);

  std::filesystem::path folder_, more_poses_;
  Trajectory trajectory_;                                 ///< by index
  std::vector<std::optional<std::size_t>> point_counts_;  ///< by index; nothing: not written yet
  bool has_labels_ = false;
  bool has_unlabelled_ = false;
};

}  // namespace adasplats
