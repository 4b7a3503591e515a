// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "adasplats/cloud/trajectory.h"
#include "adasplats/simulate/scan.h"

namespace adasplats {

/// Writes scans as a SemanticKITTI sequence folder: velodyne/NNNNNN.bin, labels/NNNNNN.label,
/// poses.txt (camera frame), calib.txt (with a Tr), times.txt. Every file is atomic; poses come
/// last, in finish(), so a folder with poses is whole.
class SemanticKittiWriter {
 public:
  /// `sequence_folder` is created; the parent must exist or be creatable.
  explicit SemanticKittiWriter(std::filesystem::path sequence_folder);

  /// Writes scan number `index`; the pose is kept for finish().
  void write_scan(std::size_t index, const Scan& scan);
  void finish();

 private:
  std::filesystem::path folder_;
  Trajectory trajectory_;  ///< by index
};

/// One scan as a PLY in the sensor frame: x y z [intensity] [label] [instance] ring time range.
void write_scan_ply(const std::filesystem::path& path, const Scan& scan);

/// One scan as .npy: PATH (float32, N x 4: x y z intensity) and PATH with "_label" before the
/// extension (uint32, N: instance << 16 | class).
void write_scan_npy(const std::filesystem::path& path, const Scan& scan);

}  // namespace adasplats
