// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/load/file_scan.h"

namespace adasplats {

/// Whether intensities of a drive are bytes, which become shares of 1 as those of KITTI are: all
/// are whole numbers from 0 to 255, and one is above 1. Else they stay as they are.
class IntensityScale {
 public:
  /// Told by some of its scans.
  explicit IntensityScale(std::span<const std::vector<float>> sample);

  /// Errors: data where the intensities of one more scan contradict those that told the scale.
  std::vector<float> scaled(std::vector<float> intensities,
                            const std::filesystem::path& file) const;
  std::string description() const;

 private:
  bool is_bytes_ = false;
  bool are_shares_ = false;  ///< none of the sample is above 1
};

/// Told by the first scan, the one in the middle and the last.
IntensityScale scale_of_scans(const ScanSource& source,
                              const std::vector<std::filesystem::path>& files);

}  // namespace adasplats
