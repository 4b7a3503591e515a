// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/evaluate/realism/ring_scan.h"

namespace adasplats {

/// Longer runs of beams without return are sky or out of range, not drop-outs.
inline constexpr std::uint32_t kLongestRun = 20;
inline constexpr std::size_t kPlaneRings = 8;

/// Beams without return in runs of at most kLongestRun: ring by ring, column by column (azimuth in
/// steps).
struct MissingBeams {
  std::size_t columns = 0;
  std::vector<std::uint8_t> at;  ///< rings x columns

  MissingBeams(const RingScan& scan, double step_rad);
  /// Whether there is one in this or an adjacent column.
  bool near(std::size_t ring, std::size_t column) const;
};

/// Rings [first_ring, end_ring) of a scan from one azimuth to another.
struct PartOfScan {
  std::size_t first_ring = 0, end_ring = 0;
  double begin_rad = 0, end_rad = 0;
};

/// Deviations of the ranges of eight rings from the best plane in a small piece.
struct PlanePiece {
  std::size_t first_ring = 0;
  std::array<double, kPlaneRings> ring_m{};  ///< mean of each ring's range errors; NaN: too few
  double within_m = 0;                       ///< RMS of ranges about the mean of their ring
  double between_m = 0;                      ///< RMS of the rings' means
};

/// Counts in a part of a scan, from which features are computed. Absolute second differences are
/// those of three neighbouring beams of a ring that returned from one surface (ranges less than 0.3
/// m apart).
struct PartCounts {
  std::size_t beams = 0;  ///< estimate of the fired beams
  std::size_t returns = 0;
  std::vector<float> ranges_m, intensities;       ///< ascending
  std::vector<float> second_m, second_intensity;  ///< ascending
  double square_m2 = 0, product_m2 = 0;           ///< of signed ones, and of neighbouring ones
  double square_intensity = 0, product_intensity = 0;
  std::vector<double> ring_second_m;   ///< mean middle half, of each ring with enough of them
  std::vector<double> ring_intensity;  ///< median of each ring; NaN: too few returns
  std::vector<double> ring_missing;    ///< share of its beams
  double gap_steps = 0, gap_square_steps2 = 0;  ///< azimuths from one neighbour to the next
  std::size_t neighbors = 0;                    ///< pairs of neighbouring beams that both returned
  std::size_t edges = 0;                        ///< of these, ranges more than 0.5 m apart
  std::size_t triples = 0;                      ///< three neighbours with return
  std::size_t between = 0;   ///< of these, the middle one by 0.3 m between the others' ranges
  std::size_t isolated = 0;  ///< by 0.3 m nearer or farther than both
  std::size_t runs_of_1 = 0, runs_to_5 = 0, runs_to_20 = 0;  ///< of beams without return
  std::size_t runs_at_edges = 0;    ///< of these runs, with ranges 0.5 m apart on both sides
  std::size_t missing = 0;          ///< beams in these runs
  std::size_t missing_6_to_20 = 0;  ///< of these, in runs that long
  std::size_t nothing = 0;          ///< beams without return in longer runs
  std::size_t missing_above = 0, missing_across = 0;  ///< missing with a ring below; there, too
  std::size_t known = 0;                              ///< returns with an intensity
  std::size_t zeros = 0;                              ///< of these, with intensity 0
  std::size_t zero_pairs = 0, zero_next = 0;          ///< neighbours of a zero; that are zero
  std::size_t known_pairs = 0, equal = 0;             ///< neighbours with intensities; the same one
  std::vector<PlanePiece> planes;

  /// Deviation of the gaps between neighbours, in steps; NaN without any.
  double gap_deviation() const;
};

/// Counts in one part. Requires count_missing().
PartCounts count_part(const RingScan& scan, const MissingBeams& missing, const PartOfScan& part,
                      double step_rad);

/// The quantile of ascending values; NaN without values.
double quantile_of(std::span<const float> ascending, double share);
/// Mean of ascending values between two quantiles; NaN without values. Unlike a quantile, it does
/// not jump in the millimetre steps of ranges.
double mean_between(std::span<const float> ascending, double from, double to);
/// Median of values in any order, without NaN; NaN without values.
double median_of_known(std::vector<double> values);

}  // namespace adasplats
