// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/synth/city/synth_city.h"

// Private to synth/city/: where on a drive scans are made.

namespace adasplats {

/// Positions of scans, batch by batch. With a fixed spacing they are known in advance. With a
/// target number of points, each batch uses the spacing at which the remaining scans, with the mean
/// number of points so far, end with the drive.
class ScanSchedule {
 public:
  /// `rays`: rays of one scan. Errors: usage.
  ScanSchedule(const SynthCityOptions& options, std::size_t rays);

  /// Positions of the next scans along the drive, m: at max_scans `max_scans`, over at max_scans
  /// `way_m` (but at least one scan); empty at the end of the drive. `points`: total of all scans
  /// so far.
  std::vector<double> next(std::size_t max_scans, double way_m, std::size_t points);
  /// The positions that the next call of next() will probably return.
  std::vector<double> preview(std::size_t max_scans, double way_m) const;
  /// Number of positions returned so far.
  std::size_t scans() const { return scans_; }

 private:
  double length_m_;
  double spacing_m_;
  double points_;  ///< target number of points; 0: fixed spacing
  double mean_points_;
  double next_m_ = 0;
  std::size_t scans_ = 0;
};

}  // namespace adasplats
