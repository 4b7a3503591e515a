// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/point_origins.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// Start of the beam that measured point `i` of a sequence, world coordinates.
Vec3d beam_origin(const CloudPart& part, std::size_t i, const PartRun& run, Vec3d world) {
  const RigidTransform& pose = run.world_from_local;
  if (!part.scan_origins.empty()) return pose * vec_cast<double>(part.scan_origins[i]);
  return pose * part.beams.origin_of(run.scan, pose.inverse() * world);
}

std::string place_text(Vec3d place) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    std::string number = std::to_string(place[axis]);
    number.erase(number.find('.') + 3);  // to centimetres
    text += (axis == 0 ? "" : ",") + number;
  }
  return text;
}

/// A file can contain stated or guessed origins itself: only blame an option that was given.
Error origin_error(const std::filesystem::path& file, const PointCloud& cloud, std::size_t point,
                   const LoadOptions& options, const std::string& objection) {
  const OriginKind kind = cloud.origin_kind(point);
  const std::string place =
      place_text(cloud.origin + vec_cast<double>(cloud.sensor_positions[point]));
  if (kind == OriginKind::stated && options.viewpoint)
    return Error(ErrorKind::usage,
                 file.string() + ": was not measured from `viewpoint` " + place + ": " + objection +
                     "; omit `viewpoint`, or give the trajectory of the recording");
  if (kind == OriginKind::guessed && !options.trajectory.empty())
    return Error(ErrorKind::usage,
                 file.string() +
                     ": was not measured from `trajectory`: its pose nearest to point " +
                     std::to_string(point) + " (from 0) is at " + place + ": " + objection);
  return Error(ErrorKind::data, file.string() + ": the sensor position " + place + " of point " +
                                    std::to_string(point) +
                                    " (from 0) is impossible: " + objection);
}

/// The first point with an origin beyond the range of LiDARs; cloud.size(): none.
std::size_t first_too_far(const PointCloud& cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_known(cloud.origin_kind(i))) continue;
    const Vec3f along = cloud.positions[i] - cloud.sensor_positions[i];
    if (!(static_cast<double>(length(along)) <= kFarthestOriginM)) return i;
  }
  return cloud.size();
}

/// The points with beams, and the starts of the beams.
struct MeasuredPoints {
  std::vector<Vec3f> positions, origins;

  bool of_one_station() const {
    return std::ranges::all_of(origins, [&](Vec3f o) { return o == origins.front(); });
  }
};

MeasuredPoints measured_points(const PointCloud& cloud) {
  MeasuredPoints points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    points.positions.push_back(cloud.positions[i]);
    points.origins.push_back(cloud.sensor_positions[i]);
  }
  return points;
}

}  // namespace

PointOrigins::PointOrigins(const LoadOptions& options) : viewpoint_(options.viewpoint) {
  if (options.trajectory.empty()) return;
  trajectory_ = read_trajectory(options.trajectory);
  for (const TimedPose& pose : trajectory_)
    if (!is_valid_position(pose.world_from_sensor.translation))
      throw Error(ErrorKind::data,
                  options.trajectory.string() + ": a position is beyond 1e12 m; expected metres");
  nearest_.emplace(trajectory_);
}

PointOrigin PointOrigins::of(const CloudPart& part, std::size_t i, Vec3d world,
                             const PartRun& run) const {
  if (part.is_sequence) return {beam_origin(part, i, run, world), OriginKind::measured};
  if (!part.world_sensors.empty() && is_finite(part.world_sensors[i])) {
    const OriginKind kind =
        part.cloud.origin_kinds.empty() ? OriginKind::measured : part.cloud.origin_kinds[i];
    if (is_known(kind)) return {part.world_sensors[i], kind};
  }
  if (viewpoint_) return {*viewpoint_, OriginKind::stated};
  if (nearest_) {
    const TimedPose& pose = trajectory_[nearest_->find(world.x, world.y)];
    return {pose.world_from_sensor.translation, OriginKind::guessed};
  }
  return {world, OriginKind::none};
}

void check_origins(const PointCloud& cloud, const std::filesystem::path& file,
                   const LoadOptions& options, const Executor& executor) {
  if (cloud.sensor_positions.empty()) return;
  const std::size_t far = first_too_far(cloud);
  if (far < cloud.size()) {
    const Vec3f along = cloud.positions[far] - cloud.sensor_positions[far];
    const long distance_km = std::lround(static_cast<double>(length(along)) / 1000);
    throw origin_error(
        file, cloud, far, options,
        "it is " + std::to_string(distance_km) + " km from the point, beyond the range of LiDARs");
  }
  if (options.trust_origins) return;
  std::size_t first = 0;
  while (first < cloud.size() && !is_beam(cloud.origin_kind(first))) ++first;
  if (first == cloud.size()) return;
  MeasuredPoints points = measured_points(cloud);
  if (points.of_one_station()) {
    std::vector<Vec3f>& ways = points.positions;
    for (std::size_t i = 0; i < ways.size(); ++i) ways[i] = ways[i] - points.origins[i];
    const std::string objection = station_objection(view_from_station(ways, executor));
    if (!objection.empty()) throw origin_error(file, cloud, first, options, objection);
    return;
  }
  const std::string objection =
      path_objection(view_from_path(points.positions, points.origins, executor));
  if (!objection.empty())
    throw Error(ErrorKind::data, file.string() + ": the sensor positions" +
                                     (options.trajectory.empty() ? "" : " of the trajectory") +
                                     " do not fit the points: " + objection);
}

}  // namespace adasplats
