// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/synth/city/synth_city.h"

// Inside synth/city/: where on a drive scans are made.

namespace adasplats {

/// Gives the places of scans batch by batch. With a spacing they are known from the start; with a
/// number of points each batch takes the spacing by which the scans that are left, with as many
/// points as those before had on average, end with the drive.
class CityPace {
 public:
  /// `rays`: of one scan. Errors: usage.
  CityPace(const SynthCityOptions& options, std::size_t rays);

  /// The places of the next scans, m of the drive, at most `most` and over at most `way_m` (but
  /// one at least); none: all are done. `points`: of all scans before.
  std::vector<double> next(std::size_t most, double way_m, std::size_t points);
  /// What next() will probably give then; changes nothing.
  std::vector<double> foreseen(std::size_t most, double way_m) const;
  /// Of places that were given.
  std::size_t scans() const { return scans_; }

 private:
  double length_m_;
  double spacing_m_;
  double points_;  ///< 0: the spacing is given
  double mean_points_;
  double next_m_ = 0;
  std::size_t scans_ = 0;
};

}  // namespace adasplats
