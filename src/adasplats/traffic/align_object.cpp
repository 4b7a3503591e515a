// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/align_object.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/small_matrix.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

constexpr std::size_t kUnknowns = 4;  // shift along x, y and z, turn about z
using Unknowns = std::array<double, kUnknowns>;

/// A shift and a turn about z of the points of one scan.
struct Correction {
  Vec3d shift_m;
  double turn_rad = 0;

  RigidTransform transform() const {
    return {rotation_from_yaw_pitch_roll(turn_rad, 0, 0), shift_m};
  }
};

/// The normal equation of the correction of one scan.
struct NormalEquation {
  std::array<double, kUnknowns * kUnknowns> left{};
  Unknowns right{};

  void add(const Unknowns& slope, double error_m, double weight) {
    for (std::size_t r = 0; r < kUnknowns; ++r) {
      for (std::size_t c = 0; c < kUnknowns; ++c)
        left[r * kUnknowns + c] += weight * slope[r] * slope[c];
      right[r] -= weight * slope[r] * error_m;
    }
  }
};

/// All points of an object, with the number of their scan.
struct Body {
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> scans;
};

Body body_of(const RecordedObject& object, std::span<const Correction> corrections) {
  Body body;
  for (std::size_t k = 0; k < object.scans.size(); ++k) {
    const RigidTransform corrected = corrections[k].transform();
    for (const Vec3d& point : object.scans[k].points) {
      body.points.push_back(vec_cast<float>(corrected * point));
      body.scans.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return body;
}

/// The plane of points of other scans near one point.
struct NearPlane {
  bool is_known = false;
  Vec3d normal, middle;
};

constexpr std::uint32_t kNear = 24;  // of all scans
constexpr std::size_t kPlanePoints = 6;

NearPlane plane_near(const Body& body, const PointIndex& index, std::uint32_t scan,
                     const NeighborList& near) {
  std::vector<std::uint64_t> keys;
  for (std::uint32_t k = 0; k < near.size; ++k)
    if (body.scans[index.index_of(near.ranks[k])] != scan) keys.push_back(near.key(k));
  if (keys.size() < kPlanePoints) return {};
  std::ranges::sort(keys);
  keys.resize(kPlanePoints);
  const Vec3f first = body.points[index.index_of(static_cast<std::uint32_t>(keys.front()))];
  Moments moments;
  for (const std::uint64_t key : keys)
    moments.add(body.points[index.index_of(static_cast<std::uint32_t>(key))] - first);
  const LocalShape shape = local_shape(moments);
  constexpr double kFlat = 0.1;  // points on a line have no plane
  return {shape.lambda[1] > kFlat * shape.lambda[0] && shape.lambda[2] < kFlat * shape.lambda[1],
          vec_cast<double>(shape.normal), vec_cast<double>(first) + moments.sum / moments.count};
}

/// The planes near all points, in the order of the body.
std::vector<NearPlane> planes_of(const Body& body, const AlignOptions& options,
                                 const Executor& executor) {
  const PointIndex index(body.points, executor);
  std::vector<NearPlane> planes(body.points.size());
  const NeighborLimit limit = {kNear, static_cast<float>(options.reach_m * options.reach_m)};
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return limit; },
      [&](std::uint32_t rank, const NeighborList& near) {
        const std::uint32_t i = index.index_of(rank);
        planes[i] = plane_near(body, index, body.scans[i], near);
      });
  return planes;
}

/// One step of all corrections.
void improve(const RecordedObject& object, const AlignOptions& options,
             std::vector<Correction>& corrections, const Executor& executor) {
  const Body body = body_of(object, corrections);
  const std::vector<NearPlane> planes = planes_of(body, options, executor);
  const double scale2 = options.error_m * options.error_m;
  std::size_t i = 0;
  for (std::size_t k = 0; k < object.scans.size(); ++k) {
    NormalEquation equation;
    for (std::size_t n = object.scans[k].points.size(); n-- > 0; ++i) {
      if (!planes[i].is_known) continue;
      const Vec3d point = vec_cast<double>(body.points[i]), normal = planes[i].normal;
      const double error_m = dot(normal, point - planes[i].middle);
      const double share = scale2 / (scale2 + error_m * error_m);
      equation.add({normal.x, normal.y, normal.z, normal.y * point.x - normal.x * point.y}, error_m,
                   share * share / scale2);
    }
    if (object.scans[k].points.size() < options.min_points) continue;
    Correction& now = corrections[k];
    const Unknowns correction = {now.shift_m.x, now.shift_m.y, now.shift_m.z, now.turn_rad};
    for (std::size_t u = 0; u < kUnknowns; ++u) {
      const double deviation = u < 3 ? options.box_m : options.box_rad;
      Unknowns slope{};
      slope[u] = 1;
      equation.add(slope, correction[u], 1 / (deviation * deviation));
    }
    factor<kUnknowns>(equation.left);
    const Unknowns step = solved<kUnknowns>(equation.left, equation.right);
    // All scans move at once: with whole steps two scans would swap places.
    const double share = 1 - 1 / static_cast<double>(object.scans.size());
    now.shift_m = now.shift_m + share * Vec3d{step[0], step[1], step[2]};
    now.turn_rad += share * step[3];
  }
}

/// Applies the corrections to the points and to the poses.
void move_scans(const std::vector<Correction>& corrections, RecordedObject& object) {
  // A box of a scan has another time than the points of its object, by less than a sweep.
  constexpr double kApart_s = 1e-3, kSweep_s = 0.1;
  Trajectory moved;
  for (std::size_t k = 0; k < object.scans.size(); ++k) {
    const RigidTransform corrected = corrections[k].transform();
    ObjectScan& scan = object.scans[k];
    for (Vec3d& point : scan.points) point = corrected * point;
    for (Vec3d& origin : scan.origins) origin = corrected * origin;
    for (PassingBeam& beam : scan.passing)
      beam = {corrected * beam.origin, corrected.rotation * beam.direction};
    scan.world_from_object = scan.world_from_object * corrected.inverse();
    if (moved.empty() || scan.time_s > moved.back().time_s + kApart_s)
      moved.push_back({scan.time_s, scan.world_from_object});
  }
  const auto end = [&](const TimedPose& given, const Correction& correction) {
    return TimedPose{given.time_s, given.world_from_sensor * correction.transform().inverse()};
  };
  const TimedPose first = object.world_from_object.front();
  const TimedPose last = object.world_from_object.back();
  if (first.time_s < moved.front().time_s - kSweep_s)
    moved.insert(moved.begin(), end(first, corrections.front()));
  if (last.time_s > moved.back().time_s + kSweep_s) moved.push_back(end(last, corrections.back()));
  object.world_from_object = std::move(moved);
}

}  // namespace

AlignReport align_scans(RecordedObject& object, const AlignOptions& options,
                        const Executor& executor) {
  AlignReport report;
  std::vector<Correction> corrections(object.scans.size());
  if (corrections.empty()) return report;
  for (int round = 0; round < options.rounds; ++round)
    improve(object, options, corrections, executor);
  std::vector<double> shifts_m, turns_rad;
  for (std::size_t k = 0; k < corrections.size(); ++k) {
    if (object.scans[k].points.size() < options.min_points) continue;
    shifts_m.push_back(length(corrections[k].shift_m));
    turns_rad.push_back(std::fabs(corrections[k].turn_rad));
  }
  move_scans(corrections, object);
  report.scans = shifts_m.size();
  if (report.scans == 0) return report;
  report.median_shift_m = upper_median_of(std::move(shifts_m));
  report.median_turn_rad = upper_median_of(std::move(turns_rad));
  return report;
}

}  // namespace adasplats
