// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/calibrate/windows.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/pipeline/session/repeated_warnings.h"
#include "adasplats/pipeline/session/session.h"

namespace adasplats {

/// Drives that are too long to stand in memory, read some scans at a time by load_cloud.
class DrivePieces {
 public:
  /// Nothing where the drives are to be loaded at once: all of them are no longer than
  /// `window_scans`, or one is not a sequence folder of KITTI's layout (of others it takes all
  /// points to tell the scans). Opens the sequences. Errors: those of load_cloud for them.
  static std::optional<DrivePieces> open(std::span<const std::filesystem::path> inputs,
                                         const LoadOptions& load, std::size_t window_scans,
                                         Session& session);

  /// Valid while this lives.
  std::vector<DriveSource> sources();
  /// Of what was read so far, every scan counted once; its drives are complete from the beginning.
  const LoadReport& report() const { return report_; }
  /// Tells the session how often warnings of single pieces were repeated.
  void end();

 private:
  DrivePieces(const LoadOptions& load, Session& session);
  PointCloud read(std::size_t drive, ScanSpan span);
  void count(const LoadReport& piece);

  LoadOptions load_;
  Session* session_;
  std::shared_ptr<RepeatedWarnings> warnings_;
  LoadReport report_;
  std::vector<std::vector<bool>> is_counted_;  ///< of drives, scan by scan
};

}  // namespace adasplats
