// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/map_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "adasplats/calibrate/robust_weight.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"
#include "adasplats/core/maths/symmetric_eigen.h"

namespace adasplats {
namespace {

constexpr double kCoarse_m = 2, kMedium_m = 1, kFine_m = 0.5;  // cells of the map
constexpr std::size_t kUnknowns = 8;                           // rotation, shift, clock, range
using Matrix = std::array<double, kUnknowns * kUnknowns>;
using Unknowns = std::array<double, kUnknowns>;

/// How a sensor moves at a scan: m/s and rad/s, world axes.
struct Twist {
  Vec3d velocity, rotation;
};

std::vector<Twist> twists_of(const Trajectory& poses) {
  std::vector<Twist> twists(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const TimedPose& before = poses[k == 0 ? 0 : k - 1];
    const TimedPose& after = poses[std::min(k + 1, poses.size() - 1)];
    const double seconds = after.time_s - before.time_s;
    if (!(seconds > 0)) continue;
    const RigidTransform &a = before.world_from_sensor, &b = after.world_from_sensor;
    twists[k] = {(1 / seconds) * (b.translation - a.translation),
                 (1 / seconds) * rotation_vector(b.rotation * a.rotation.transposed())};
  }
  return twists;
}

/// The pose of the sensor when it fired from `position`, by its motion around the scan's pose.
RigidTransform pose_at_firing(const RigidTransform& of_scan, const Twist& twist, Vec3d position) {
  constexpr double kMinSpeed_m_s = 0.5, kMaxTime_s = 0.2;
  const double square = dot(twist.velocity, twist.velocity);
  double time_s = 0;
  if (square > kMinSpeed_m_s * kMinSpeed_m_s)
    time_s = std::clamp(dot(position - of_scan.translation, twist.velocity) / square, -kMaxTime_s,
                        kMaxTime_s);
  return {rotation_by(time_s * twist.rotation) * of_scan.rotation, position};
}

RigidTransform moved_pose(const RigidTransform& given, const Twist& twist,
                          const MountCorrection& mount, double clock_s) {
  const RigidTransform then = {rotation_by(clock_s * twist.rotation) * given.rotation,
                               given.translation + clock_s * twist.velocity};
  return then * mount.given_from_mounted();
}

/// The cells around one, itself included: -1, 0 or 1 along each axis, for k from 0 to 26.
Vec3d neighbor_of(int k) {
  const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

/// A surface in a cell of the map.
struct MapPlane {
  Vec3d center, normal;
};

/// Planes of the map in cubic cells.
class MapPlanes {
 public:
  MapPlanes(const PointCloud& map, Vec3d origin, double cell_m) : cell_m_(cell_m) {
    struct Sums {
      double count = 0;
      Vec3d sum;
      SymmetricMat3d squares;
    };
    std::unordered_map<std::uint64_t, Sums> cells;
    for (const Vec3f position : map.positions) {
      const Vec3d p = vec_cast<double>(position) + (map.origin - origin);
      Sums& s = cells[key_of(p)];
      ++s.count;
      s.sum = s.sum + p;
    }
    for (const Vec3f position : map.positions) {
      const Vec3d p = vec_cast<double>(position) + (map.origin - origin);
      Sums& s = cells[key_of(p)];
      const Vec3d d = p - s.sum / s.count;
      s.squares.xx += d.x * d.x, s.squares.xy += d.x * d.y, s.squares.xz += d.x * d.z;
      s.squares.yy += d.y * d.y, s.squares.yz += d.y * d.z, s.squares.zz += d.z * d.z;
    }
    constexpr double kMinPoints = 6, kFlat = 0.1;  // thickness against the width of the cell
    for (const auto& [key, s] : cells) {
      if (s.count < kMinPoints) continue;
      const SymmetricEigen eigen = symmetric_eigen(s.squares);
      const double thick_m = std::sqrt(std::max(0.0, eigen.values[2]) / s.count);
      const double wide_m = std::sqrt(std::max(0.0, eigen.values[1]) / s.count);
      if (thick_m > kFlat * cell_m || thick_m > 0.5 * wide_m) continue;
      planes_[key] = {s.sum / s.count, eigen.vectors[2]};
    }
  }

  /// The nearest plane in the cells around a point; null if there is none.
  const MapPlane* nearest(Vec3d p) const {
    const MapPlane* nearest = nullptr;
    double smallest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 27; ++k) {
      const Vec3d at = p + cell_m_ * neighbor_of(k);
      const auto found = planes_.find(key_of(at));
      if (found == planes_.end()) continue;
      const Vec3d away = p - found->second.center;
      const double square = dot(away, away);
      if (square < smallest) nearest = &found->second;
      smallest = std::min(smallest, square);
    }
    return nearest;
  }

 private:
  std::uint64_t key_of(Vec3d p) const {
    const auto index = [this](double value) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / cell_m_)) +
                                        (1 << 20)) &
             0x1fffff;
    };
    return index(p.x) << 42 | index(p.y) << 21 | index(p.z);
  }

  double cell_m_;
  std::unordered_map<std::uint64_t, MapPlane> planes_;
};

/// Sums over points: normal equations and the share near planes.
struct AlignmentSums {
  Matrix matrix{};
  Unknowns right{};
  double weight = 0;
  std::size_t with_plane = 0, near = 0;

  AlignmentSums& operator+=(const AlignmentSums& other) {
    for (std::size_t k = 0; k < matrix.size(); ++k) matrix[k] += other.matrix[k];
    for (std::size_t k = 0; k < right.size(); ++k) right[k] += other.right[k];
    weight += other.weight;
    with_plane += other.with_plane;
    near += other.near;
    return *this;
  }
  double share() const {
    return with_plane == 0 ? 0 : static_cast<double>(near) / static_cast<double>(with_plane);
  }
};

class Aligner {
 public:
  Aligner(const PointCloud& sensor, const MapAlignmentOptions& options, const Executor& executor)
      : options_(options), executor_(executor), poses_(sensor.scan_poses) {
    for (TimedPose& pose : poses_)
      pose.world_from_sensor.translation = pose.world_from_sensor.translation - sensor.origin;
    twists_ = twists_of(poses_);
    const std::size_t stride = std::max<std::size_t>(1, sensor.size() / options.points) | 1;
    for (std::size_t i = 0; i < sensor.size(); i += stride) {
      scans_.push_back(sensor.scan_indices[i]);
      firings_.push_back(pose_at_firing(poses_[scans_.back()].world_from_sensor,
                                        twists_[scans_.back()],
                                        vec_cast<double>(sensor.sensor_positions[i])));
      in_sensor_.push_back(firings_.back().rotation.transposed() *
                           vec_cast<double>(sensor.positions[i] - sensor.sensor_positions[i]));
    }
  }

  struct Estimate {
    MountCorrection mount;
    double clock_s = 0, range_m = 0;
    double share = 0;
  };

  /// Gauss-Newton steps against planes of one cell size; every `stride`-th point, without those of
  /// the scans `left_out`.
  void refine(const MapPlanes& planes, double width_m, int steps, std::size_t stride,
              Estimate& estimate, ScanSpan left_out = {}) const {
    for (int step = 0; step < steps; ++step) {
      AlignmentSums sums = sums_of(planes, width_m, stride, estimate, left_out);
      add_priors(estimate, sums);
      Matrix l = sums.matrix;
      factor<kUnknowns>(l);
      const Unknowns x = solved<kUnknowns>(l, sums.right);
      const Mat3d rotation =
          rotation_by(estimate.mount.rotation_rad) * rotation_by({x[0], x[1], x[2]});
      estimate.mount.rotation_rad = rotation_vector(rotation);
      estimate.mount.shift_m = estimate.mount.shift_m + Vec3d{x[3], x[4], x[5]};
      estimate.clock_s += x[6];
      estimate.range_m += x[7];
    }
    estimate.share = sums_of(planes, width_m, stride, estimate).share();
  }

  AlignmentSums sums_of(const MapPlanes& planes, double width_m, std::size_t stride,
                        const Estimate& estimate, ScanSpan left_out = {}) const {
    const std::size_t count = (in_sensor_.size() + stride - 1) / stride;
    return executor_.sum_chunks(count, kCoarseGrain, AlignmentSums{},
                                [&](std::size_t begin, std::size_t end) {
                                  AlignmentSums sums;
                                  for (std::size_t k = begin; k < end; ++k) {
                                    const std::uint32_t scan = scans_[k * stride];
                                    if (scan < left_out.begin || scan >= left_out.end)
                                      add(planes, width_m, k * stride, estimate, sums);
                                  }
                                  return sums;
                                });
  }

  /// Standard deviations of the unknowns (MapAlignment).
  Unknowns deviations(const MapPlanes& planes, double width_m, const Estimate& estimate) const {
    constexpr std::size_t kParts = 5;
    constexpr int kSteps = 4;
    std::array<Unknowns, kParts> estimates;
    Unknowns mean{};
    for (std::size_t part = 0; part < kParts; ++part) {
      Estimate without = estimate;
      refine(planes, width_m, kSteps, 1, without,
             {poses_.size() * part / kParts, poses_.size() * (part + 1) / kParts});
      estimates[part] = unknowns_of(without);
      for (std::size_t u = 0; u < kUnknowns; ++u) mean[u] += estimates[part][u] / kParts;
    }
    AlignmentSums sums = sums_of(planes, width_m, 1, estimate);
    add_priors(estimate, sums);
    Matrix l = sums.matrix;
    factor<kUnknowns>(l);
    const Unknowns sigmas = expected_errors();
    Unknowns result{};
    for (std::size_t u = 0; u < kUnknowns; ++u) {
      Unknowns unit{};
      unit[u] = 1;
      const double prior_share = prior_weight(sigmas[u]) * solved<kUnknowns>(l, unit)[u];
      double square = 0;
      for (const Unknowns& without : estimates) square += std::pow(without[u] - mean[u], 2);
      const double spread = std::sqrt(square * (kParts - 1) / kParts);  // delete-a-group jackknife
      result[u] = std::hypot(spread, prior_share * sigmas[u]);
    }
    return result;
  }

 private:
  void add(const MapPlanes& planes, double width_m, std::size_t i, const Estimate& estimate,
           AlignmentSums& sums) const {
    const Twist& twist = twists_[scans_[i]];
    const RigidTransform world_from_sensor =
        moved_pose(firings_[i], twist, estimate.mount, estimate.clock_s);
    const Vec3d direction = normalized(in_sensor_[i]);
    const Vec3d in_sensor = in_sensor_[i] + estimate.range_m * direction;
    const Vec3d p = world_from_sensor * in_sensor;
    const MapPlane* plane = planes.nearest(p);
    if (plane == nullptr) return;
    const double residual_m = dot(plane->normal, p - plane->center);
    ++sums.with_plane;
    sums.near += std::fabs(residual_m) < options_.near_m ? 1 : 0;
    const double weight = robust_weight(residual_m, width_m);
    const Vec3d normal_in_sensor = world_from_sensor.rotation.transposed() * plane->normal;
    const Vec3d turning = cross(in_sensor, normal_in_sensor);
    const RigidTransform& given = firings_[i];
    const Vec3d shifting = given.rotation.transposed() * plane->normal;
    const Vec3d moving = twist.velocity + cross(twist.rotation, p - given.translation);
    const Unknowns row = {turning.x,
                          turning.y,
                          turning.z,
                          shifting.x,
                          shifting.y,
                          shifting.z,
                          dot(plane->normal, moving),
                          dot(direction, normal_in_sensor)};
    for (std::size_t a = 0; a < kUnknowns; ++a) {
      for (std::size_t b = 0; b < kUnknowns; ++b)
        sums.matrix[a * kUnknowns + b] += weight * row[a] * row[b];
      sums.right[a] -= weight * row[a] * residual_m;
    }
    sums.weight += weight;
  }

  static Unknowns unknowns_of(const Estimate& estimate) {
    const auto& [turn, shift] = estimate.mount;
    return {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z, estimate.clock_s, estimate.range_m};
  }

  /// Standard deviations of the priors.
  Unknowns expected_errors() const {
    const double turn = options_.rotation_rad, shift = options_.shift_m;
    return {
        turn, turn, turn, shift, shift, shift, options_.clock_s, std::max(1e-6, options_.range_m)};
  }

  static double prior_weight(double sigma) {
    constexpr double kResidual_m = 0.05;
    return std::pow(kResidual_m / sigma, 2);
  }

  void add_priors(const Estimate& estimate, AlignmentSums& sums) const {
    const Unknowns values = unknowns_of(estimate), sigmas = expected_errors();
    for (std::size_t u = 0; u < kUnknowns; ++u) {
      const double weight = prior_weight(sigmas[u]);
      sums.matrix[u * (kUnknowns + 1)] += weight;
      sums.right[u] -= weight * values[u];
    }
  }

  const MapAlignmentOptions& options_;
  const Executor& executor_;
  Trajectory poses_;  ///< relative to the cloud's origin
  std::vector<Twist> twists_;
  std::vector<RigidTransform> firings_;  ///< given poses of the sensor
  std::vector<Vec3d> in_sensor_;
  std::vector<std::uint32_t> scans_;
};

}  // namespace

bool MapAlignment::fits(const MapAlignmentOptions& expected) const {
  constexpr double kMinShare = 0.5, kFactor = 2;
  return share >= kMinShare && length(mount.rotation_rad) <= kFactor * expected.rotation_rad &&
         length(mount.shift_m) <= kFactor * expected.shift_m &&
         std::fabs(clock_s) <= kFactor * expected.clock_s &&
         std::fabs(range_m) <= kFactor * expected.range_m + 1e-3;
}

std::vector<std::string> MapAlignment::not_observed() const {
  constexpr double kMaxShare = 0.5;  // of the expected errors
  const MapAlignmentOptions expected;
  std::vector<std::string> names;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (rotation_sd_rad[axis] > kMaxShare * expected.rotation_rad)
      names.push_back("rotation about " + name);
    if (shift_sd_m[axis] > kMaxShare * expected.shift_m) names.push_back("shift along " + name);
  }
  if (clock_sd_s > kMaxShare * expected.clock_s) names.push_back("clock");
  return names;
}

void apply(const MapAlignment& alignment, PointCloud& sensor) {
  const std::vector<Twist> twists = twists_of(sensor.scan_poses);
  const auto moved = [&](const RigidTransform& given, std::uint32_t scan) {
    return moved_pose(given, twists[scan], alignment.mount, alignment.clock_s);
  };
  for (std::size_t i = 0; i < sensor.size(); ++i) {
    const std::uint32_t scan = sensor.scan_indices[i];
    RigidTransform of_scan = sensor.scan_poses[scan].world_from_sensor;
    of_scan.translation = of_scan.translation - sensor.origin;
    const RigidTransform firing =
        pose_at_firing(of_scan, twists[scan], vec_cast<double>(sensor.sensor_positions[i]));
    const RigidTransform corrected = moved(firing, scan);
    const Vec3d ray = vec_cast<double>(sensor.positions[i] - sensor.sensor_positions[i]);
    const double range_m = length(ray);
    const double factor = range_m > 0 ? 1 + alignment.range_m / range_m : 1;
    sensor.positions[i] =
        vec_cast<float>(corrected * (factor * (firing.rotation.transposed() * ray)));
    sensor.sensor_positions[i] = vec_cast<float>(corrected.translation);
  }
  for (std::uint32_t scan = 0; scan < sensor.scan_poses.size(); ++scan) {
    RigidTransform& pose = sensor.scan_poses[scan].world_from_sensor;
    pose = moved(pose, scan);
  }
}

MapAlignment align_with_map(const PointCloud& sensor, const PointCloud& map,
                            const MapAlignmentOptions& options, const Executor& executor) {
  constexpr std::size_t kCoarseStride = 5;
  const Aligner aligner(sensor, options, executor);
  const MapPlanes coarse(map, sensor.origin, kCoarse_m), medium(map, sensor.origin, kMedium_m),
      fine(map, sensor.origin, kFine_m);
  Aligner::Estimate best;
  best.share = -1;
  for (int start = 0; start < 27; ++start) {
    const double turn_rad = 0.8 * options.rotation_rad;
    Aligner::Estimate estimate;
    estimate.mount.rotation_rad = turn_rad * neighbor_of(start);
    aligner.refine(coarse, 1.0, 6, kCoarseStride, estimate);
    aligner.refine(medium, 0.4, 4, kCoarseStride, estimate);
    if (estimate.share > best.share) best = estimate;
  }
  aligner.refine(medium, 0.3, 6, 1, best);
  aligner.refine(fine, 0.15, 6, 1, best);
  aligner.refine(fine, 0.06, 8, 1, best);
  const double given_share = aligner.sums_of(fine, 0.1, 1, {}).share();
  MapAlignment result;
  result.mount = best.mount;
  result.clock_s = best.clock_s;
  result.range_m = best.range_m;
  result.given_share = given_share;
  result.share = best.share;
  return result;
}

MapAlignment refine_alignment(const PointCloud& sensor, const PointCloud& map,
                              const MapAlignment& start, const MapAlignmentOptions& options,
                              const Executor& executor) {
  constexpr std::size_t kMorePoints = 10;
  MapAlignmentOptions more = options;
  more.points *= kMorePoints;
  const Aligner aligner(sensor, more, executor);
  const MapPlanes fine(map, sensor.origin, kFine_m);
  Aligner::Estimate estimate{start.mount, start.clock_s, start.range_m};
  aligner.refine(fine, 0.06, 6, 1, estimate);
  aligner.refine(fine, 0.03, 6, 1, estimate);
  const auto sd = Aligner(sensor, options, executor).deviations(fine, 0.03, estimate);
  MapAlignment result;
  result.mount = estimate.mount;
  result.clock_s = estimate.clock_s;
  result.range_m = estimate.range_m;
  result.given_share = start.given_share;
  result.share = estimate.share;
  result.rotation_sd_rad = {sd[0], sd[1], sd[2]};
  result.shift_sd_m = {sd[3], sd[4], sd[5]};
  result.clock_sd_s = sd[6];
  return result;
}

RigidTransform mount_between(const Trajectory& first, const Trajectory& second) {
  constexpr double kArm_m = 10;  // rotations count as the displacement at this distance
  constexpr int kIterations = 20;
  const std::size_t middle = first.size() / 2;
  RigidTransform mount =
      first[middle].world_from_sensor.inverse() * second[middle].world_from_sensor;
  double width_m = 1;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double total = 0;
    Vec3d turn, shift;
    std::vector<double> misses_m;
    for (std::size_t k = 0; k < first.size(); ++k) {
      const RigidTransform miss =
          (first[k].world_from_sensor * mount).inverse() * second[k].world_from_sensor;
      const Vec3d turned = rotation_vector(miss.rotation);
      misses_m.push_back(length(miss.translation) + kArm_m * length(turned));
      const double weight = robust_weight(misses_m.back(), width_m);
      total += weight;
      turn = turn + weight * turned;
      shift = shift + weight * miss.translation;
    }
    mount = mount * RigidTransform{rotation_by((1 / total) * turn), (1 / total) * shift};
    width_m = std::max(1e-3, 3 * upper_median_of(std::move(misses_m)));
  }
  return mount;
}

}  // namespace adasplats
