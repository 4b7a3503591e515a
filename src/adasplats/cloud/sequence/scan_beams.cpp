// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/scan_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/sweep_check.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

/// Elevations of the beams of KITTI's Velodyne HDL-64E, top to bottom. These and the heights below
/// were fitted to the measurements of KITTI raw drive 2011_09_26_0005 (z = tan(e) * rho + h, which
/// holds to 0.3 mm); drives of other days agree.
constexpr std::array<double, 64> kElevations_deg = {
    1.9367,   1.5740,   1.3048,   0.8716,   0.5788,   0.1806,   -0.0888,  -0.4518,
    -0.8031,  -1.2012,  -1.4939,  -1.8332,  -2.2076,  -2.5466,  -2.8738,  -3.2359,
    -3.5393,  -3.9359,  -4.2155,  -4.5881,  -4.9138,  -5.2508,  -5.6106,  -5.9584,
    -6.3289,  -6.6757,  -6.9990,  -7.2873,  -7.6788,  -8.0580,  -8.3105,  -8.7114,
    -9.0260,  -9.5735,  -10.0625, -10.4708, -10.9570, -11.5989, -12.1150, -12.5621,
    -13.0410, -13.4848, -14.0484, -14.5981, -15.1888, -15.6568, -16.1767, -16.5538,
    -17.1869, -17.7304, -18.3234, -18.7974, -19.3203, -19.7364, -20.2224, -20.7877,
    -21.3169, -21.9356, -22.4376, -22.8566, -23.3224, -23.9711, -24.5068, -24.9993};
constexpr const char* kSensor = "velodyne-hdl-64e-kitti";  // the same table in the library
constexpr double kBlocksMeet_deg = -8.87;
constexpr double kRevolution_s = 0.1033;  // KITTI's sensor turns 9.68 times a second
constexpr double kRadians = std::numbers::pi / 180;

/// Of the beam's origin above the frame's.
double block_height_m(double elevation_deg) {
  return elevation_deg > kBlocksMeet_deg ? 0.2065 + 0.00106 * elevation_deg
                                         : 0.1309 + 0.00061 * elevation_deg;
}

/// Share of the revolution from its middle, -0.5 to 0.5, at which the sensor looked there.
double sweep_phase(Vec3d point) { return -std::atan2(point.y, point.x) / (2 * std::numbers::pi); }

/// Displacement over one revolution, in each scan's frame, from the poses before and after.
std::vector<Vec3d> sweeps_of(const Trajectory& trajectory) {
  std::vector<Vec3d> sweeps_m(trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TimedPose& before = trajectory[i == 0 ? 0 : i - 1];
    const TimedPose& after = trajectory[std::min(i + 1, trajectory.size() - 1)];
    const double seconds = after.time_s - before.time_s;
    if (!(seconds > 0)) continue;
    const Vec3d moved_m =
        after.world_from_sensor.translation - before.world_from_sensor.translation;
    sweeps_m[i] = trajectory[i].world_from_sensor.rotation.transposed() *
                  ((kRevolution_s / seconds) * moved_m);
  }
  return sweeps_m;
}

/// A beam of the fan: the cone z = slope * rho + height that it sweeps.
struct Cone {
  double slope, height_m, cosine;
};

std::array<Cone, kElevations_deg.size()> cones_of_fan() {
  std::array<Cone, kElevations_deg.size()> cones{};
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const double elevation_rad = kElevations_deg[k] * kRadians;
    cones[k] = {std::tan(elevation_rad), block_height_m(kElevations_deg[k]),
                std::cos(elevation_rad)};
  }
  return cones;
}

/// How far a point at `rho_m` from the axis is above a cone, upright, m.
double above_cone(const Cone& cone, double z_m, double rho_m) {
  return z_m - cone.height_m - cone.slope * rho_m;
}

/// The cone nearest to a point, and how far it is, m.
std::pair<std::uint16_t, double> nearest_cone(Vec3d point) {
  static const auto kCones = cones_of_fan();
  const double rho_m = std::hypot(point.x, point.y);
  std::pair<std::uint16_t, double> nearest{kNoLaser, std::numeric_limits<double>::infinity()};
  const auto look = [&](std::size_t k) {
    const double above_m = above_cone(kCones[k], point.z, rho_m);
    const double distance_m = std::fabs(above_m) * kCones[k].cosine;
    const bool first_of_equals = distance_m == nearest.second && k < nearest.first;
    if (distance_m < nearest.second || (first_of_equals && nearest.first != kNoLaser))
      nearest = {static_cast<std::uint16_t>(k), distance_m};
    return distance_m;
  };
  // Heights and slopes fall from cone to cone, so a point is ever higher above them: `below` is the
  // first one that it is not below. What it is above or below more than one that was looked at is
  // nearer by the cosines (0.906 to 1) alone at most.
  const auto below = static_cast<std::size_t>(
      std::ranges::partition_point(
          kCones, [&](const Cone& cone) { return above_cone(cone, point.z, rho_m) < 0; }) -
      kCones.begin());
  constexpr double kMinCosine = 0.9;
  std::size_t begin = below, end = below;
  while (begin > 0 && kMinCosine * look(begin - 1) <= nearest.second) --begin;
  while (end < kCones.size() && kMinCosine * look(end) <= nearest.second) ++end;
  return nearest;
}

/// Distance of a point from the nearest of the beams' cones, m.
double distance_from_fan(Vec3d point) { return nearest_cone(point).second; }

/// What the sweeps by the poses' times are multiplied with: without motion, as the times have it,
/// and were these milliseconds, microseconds or nanoseconds.
constexpr std::array kSweepFactors = {0.0, 1.0, 1e3, 1e6, 1e9};

/// Throws data where the points lie on the fan by times in another unit than seconds, and by no
/// other way nearly as well.
void require_times_in_seconds(const KittiSequence& sequence,
                              const std::array<double, kSweepFactors.size()>& median_m,
                              double max_m) {
  constexpr double kClearly = 0.8;
  const double others_m = std::min(median_m[0], median_m[1]);
  for (std::size_t f = 2; f < kSweepFactors.size(); ++f) {
    if (!(median_m[f] < max_m && median_m[f] < kClearly * others_m)) continue;
    std::array<char, 300> text{};
    std::snprintf(text.data(), text.size(),
                  ": the times of the poses (times.txt) are not seconds: by the motion during a "
                  "revolution points are %.1f mm from the beams of the sensor, %.1f mm with times "
                  "divided by %.0f",
                  1e3 * others_m, 1e3 * median_m[f], kSweepFactors[f]);
    throw Error(ErrorKind::data, sequence.folder.string() + text.data());
  }
}

}  // namespace

namespace {

/// Where the beam to a point began, were the frame that of the sensor at its own time.
Vec3d origin_in_sweep(const ScanBeams& beams, std::size_t scan, Vec3d point, double phase) {
  Vec3d origin;
  if (beams.from_hdl64) {
    // The middle between the blocks separates the two parts of the fan well enough.
    constexpr double kBetween_m = 0.165;
    const double elevation_deg =
        std::atan2(point.z - kBetween_m, std::hypot(point.x, point.y)) / kRadians;
    origin.z = block_height_m(elevation_deg);
  }
  return scan < beams.sweeps_m.size() ? origin + phase * beams.sweeps_m[scan] : origin;
}

RigidTransform frame_from_sensor(const SweepMotion& motion, double phase) {
  const Trajectory sweep = {{-0.5, motion.frame_from_begin}, {0, {}}, {0.5, motion.frame_from_end}};
  return interpolate(sweep, phase);
}

}  // namespace

Vec3d ScanBeams::origin_of(std::size_t scan, Vec3d point) const {
  const bool is_raw = scan < raw_motions.size();
  if (!is_raw && scan >= sweeps_m.size()) return origin_in_sweep(*this, scan, point, 0);
  const double phase = sweep_phase(point);
  const Vec3d origin = origin_in_sweep(*this, scan, point, phase);
  return is_raw ? frame_from_sensor(raw_motions[scan], phase) * origin : origin;
}

MeasuredBeam ScanBeams::beam_of(std::size_t scan, Vec3d point) const {
  const double phase = sweep_phase(point);
  MeasuredBeam beam{origin_in_sweep(*this, scan, point, phase), point, laser_of(scan, point)};
  beam.end = offsets.corrected(beam.origin, beam.end, {0, 0, 1},
                               offsets.laser_of(beam.end - beam.origin, beam.laser));
  if (scan < raw_motions.size()) {
    const RigidTransform moved = frame_from_sensor(raw_motions[scan], phase);
    beam.origin = moved * beam.origin;
    beam.end = moved * beam.end;
  }
  return beam;
}

std::uint16_t ScanBeams::laser_of(std::size_t scan, Vec3d point) const {
  if (!from_hdl64) return kNoLaser;
  if (scan < sweeps_m.size()) point = point - sweep_phase(point) * sweeps_m[scan];
  return nearest_cone(point).first;
}

std::string ScanBeams::description() const {
  if (!recognised.empty()) return recognised;
  const std::string origin = from_hdl64 ? "HDL-64E blocks" : "frame origin";
  if (!raw_motions.empty()) return origin + ", rolling";
  return from_hdl64 && !sweeps_m.empty() ? origin + ", moving" : origin;
}

namespace {

/// Throws data where a pose is of a time when nothing is known of the motion.
void require_motion_of(const Trajectory& poses, const Trajectory& motion) {
  constexpr double kMaxBeside_s = 1;
  for (const TimedPose& pose : poses) {
    if (pose.time_s > motion.front().time_s - kMaxBeside_s &&
        pose.time_s < motion.back().time_s + kMaxBeside_s)
      continue;
    throw Error(ErrorKind::data, "a scan of " + std::to_string(pose.time_s) +
                                     " s, but `motion` is of " +
                                     std::to_string(motion.front().time_s) + " to " +
                                     std::to_string(motion.back().time_s) +
                                     " s: the clocks differ, or it is of another drive");
  }
}

}  // namespace

void set_raw_motions(ScanBeams& beams, const Trajectory& poses, const Trajectory& motion,
                     double revolution_s) {
  beams.raw_motions.clear();
  require_motion_of(poses, motion);
  for (const TimedPose& pose : poses) {
    const RigidTransform frame_from_world = interpolate(motion, pose.time_s).inverse();
    const auto moved = [&](double after_s) {
      return frame_from_world * interpolate(motion, pose.time_s + after_s);
    };
    beams.raw_motions.push_back({moved(-0.5 * revolution_s), moved(0.5 * revolution_s)});
  }
}

namespace {

using FanDistances = std::array<std::vector<double>, kSweepFactors.size()>;

/// Of some points of a scan from the fan, by every factor of its sweep.
FanDistances fan_distances(const KittiSequence& sequence, std::size_t index, Vec3d sweep_m) {
  constexpr std::size_t kEvery = 11;                   // points
  constexpr double kMinRange_m = 8, kMaxRange_m = 40;  // cones are apart there, beams accurate
  FanDistances distances_m;
  const auto scan = try_kitti_points(sequence, index);
  for (std::size_t i = 0; scan && i < scan->positions.size(); i += kEvery) {
    const Vec3d point = vec_cast<double>(scan->positions[i]);
    const double range_m = length(point);
    if (!(range_m >= kMinRange_m && range_m <= kMaxRange_m)) continue;
    const Vec3d moved_m = sweep_phase(point) * sweep_m;
    for (std::size_t f = 0; f < kSweepFactors.size(); ++f)
      distances_m[f].push_back(distance_from_fan(point - kSweepFactors[f] * moved_m));
  }
  return distances_m;
}

/// Whether poses are near enough in time to say how the sensor moved during a revolution.
bool resolves_sweep_motion(const Trajectory& poses) {
  constexpr double kMaxApart_s = 5 * kRevolution_s;
  std::vector<double> apart_s;
  apart_s.reserve(poses.size());
  for (std::size_t k = 1; k < poses.size(); ++k)
    apart_s.push_back(poses[k].time_s - poses[k - 1].time_s);
  return !apart_s.empty() && upper_median_of(std::move(apart_s)) <= kMaxApart_s;
}

/// Of scans as they were measured: their motions by the poses, unless these are too far apart or
/// the points do not lie on each other the better for it.
void find_raw_motions(const KittiSequence& sequence, const std::vector<Vec3d>& sweeps_m,
                      ScanBeams& beams, const Executor& executor) {
  if (resolves_sweep_motion(sequence.trajectory)) {
    set_raw_motions(beams, sequence.trajectory,
                    with_extrapolated_ends(sequence.trajectory, kRevolution_s));
    const SweepEvidence evidence = weigh_sweeps(sequence, beams, executor);
    if (evidence.confirms()) return;
    beams.raw_motions.clear();
    if (evidence.at_rest()) return;
  }
  std::vector<double> lengths_m;
  lengths_m.reserve(sweeps_m.size());
  for (const Vec3d sweep_m : sweeps_m) lengths_m.push_back(length(sweep_m));
  beams.unknown_sweep_m = upper_median_of(std::move(lengths_m));
}

}  // namespace

ScanBeams recognize_beams(const KittiSequence& sequence, const Executor& executor) {
  constexpr std::size_t kScans = 5;
  constexpr std::size_t kMinPoints = 500;
  constexpr double kMaxDistance_m = 0.01;

  ScanBeams moving;
  moving.from_hdl64 = true;
  moving.sweeps_m = sweeps_of(sequence.trajectory);
  moving.sensor = kSensor;
  std::vector<FanDistances> of_scans(std::min(kScans, sequence.scans.size()));
  executor.for_chunks(of_scans.size(), 1, [&](std::size_t k, std::size_t) {
    // Not the first and the last one: their speeds are less sure.
    const std::size_t index = (2 * k + 1) * sequence.scans.size() / (2 * of_scans.size());
    of_scans[k] = fan_distances(sequence, index, moving.sweeps_m[index]);
  });
  FanDistances distances_m;
  for (const FanDistances& part : of_scans)
    for (std::size_t f = 0; f < part.size(); ++f)
      distances_m[f].insert(distances_m[f].end(), part[f].begin(), part[f].end());
  if (distances_m[0].size() < kMinPoints) return {};
  std::array<double, kSweepFactors.size()> median_m{};
  for (std::size_t f = 0; f < median_m.size(); ++f)
    median_m[f] = upper_median_of(std::move(distances_m[f]));
  const auto [as_measured, compensated] = std::pair(median_m[0], median_m[1]);
  require_times_in_seconds(sequence, median_m, kMaxDistance_m);
  if (!(std::min(as_measured, compensated) < kMaxDistance_m)) return {};
  if (compensated < as_measured) return moving;
  const std::vector<Vec3d> sweeps_m = std::exchange(moving.sweeps_m, {});
  constexpr double kClearly = 0.8;
  if (as_measured < kClearly * compensated) find_raw_motions(sequence, sweeps_m, moving, executor);
  return moving;
}

}  // namespace adasplats
