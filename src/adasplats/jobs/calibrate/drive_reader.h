// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "adasplats/calibrate/windows.h"
#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/jobs/session/repeated_warnings.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Reads drives that do not fit in memory, some scans at a time.
class DriveReader {
 public:
  /// Empty if the inputs can be loaded at once: not all of them are drives, or none is longer than
  /// `window_scans`. `inputs` must outlive it.
  static std::optional<DriveReader> of(const OpenInputs& inputs, std::size_t window_scans,
                                       Session& session);

  /// Valid while this lives.
  std::vector<DriveSource> sources();
  /// Of what was read so far, every scan counted once; its drives are complete from the beginning.
  const LoadReport& report() const { return report_; }
  /// Reports to the session how often warnings of single parts were repeated.
  void end();

 private:
  DriveReader(const OpenInputs& inputs, Session& session);
  PointCloud read(std::size_t drive, ScanSpan span);

  const OpenInputs* inputs_;
  Session* session_;
  std::shared_ptr<RepeatedWarnings> warnings_;
  LoadReport report_;
  std::vector<std::vector<bool>> is_counted_;  ///< of drives, scan by scan
};

}  // namespace adasplats
