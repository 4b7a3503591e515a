// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/scan_schedule.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kDefaultSpacing_m = 1;
constexpr double kReturningShare = 0.85;  // expected share of rays that return
constexpr double kMaxScans = 1e6;         // file names have six digits
constexpr double kMinSpacing_m = 0.001;

}  // namespace

ScanSchedule::ScanSchedule(const SynthCityOptions& options, std::size_t rays)
    : length_m_(options.length_m),
      spacing_m_(options.spacing_m.value_or(kDefaultSpacing_m)),
      points_(options.points.value_or(0)),
      mean_points_(kReturningShare * static_cast<double>(rays)) {
  if (options.points && options.spacing_m)
    throw Error(ErrorKind::usage, "`points` and `spacing` exclude each other; use one of them");
  // Scans may have fewer points than expected, which adds scans.
  const double scans = options.points ? 2 * points_ / mean_points_ : length_m_ / spacing_m_ + 1;
  if (scans > kMaxScans)
    throw Error(ErrorKind::usage,
                "the drive has more than " + std::to_string(static_cast<long>(kMaxScans)) +
                    " scans; increase `spacing`, or make several cities with different `seed`");
  if (options.points && length_m_ / scans < kMinSpacing_m)
    throw Error(ErrorKind::usage,
                "the scans are less than 1 mm apart; decrease `points` or increase `length`");
}

std::vector<double> ScanSchedule::next(std::size_t max_scans, double way_m, std::size_t points) {
  if (points_ > 0) {
    if (scans_ > 0)
      mean_points_ = std::max(1.0, static_cast<double>(points) / static_cast<double>(scans_));
    const double left = std::round((points_ - static_cast<double>(points)) / mean_points_);
    if (left < 1 && scans_ > 0) return {};
    // At max_scans half of the remaining scans, so that the total is right to within one scan.
    const double scans = std::max(1.0, left);
    max_scans = std::min(max_scans, static_cast<std::size_t>(std::ceil(0.5 * scans)));
    if (scans_ == 0) {
      spacing_m_ = length_m_ / scans;
    } else {
      const double last = next_m_ - spacing_m_;
      spacing_m_ = (length_m_ - last) / scans;
      next_m_ = last + spacing_m_;
    }
  }
  std::vector<double> positions = preview(max_scans, way_m);
  scans_ += positions.size();
  next_m_ += spacing_m_ * static_cast<double>(positions.size());
  return positions;
}

std::vector<double> ScanSchedule::preview(std::size_t max_scans, double way_m) const {
  std::vector<double> positions;
  for (std::size_t k = 0; k < max_scans; ++k) {
    const double on = spacing_m_ * static_cast<double>(k);
    if (next_m_ + on > length_m_ + 1e-6 || (k > 0 && on > way_m)) break;
    positions.push_back(next_m_ + on);
  }
  return positions;
}

}  // namespace adasplats
