// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace adasplats {
namespace {

using Counts = PartCounts;
constexpr FeatureGroup kOfContext = FeatureGroup::context;
constexpr FeatureGroup kOfGeometry = FeatureGroup::geometry;
constexpr FeatureGroup kOfDropout = FeatureGroup::dropout;
constexpr FeatureGroup kOfIntensity = FeatureGroup::intensity;

constexpr double kNoFeature = std::numeric_limits<double>::quiet_NaN();

double ratio(double of, double all) { return all > 0 ? of / all : kNoFeature; }
double ratio(std::size_t of, std::size_t all) {
  return ratio(static_cast<double>(of), static_cast<double>(all));
}

/// Logarithm of lengths and intensities that may be zero.
double log_of_small(double value) { return std::log(std::max(value, 1e-4)); }

double deviation_of(const std::vector<double>& values) {
  double count = 0, sum = 0, squares = 0;
  for (const double value : values) {
    if (value != value) continue;
    ++count;
    sum += value;
    squares += value * value;
  }
  if (count < 3) return kNoFeature;
  return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

double median_of_pieces(const Counts& counts, double (*of)(const PlanePiece&)) {
  std::vector<double> values;
  for (const PlanePiece& piece : counts.planes) values.push_back(of(piece));
  return median_of_known(std::move(values));
}

/// Differences of rings from the mean of the rings above and below.
std::vector<double> steps_between_rings(const std::vector<double>& values) {
  std::vector<double> steps;
  for (std::size_t ring = 1; ring + 1 < values.size(); ++ring)
    steps.push_back(values[ring] - 0.5 * (values[ring - 1] + values[ring + 1]));
  return steps;
}

double mean_size(const std::vector<double>& values) {
  double sum = 0, count = 0;
  for (const double value : values) {
    if (value != value) continue;
    sum += std::fabs(value);
    ++count;
  }
  return ratio(sum, count);
}

/// The deviation of one range or intensity, by absolute second differences of white noise: their
/// middle half has a mean of 4 (phi(0.3186) - phi(1.1503)) = 0.6933 deviations, of normal values
/// from the 25th to the 75th percentile, and they are sqrt(1 + 4 + 1) wider.
double deviation_of_one(std::span<const float> second) {
  return mean_between(second, 0.25, 0.75) / 0.6933 / std::sqrt(6.0);
}

/// Intensities come in steps, stored in files as the nearest float or its neighbour; this
/// difference is not due to the sensor. 0.37: no hundredth, nor half or sixth of one, is on the
/// border of two steps.
double to_thousandths(double value) { return 0.001 * std::floor(1000 * value + 0.37); }

double piece_between(const PlanePiece& piece) { return log_of_small(piece.between_m); }
double piece_within(const PlanePiece& piece) { return log_of_small(piece.within_m); }

std::vector<double> logs_of(std::vector<double> values) {
  for (double& value : values) value = log_of_small(value);
  return values;
}

constexpr PatchFeature kPatchFeatures[] = {
    {"range_about", kOfContext, "logarithm of the median range in steps of 0.2",
     [](const Counts& c) {
       return 0.2 * std::round(5 * log_of_small(quantile_of(c.ranges_m, 0.5)));
     }},

    {"range_least", kOfGeometry, "logarithm of the minimum range",
     [](const Counts& c) { return log_of_small(quantile_of(c.ranges_m, 0)); }},
    {"range_most", kOfGeometry, "logarithm of the maximum range",
     [](const Counts& c) { return log_of_small(quantile_of(c.ranges_m, 1)); }},
    {"second_low", kOfGeometry, "logarithm of the mean lower half of second differences of range",
     [](const Counts& c) { return log_of_small(mean_between(c.second_m, 0, 0.5)); }},
    {"second_middle", kOfGeometry, "of the mean of their middle half",
     [](const Counts& c) { return log_of_small(mean_between(c.second_m, 0.25, 0.75)); }},
    {"second_high", kOfGeometry, "of the mean from their median to their 90th percentile",
     [](const Counts& c) { return log_of_small(mean_between(c.second_m, 0.5, 0.9)); }},
    {"second_most", kOfGeometry, "of the mean of their highest tenth",
     [](const Counts& c) { return log_of_small(mean_between(c.second_m, 0.9, 1)); }},
    {"second_lag", kOfGeometry, "correlation of neighbouring ones (white noise: -2/3)",
     [](const Counts& c) { return ratio(c.product_m2, c.square_m2); }},
    {"second_rings", kOfGeometry, "deviation over rings of the logarithm of second_middle",
     [](const Counts& c) { return deviation_of(logs_of(c.ring_second_m)); }},
    {"rings_off_plane", kOfGeometry, "logarithm of the spread of rings about planes",
     [](const Counts& c) { return median_of_pieces(c, piece_between); }},
    {"beams_off_plane", kOfGeometry, "logarithm of the spread of a ring's ranges there",
     [](const Counts& c) { return median_of_pieces(c, piece_within); }},
    {"planes", kOfGeometry, "pieces that are planes, per return",
     [](const Counts& c) { return ratio(c.planes.size(), c.returns); }},
    {"edges", kOfGeometry, "share of neighbours with ranges 0.5 m apart",
     [](const Counts& c) { return ratio(c.edges, c.neighbors); }},
    {"between", kOfGeometry, "share of returns between their neighbours by 0.3 m",
     [](const Counts& c) { return ratio(c.between, c.triples); }},
    {"isolated", kOfGeometry, "share of returns nearer or farther than both neighbours by 0.3 m",
     [](const Counts& c) { return ratio(c.isolated, c.triples); }},

    {"missing", kOfDropout,
     "share of beams without return in runs of at most 20, of these and the returns",
     [](const Counts& c) { return ratio(c.missing, c.missing + c.returns); }},
    {"nothing", kOfDropout, "share of beams without return in longer runs",
     [](const Counts& c) { return ratio(c.nothing, c.beams); }},
    {"runs_of_1", kOfDropout, "runs of one beam without return, per return",
     [](const Counts& c) { return ratio(c.runs_of_1, c.returns); }},
    {"runs_to_5", kOfDropout, "runs of two to five",
     [](const Counts& c) { return ratio(c.runs_to_5, c.returns); }},
    {"runs_to_20", kOfDropout, "runs of six to twenty",
     [](const Counts& c) { return ratio(c.runs_to_20, c.returns); }},
    {"missing_next", kOfDropout, "share of beams without return that are followed by another one",
     [](const Counts& c) {
       return ratio(c.missing - c.runs_of_1 - c.runs_to_5 - c.runs_to_20, c.missing);
     }},
    {"missing_below", kOfDropout,
     "share of beams without return with another one in the ring below",
     [](const Counts& c) { return ratio(c.missing_across, c.missing_above); }},
    {"missing_rings", kOfDropout, "deviation over rings of the share of missing beams",
     [](const Counts& c) { return deviation_of(c.ring_missing); }},
    {"runs_at_edges", kOfDropout, "share of runs with ranges 0.5 m apart on both sides",
     [](const Counts& c) {
       return ratio(c.runs_at_edges, c.runs_of_1 + c.runs_to_5 + c.runs_to_20);
     }},

    {"intensity_10", kOfIntensity, "10th percentile",
     [](const Counts& c) { return to_thousandths(quantile_of(c.intensities, 0.1)); }},
    {"intensity_50", kOfIntensity, "median",
     [](const Counts& c) { return to_thousandths(quantile_of(c.intensities, 0.5)); }},
    {"intensity_90", kOfIntensity, "90th percentile",
     [](const Counts& c) { return to_thousandths(quantile_of(c.intensities, 0.9)); }},
    {"intensity_most", kOfIntensity, "the highest",
     [](const Counts& c) { return to_thousandths(quantile_of(c.intensities, 1)); }},
    {"zeros", kOfIntensity, "share of zero intensities",
     [](const Counts& c) { return ratio(c.zeros, c.known); }},
    {"zero_next", kOfIntensity, "share of zeros among neighbours of zeros",
     [](const Counts& c) { return ratio(c.zero_next, c.zero_pairs); }},
    {"equal", kOfIntensity, "share of neighbours with the same intensity",
     [](const Counts& c) { return ratio(c.equal, c.known_pairs); }},
    {"intensity_second_50", kOfIntensity, "median second difference of intensity",
     [](const Counts& c) { return to_thousandths(quantile_of(c.second_intensity, 0.5)); }},
    {"intensity_second_90", kOfIntensity, "its 90th percentile",
     [](const Counts& c) { return to_thousandths(quantile_of(c.second_intensity, 0.9)); }},
    {"intensity_second_lag", kOfIntensity, "correlation of neighbouring ones",
     [](const Counts& c) { return ratio(c.product_intensity, c.square_intensity); }},
    {"intensity_rings", kOfIntensity, "mean difference of a ring's median from adjacent rings",
     [](const Counts& c) {
       return to_thousandths(mean_size(steps_between_rings(c.ring_intensity)));
     }},
};

constexpr ScanStatistic kScanStatistics[] = {
    {"returns", "", "returns of a scan"},
    {"range_noise_m", "m", "noise of ranges, by second differences along rings"},
    {"laser_offsets_m", "m", "deviation of single lasers' ranges about planes"},
    {"missing", "", "beams without return in runs of at most 20"},
    {"missing_runs_of_1", "", "of these in runs of one"},
    {"missing_runs_6_to_20", "", "of these in runs of 6 to 20"},
    {"intensity_noise", "", "noise of intensities, by second differences along rings"},
    {"intensity_rings", "", "deviation of rings' median intensities from adjacent rings"},
    {"intensity_zeros", "", "share of returns with intensity zero"},
    {"intensity_zero_next", "", "probability that the next one is zero after a zero"},
    {"intensity_most", "", "maximum intensity"},
    {"range_most_m", "m", "maximum range"},
    {"azimuth_jitter", "", "deviation of azimuths from one firing to the next, in steps"},
    {"near_points", "", "points nearer than 2.5 m, mostly on the vehicle itself"},
    {"unfolded_rings", "", "rings that 'scan unfolding' finds in the file"},
};

/// Deviation over lasers of the median error of their ranges about planes of eight rings (the
/// median, because some pieces are bent). A plane removes two of eight degrees of freedom across
/// the rings, which is corrected.
double laser_offsets(const std::vector<PlanePiece>& pieces, std::size_t rings) {
  constexpr std::size_t kMinPieces = 10;
  std::vector<std::vector<double>> errors_m(rings);
  for (const PlanePiece& piece : pieces)
    for (std::size_t k = 0; k < kPlaneRings; ++k)
      if (piece.ring_m[k] == piece.ring_m[k])
        errors_m[piece.first_ring + k].push_back(piece.ring_m[k]);
  std::vector<double> medians_m;
  for (std::vector<double>& of_ring : errors_m)
    if (of_ring.size() >= kMinPieces) medians_m.push_back(median_of_known(std::move(of_ring)));
  constexpr double kDegreesOfFreedom = static_cast<double>(kPlaneRings);
  return deviation_of(medians_m) * std::sqrt(kDegreesOfFreedom / (kDegreesOfFreedom - 2));
}

}  // namespace

std::span<const PatchFeature> patch_features() { return kPatchFeatures; }

std::vector<float> features_of_patches(const RingScan& scan, double step_rad) {
  const double turn_rad = 2 * std::numbers::pi;
  const auto sectors = static_cast<std::size_t>(
      std::max(1.0, std::round(turn_rad / (static_cast<double>(kPatchColumns) * step_rad))));
  const MissingBeams missing(scan, step_rad);
  std::vector<float> values;
  for (std::size_t ring = 0; ring + kPatchRings <= scan.rings(); ring += kPatchRings) {
    for (std::size_t sector = 0; sector < sectors; ++sector) {
      const double share = turn_rad / static_cast<double>(sectors);
      const PartOfScan part = {ring, ring + kPatchRings, static_cast<double>(sector) * share,
                               static_cast<double>(sector + 1) * share};
      const PartCounts counts = count_part(scan, missing, part, step_rad);
      if (counts.returns < kMinInPatch) continue;
      for (const PatchFeature& feature : kPatchFeatures)
        values.push_back(static_cast<float>(feature.of(counts)));
    }
  }
  return values;
}

std::span<const ScanStatistic> scan_statistics() { return kScanStatistics; }

std::vector<double> statistics_of_scan(const RingScan& scan, double step_rad,
                                       const ScanFile& file) {
  const MissingBeams missing(scan, step_rad);
  const PartOfScan all = {0, scan.rings(), 0, 2 * std::numbers::pi + step_rad};
  const PartCounts counts = count_part(scan, missing, all, step_rad);
  return {static_cast<double>(counts.returns),
          deviation_of_one(counts.second_m),
          laser_offsets(counts.planes, scan.rings()),
          static_cast<double>(counts.missing),
          static_cast<double>(counts.runs_of_1),
          static_cast<double>(counts.missing_6_to_20),
          deviation_of_one(counts.second_intensity),
          deviation_of(steps_between_rings(counts.ring_intensity)),
          ratio(counts.zeros, counts.known),
          ratio(counts.zero_next, counts.zero_pairs),
          quantile_of(counts.intensities, 1),
          quantile_of(counts.ranges_m, 1),
          counts.gap_deviation(),
          static_cast<double>(file.near_points),
          static_cast<double>(file.unfolded_rings)};
}

}  // namespace adasplats
