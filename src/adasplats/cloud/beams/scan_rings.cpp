// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/beams/scan_rings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "adasplats/cloud/points/scan_runs.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

/// Of the histogram of elevations: a fifth of the narrowest gap between rings (0.1 degrees, of
/// sensors with 128).
constexpr double kRingBin_rad = 0.02 * kDegree;
/// Directions so near are two returns of one beam: a tenth of the finest steps of azimuth.
constexpr double kSameBeam_rad = 1e-4;
/// Points of a scan that its axis is found from, and those whose neighbours are looked for.
constexpr std::size_t kAxisPoints = 20'000;
constexpr std::size_t kNeighbourPoints = 1000;
/// Points of a scan that say where the rings of the recording are.
constexpr std::size_t kPooledPoints = 2000;

/// One of each of `most` equal parts of the values, at random: a stride could meet the same ring
/// again and again where points come in the order of firing.
std::vector<Vec3d> thinned(std::span<const Vec3d> values, std::size_t most) {
  if (values.size() <= most) return {values.begin(), values.end()};
  std::vector<Vec3d> kept(most);
  const double part = static_cast<double>(values.size()) / static_cast<double>(most);
  for (std::size_t k = 0; k < most; ++k) {
    Random random(0, 0, k);
    const auto at = static_cast<std::size_t>((static_cast<double>(k) + random.uniform()) * part);
    kept[k] = values[std::min(at, values.size() - 1)];
  }
  return kept;
}

double elevation_about(Vec3d axis, Vec3d direction) {
  return std::asin(std::clamp(dot(axis, direction), -1.0, 1.0));
}

void add_square(SymmetricMat3d& sum, double weight, Vec3d v) {
  sum.xx += weight * v.x * v.x;
  sum.xy += weight * v.x * v.y;
  sum.xz += weight * v.x * v.z;
  sum.yy += weight * v.y * v.y;
  sum.yz += weight * v.y * v.z;
  sum.zz += weight * v.z * v.z;
}

Vec3d min_eigenvector(const SymmetricMat3d& m) { return symmetric_eigen(m).vectors[2]; }

Vec3d turned_up(Vec3d axis) { return axis.z < 0 ? -axis : axis; }

/// Unit vectors from some directions to their nearest ones, and across both.
struct Ways {
  std::vector<Vec3d> along, across;
};

Ways ways_to_neighbours(std::span<const Vec3d> directions) {
  // Rings about any axis but this one are spread along it, so that few are in a window.
  constexpr Vec3d kAlong{0.48, 0.6, 0.64};
  std::vector<std::pair<double, Vec3d>> sorted;
  sorted.reserve(directions.size());
  for (const Vec3d d : directions) sorted.emplace_back(dot(kAlong, d), d);
  std::ranges::sort(sorted, {}, [](const std::pair<double, Vec3d>& e) { return e.first; });
  const std::size_t stride = std::max<std::size_t>(1, sorted.size() / kNeighbourPoints);
  Ways ways;
  for (std::size_t at = stride / 2; at < sorted.size(); at += stride) {
    double best = 0.1;  // rad; farther ones are no neighbours
    Vec3d way{};
    const auto look = [&](std::size_t k) {
      if (std::fabs(sorted[k].first - sorted[at].first) > best) return false;
      const Vec3d to = sorted[k].second - sorted[at].second;
      const double distance = length(to);
      if (distance > kSameBeam_rad && distance < best) {
        best = distance;
        way = to / distance;
      }
      return true;
    };
    std::size_t up = at + 1, down = at;
    bool upwards = true, downwards = true;
    while (upwards || downwards) {
      upwards = upwards && up < sorted.size() && look(up++);
      downwards = downwards && down > 0 && look(--down);
    }
    if (!(dot(way, way) > 0)) continue;
    ways.along.push_back(way);
    ways.across.push_back(normalized(cross(sorted[at].second, way)));
  }
  return ways;
}

/// The axis that most of some unit vectors are at right angles to.
Vec3d axis_across(std::span<const Vec3d> ways) {
  constexpr int kRounds = 10;
  constexpr double kTight = 0.05;  // sine of what a way along a ring may be off
  Vec3d axis{};                    // the first round weighs all ways alike
  for (int round = 0; round < kRounds; ++round) {
    SymmetricMat3d sum;
    for (const Vec3d way : ways) {
      const double off = dot(axis, way);
      add_square(sum, 1 / (kTight * kTight + off * off), way);
    }
    axis = min_eigenvector(sum);
  }
  return turned_up(axis);
}

/// Peaks of the histogram of elevations, topmost first. A peak ends where half of it is left, and
/// the next one begins at twice the valley.
std::vector<double> peaks_of(std::span<const double> elevations_rad) {
  const auto bins = static_cast<std::size_t>(std::ceil(std::numbers::pi / kRingBin_rad)) + 2;
  const auto bin_of = [](double elevation_rad) {
    return static_cast<std::size_t>((elevation_rad + std::numbers::pi / 2) / kRingBin_rad) + 1;
  };
  std::vector<std::size_t> counts(bins + 1), smooth(bins + 1);
  std::vector<double> sums(bins + 1);
  for (const double elevation_rad : elevations_rad) {
    ++counts[bin_of(elevation_rad)];
    sums[bin_of(elevation_rad)] += elevation_rad;
  }
  for (std::size_t k = 1; k < bins; ++k) smooth[k] = counts[k - 1] + counts[k] + counts[k + 1];
  const std::size_t floor = std::max<std::size_t>(10, elevations_rad.size() / 2000);
  std::vector<double> peaks;
  std::size_t valley = 0, top = 0;  // bin of the peak that is climbed, 0: none
  for (std::size_t k = 1; k <= bins; ++k) {
    if (top == 0) {
      valley = std::min(valley, smooth[k]);
      if (smooth[k] >= 2 * valley + floor) top = k;
    } else if (smooth[k] > smooth[top]) {
      top = k;
    } else if (2 * smooth[k] < smooth[top]) {
      const double sum = sums[top - 1] + sums[top] + sums[top + 1];
      peaks.push_back(sum / static_cast<double>(smooth[top]));
      valley = smooth[k];
      top = 0;
    }
  }
  std::ranges::reverse(peaks);
  return peaks;
}

struct RingPlace {
  std::size_t ring;
  bool near;  ///< than an eighth of the gap to the next ring
};

/// `rings_rad`: topmost first, two at least.
RingPlace place_of(double elevation_rad, std::span<const double> rings_rad) {
  const auto below = std::ranges::lower_bound(rings_rad, elevation_rad, std::ranges::greater());
  const std::size_t last = rings_rad.size() - 1;
  const std::size_t lower =
      std::clamp<std::size_t>(static_cast<std::size_t>(below - rings_rad.begin()), 1, last);
  const double gap_rad = rings_rad[lower - 1] - rings_rad[lower];
  const double up_rad = std::fabs(elevation_rad - rings_rad[lower - 1]);
  const double down_rad = std::fabs(elevation_rad - rings_rad[lower]);
  return {up_rad < down_rad ? lower - 1 : lower, std::min(up_rad, down_rad) < gap_rad / 8};
}

double share_near(std::span<const double> elevations_rad, std::span<const double> rings_rad) {
  std::size_t near = 0;
  for (const double elevation_rad : elevations_rad)
    near += place_of(elevation_rad, rings_rad).near ? 1 : 0;
  return static_cast<double>(near) / static_cast<double>(elevations_rad.size());
}

std::vector<double> elevations_about(Vec3d axis, std::span<const Vec3d> directions) {
  std::vector<double> elevations_rad;
  elevations_rad.reserve(directions.size());
  for (const Vec3d d : directions) elevations_rad.push_back(elevation_about(axis, d));
  return elevations_rad;
}

/// The axis across the planes of the rings: least squares of (d - mean of its ring) along it.
Vec3d axis_of_planes(std::span<const Vec3d> directions, std::span<const double> elevations_rad,
                     std::span<const double> rings_rad) {
  std::vector<Vec3d> sums(rings_rad.size());
  std::vector<double> counts(rings_rad.size());
  SymmetricMat3d sum;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const RingPlace place = place_of(elevations_rad[k], rings_rad);
    if (!place.near) continue;
    add_square(sum, 1, directions[k]);
    sums[place.ring] = sums[place.ring] + directions[k];
    counts[place.ring] += 1;
  }
  for (std::size_t ring = 0; ring < sums.size(); ++ring)
    if (counts[ring] > 0) add_square(sum, -1 / counts[ring], sums[ring]);
  return turned_up(min_eigenvector(sum));
}

struct ScanAxis {
  Vec3d axis;
  double near = 0;  ///< share of the scan's points on rings of its own; 0: none
};

ScanAxis refined_axis(Vec3d axis, std::span<const Vec3d> directions,
                      const ScanRingOptions& options) {
  constexpr int kRounds = 4;
  ScanAxis best{axis, 0};
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> elevations_rad = elevations_about(axis, directions);
    const std::vector<double> rings_rad = peaks_of(elevations_rad);
    if (rings_rad.size() < options.min_rings) break;
    const double near = share_near(elevations_rad, rings_rad);
    if (near >= best.near) best = {axis, near};
    axis = axis_of_planes(directions, elevations_rad, rings_rad);
  }
  return best;
}

ScanAxis find_axis(std::span<const Vec3d> all, const std::optional<Vec3d>& pose_axis,
                   const ScanRingOptions& options) {
  const std::vector<Vec3d> directions = thinned(all, kAxisPoints);
  // Neighbours are of the same ring, or, where steps of azimuth are wider than the gaps between
  // rings, of the same column: these are in planes with the axis.
  const Ways ways = ways_to_neighbours(all);
  ScanAxis best = refined_axis(axis_across(ways.along), directions, options);
  for (const Vec3d guess :
       {axis_across(ways.across), pose_axis.value_or(Vec3d{0, 0, 1}), Vec3d{0, 0, 1}}) {
    if (best.near >= options.min_near) break;
    const ScanAxis other = refined_axis(guess, directions, options);
    if (other.near > best.near) best = other;
  }
  return best;
}

/// The frame of an axis. Its x looks upwards as far as it can, so that azimuths of a tilted sensor
/// do not depend on where its vehicle heads; along world x where the axis is vertical.
Mat3d frame_of_axis(Vec3d axis) {
  const Vec3d towards = std::fabs(axis.z) < 0.995 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d x = normalized(towards - dot(towards, axis) * axis);
  return Mat3d{{x, cross(axis, x), axis}}.transposed();
}

/// The scans with enough points, without rings.
std::vector<ScanRings> points_by_scan(const PointCloud& cloud, const ScanRingOptions& options,
                                      const Executor& executor) {
  if (cloud.scan_indices.empty() || !cloud.has_beams()) return {};
  const ScanRuns runs(cloud.scan_indices, executor);
  std::vector<ScanRings> scans(runs.size());
  executor.for_chunks(runs.size(), 1, [&](std::size_t k, std::size_t) {
    scans[k].scan = runs.scan(k);
    scans[k].points.reserve(runs.points(k));
    runs.for_each(k, [&](std::size_t i) {
      if (is_beam(cloud.origin_kind(i)) && !(cloud.positions[i] == cloud.sensor_positions[i]))
        scans[k].points.push_back(static_cast<std::uint32_t>(i));
    });
  });
  std::erase_if(scans,
                [&](const ScanRings& scan) { return scan.points.size() < options.min_points; });
  return scans;
}

/// Whether a scan's own pose and lasers say what its rings are.
bool has_lasers(const PointCloud& cloud) {
  return !cloud.lasers.empty() && !cloud.scan_poses.empty();
}

const Mat3d* pose_rotation(const PointCloud& cloud, std::uint32_t scan) {
  if (scan >= cloud.scan_poses.size()) return nullptr;
  return &cloud.scan_poses[scan].world_from_sensor.rotation;
}

/// Adds up the elevations of a scan's points by their rings, of which there are `rings`.
std::vector<RingSum> sums_of(const PointCloud& cloud, const ScanRings& scan, std::size_t rings) {
  std::vector<RingSum> sums(rings);
  const Vec3d axis = scan.world_from_sensor.transposed().rows[2];
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const std::size_t ring = scan.rings[k];
    if (ring >= rings) continue;
    sums[ring].elevations_rad += elevation_about(axis, beam_direction(cloud, scan.points[k]));
    ++sums[ring].points;
  }
  return sums;
}

/// Sums the scans up; gives the means of the elevations of rings over all of them, NaN without
/// points.
std::vector<double> mean_elevations(const PointCloud& cloud, std::span<ScanRings> scans,
                                    std::size_t rings, const Executor& executor) {
  executor.for_chunks(scans.size(), 1, [&](std::size_t s, std::size_t) {
    scans[s].sums = sums_of(cloud, scans[s], rings);
  });
  std::vector<double> means;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    RingSum total;
    for (const ScanRings& scan : scans) {
      total.elevations_rad += scan.sums[ring].elevations_rad;
      total.points += scan.sums[ring].points;
    }
    means.push_back(total.points > 0 ? total.mean_rad() : kNaN);
  }
  return means;
}

/// A point without a laser may be of any beam: it goes to the nearest ring, so that none of its
/// cells is taken for empty.
void place_unknown(const PointCloud& cloud, std::span<const double> elevations_rad,
                   ScanRings& scan) {
  if (std::ranges::find(scan.rings, kNoLaser) == scan.rings.end()) return;
  const Vec3d axis = scan.world_from_sensor.transposed().rows[2];
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    if (scan.rings[k] != kNoLaser) continue;
    const double elevation_rad = elevation_about(axis, beam_direction(cloud, scan.points[k]));
    double nearest_rad = std::numbers::pi;
    for (std::size_t ring = 0; ring < elevations_rad.size(); ++ring) {
      const double distance_rad = std::fabs(elevations_rad[ring] - elevation_rad);  // NaN: no
      if (!(distance_rad < nearest_rad)) continue;
      nearest_rad = distance_rad;
      scan.rings[k] = static_cast<std::uint16_t>(ring);
    }
  }
  scan.sums = sums_of(cloud, scan, elevations_rad.size());
}

/// RingPattern::along and anisotropy.
void add_neighbours(std::span<const Vec3d> directions, RingPattern& pattern) {
  constexpr Vec3d kAlong{0.48, 0.6, 0.64};       // as in ways_to_neighbours()
  constexpr double kLevel = 0.26, kSteep = 0.7;  // sines of the way's elevation
  constexpr double kMax_rad = 0.1;
  std::vector<std::pair<double, Vec3d>> sorted;
  sorted.reserve(directions.size());
  for (const Vec3d d : directions) sorted.emplace_back(dot(kAlong, d), d);
  std::ranges::sort(sorted, {}, [](const std::pair<double, Vec3d>& e) { return e.first; });
  const std::size_t stride = std::max<std::size_t>(1, sorted.size() / kNeighbourPoints);
  std::size_t points = 0, along = 0;
  std::vector<double> ratios, steps_rad;
  for (std::size_t at = stride / 2; at < sorted.size(); at += stride) {
    double level = kMax_rad, steep = kMax_rad, other = kMax_rad;  // rad
    const auto look = [&](std::size_t k) {
      if (std::fabs(sorted[k].first - sorted[at].first) > std::max(level, steep)) return false;
      const Vec3d to = sorted[k].second - sorted[at].second;
      const double distance = length(to), rise = std::fabs(to.z);
      if (distance <= kSameBeam_rad) return true;
      double& nearest = rise < kLevel * distance ? level : rise > kSteep * distance ? steep : other;
      nearest = std::min(nearest, distance);
      return true;
    };
    for (std::size_t k = at + 1; k < sorted.size() && look(k);) ++k;
    for (std::size_t k = at; k > 0 && look(k - 1);) --k;
    if (std::min({level, steep, other}) == kMax_rad) continue;
    ++points;
    along += level < std::min(steep, other) ? 1 : 0;
    if (level == kMax_rad) continue;
    ratios.push_back(steep / level);
    const Vec3d d = sorted[at].second;
    steps_rad.push_back(level / std::max(std::hypot(d.x, d.y), 1e-6));
  }
  if (ratios.empty()) return;
  pattern.along = static_cast<double>(along) / static_cast<double>(points);
  pattern.anisotropy = upper_median_of(ratios);
  constexpr double kUsual = 0.2;
  const double usual_rad = upper_median_of(steps_rad);
  pattern.even =
      static_cast<double>(std::ranges::count_if(
          steps_rad,
          [&](double step) { return std::fabs(step - usual_rad) < kUsual * usual_rad; })) /
      static_cast<double>(steps_rad.size());
}

/// RingPattern::uneven.
double share_uneven(std::span<const Vec3d> points, std::span<const double> elevations_rad) {
  constexpr std::size_t kSteps = 181, kMinPoints = 20;
  constexpr double kUneven = 1.1;
  std::vector<std::vector<double>> ranges_m(kSteps);
  for (std::size_t i = 0; i < points.size(); ++i)
    ranges_m[static_cast<std::size_t>(elevations_rad[i] / kDegree + 90)].push_back(
        length(points[i]));
  std::size_t filled = 0, uneven = 0;
  for (std::vector<double>& step : ranges_m) {
    if (step.size() < kMinPoints) continue;
    ++filled;
    std::ranges::sort(step);
    if (step[step.size() * 9 / 10] > kUneven * step[step.size() / 10]) ++uneven;
  }
  return filled == 0 ? 0 : static_cast<double>(uneven) / static_cast<double>(filled);
}

RecordingRings rings_of_lasers(const PointCloud& cloud, std::vector<ScanRings> scans,
                               const ScanRingOptions& options, const Executor& executor) {
  std::vector<std::uint16_t> most(scans.size());
  executor.for_chunks(scans.size(), 1, [&](std::size_t s, std::size_t) {
    ScanRings& scan = scans[s];
    std::size_t unknown = 0;
    scan.rings.reserve(scan.points.size());
    for (const std::uint32_t i : scan.points) {
      scan.rings.push_back(cloud.lasers[i]);
      unknown += cloud.lasers[i] == kNoLaser ? 1 : 0;
      if (cloud.lasers[i] != kNoLaser) most[s] = std::max(most[s], cloud.lasers[i]);
    }
    const Mat3d* rotation = pose_rotation(cloud, scan.scan);
    if (rotation != nullptr) scan.world_from_sensor = *rotation;
    if (rotation == nullptr || static_cast<double>(unknown) >
                                   options.most_unknown * static_cast<double>(scan.points.size()))
      scan.points.clear();
  });
  std::erase_if(scans, [](const ScanRings& scan) { return scan.points.empty(); });
  if (scans.empty()) return {};
  const std::size_t rings = std::size_t{*std::ranges::max_element(most)} + 1;
  RecordingRings recording;
  recording.elevations_rad = mean_elevations(cloud, scans, rings, executor);
  recording.scans = std::move(scans);
  executor.for_chunks(recording.scans.size(), 1, [&](std::size_t s, std::size_t) {
    place_unknown(cloud, recording.elevations_rad, recording.scans[s]);
  });
  const auto has_points = [](double elevation_rad) { return elevation_rad == elevation_rad; };
  const auto known = std::ranges::count_if(recording.elevations_rad, has_points);
  if (static_cast<std::size_t>(known) < options.min_rings) return {};
  return recording;
}

std::vector<Vec3d> directions_of(const PointCloud& cloud, const ScanRings& scan) {
  std::vector<Vec3d> directions;
  directions.reserve(scan.points.size());
  for (const std::uint32_t i : scan.points) directions.push_back(beam_direction(cloud, i));
  return directions;
}

/// Axes and ring elevations of the recording; no elevations: there are no rings.
std::vector<double> find_axes(const PointCloud& cloud, std::vector<ScanRings>& scans,
                              const ScanRingOptions& options, const Executor& executor) {
  std::vector<std::vector<double>> pooled(scans.size());
  executor.for_chunks(scans.size(), 1, [&](std::size_t s, std::size_t) {
    const std::vector<Vec3d> directions = directions_of(cloud, scans[s]);
    const Mat3d* rotation = pose_rotation(cloud, scans[s].scan);
    std::optional<Vec3d> pose_axis;
    if (rotation != nullptr) pose_axis = rotation->transposed().rows[2];
    const ScanAxis found = find_axis(directions, pose_axis, options);
    if (found.near < options.min_near) {
      scans[s].points.clear();
      return;
    }
    scans[s].world_from_sensor = frame_of_axis(found.axis);
    pooled[s] = elevations_about(found.axis, thinned(directions, kPooledPoints));
  });
  const std::size_t all = scans.size();
  std::erase_if(scans, [](const ScanRings& scan) { return scan.points.empty(); });
  if (static_cast<double>(scans.size()) < options.min_scans * static_cast<double>(all)) return {};
  std::vector<double> elevations_rad;
  for (const auto& part : pooled)
    elevations_rad.insert(elevations_rad.end(), part.begin(), part.end());
  return peaks_of(elevations_rad);
}

RecordingRings rings_of_directions(const PointCloud& cloud, std::vector<ScanRings> scans,
                                   const ScanRingOptions& options, const Executor& executor) {
  const std::size_t all = scans.size();
  const std::vector<double> rings_rad = find_axes(cloud, scans, options, executor);
  if (rings_rad.size() < std::max<std::size_t>(2, options.min_rings)) return {};
  executor.for_chunks(scans.size(), 1, [&](std::size_t s, std::size_t) {
    ScanRings& scan = scans[s];
    const Vec3d axis = scan.world_from_sensor.transposed().rows[2];
    std::size_t near = 0;
    scan.rings.reserve(scan.points.size());
    for (const std::uint32_t i : scan.points) {
      const RingPlace place = place_of(elevation_about(axis, beam_direction(cloud, i)), rings_rad);
      scan.rings.push_back(static_cast<std::uint16_t>(place.ring));
      near += place.near ? 1 : 0;
    }
    if (static_cast<double>(near) < options.min_near * static_cast<double>(scan.points.size()))
      scan.points.clear();
  });
  std::erase_if(scans, [](const ScanRings& scan) { return scan.points.empty(); });
  if (static_cast<double>(scans.size()) < options.min_scans * static_cast<double>(all)) return {};
  std::vector<double> means_rad = mean_elevations(cloud, scans, rings_rad.size(), executor);
  return {std::move(means_rad), std::move(scans)};
}

}  // namespace

Vec3d beam_direction(const PointCloud& cloud, std::size_t i) {
  const Vec3d beam =
      vec_cast<double>(cloud.positions[i]) - vec_cast<double>(cloud.sensor_positions[i]);
  const double range_m = length(beam);
  return range_m > 0 ? beam / range_m : Vec3d{};
}

RingPattern ring_pattern(std::span<const Vec3d> points) {
  RingPattern pattern;
  std::vector<Vec3d> directions;
  directions.reserve(points.size());
  for (const Vec3d p : points) directions.push_back(normalized(p));
  add_neighbours(directions, pattern);
  const std::vector<double> elevations_rad = elevations_about({0, 0, 1}, directions);
  pattern.uneven = share_uneven(points, elevations_rad);
  const std::vector<double> rings_rad = peaks_of(elevations_rad);
  pattern.rings = rings_rad.size();
  if (pattern.rings < 2) return pattern;
  pattern.near = share_near(elevations_rad, rings_rad);
  return pattern;
}

RecordingRings find_scan_rings(const PointCloud& cloud, const ScanRingOptions& options,
                               const Executor& executor) {
  std::vector<ScanRings> scans = points_by_scan(cloud, options, executor);
  if (scans.empty()) return {};
  return has_lasers(cloud) ? rings_of_lasers(cloud, std::move(scans), options, executor)
                           : rings_of_directions(cloud, std::move(scans), options, executor);
}

}  // namespace adasplats
