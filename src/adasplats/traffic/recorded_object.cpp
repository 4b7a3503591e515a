// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/recorded_object.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

/// The turn about z from the axes of boxes to those of the object, in quarter turns.
int quarter_turns(const BoxTrack& track) {
  const TimedBox &first = track.boxes.front(), &last = track.boxes.back();
  // The longest way counts, so that a loop has a direction, too.
  Vec3d way;
  for (const TimedBox& box : track.boxes)
    if (const Vec3d from_first = box.middle - first.middle; length(from_first) > length(way))
      way = from_first;
  constexpr double kMoves_m = 1;
  if (length(way) < kMoves_m) return last.half_size.x >= last.half_size.y ? 0 : 1;
  // Sums how far each step goes along the axes of its box.
  double along_x = 0, along_y = 0;
  for (std::size_t k = 1; k < track.boxes.size(); ++k) {
    const TimedBox& box = track.boxes[k];
    const Vec3d step = box.middle - track.boxes[k - 1].middle;
    const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
    along_x += c * step.x + s * step.y;
    along_y += -s * step.x + c * step.y;
  }
  if (std::fabs(along_x) >= std::fabs(along_y)) return along_x >= 0 ? 0 : 2;
  return along_y >= 0 ? 1 : 3;
}

/// Beams through the box grown by this factor are collected: splats may reach out of it.
constexpr double kPassing = 1.2;

/// Whether a beam comes near a sphere that it may leave again.
bool may_pass(const MeasuredBeam& beam, Vec3d middle, double radius_m) {
  const Vec3d way = beam.end - beam.origin, to_middle = middle - beam.origin;
  const double along = dot(way, to_middle), length2 = dot(way, way);
  // The object moves during the scan: 3 m are enough for any vehicle within it.
  const double reach_m = radius_m + 3;
  return along > 0 && length2 > 0 &&
         dot(to_middle, to_middle) - along * along / length2 < reach_m * reach_m;
}

/// Whether a segment enters and leaves a box around the origin.
bool passes(Vec3d from, Vec3d to, Vec3d half_size) {
  const Vec3d way = to - from;
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double begin = from[axis], step = way[axis], half = half_size[axis];
    if (step == 0) {
      if (std::fabs(begin) > half) return false;
      continue;
    }
    const double a = (-half - begin) / step, b = (half - begin) / step;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave && enter > 0 && leave < 1;
}

}  // namespace

std::size_t RecordedObject::points() const {
  std::size_t count = 0;
  for (const ObjectScan& scan : scans) count += scan.points.size();
  return count;
}

RecordedObject object_of(const BoxTrack& track) {
  RecordedObject object;
  object.id = track.id;
  object.label = track.label;
  const int turns = quarter_turns(track);
  const Vec3d size = 2.0 * track.boxes.front().half_size;
  object.size_m = turns % 2 == 0 ? size : Vec3d{size.y, size.x, size.z};
  for (const TimedBox& box : track.boxes) {
    const double yaw_rad = box.yaw_rad + turns * std::numbers::pi / 2;
    object.world_from_object.push_back(
        {box.time_s, {rotation_from_yaw_pitch_roll(yaw_rad, 0, 0), box.middle}});
  }
  return object;
}

ObjectCollector::ObjectCollector(const MovingBoxes& boxes) : are_of_scans_(boxes.are_of_scans()) {
  for (const BoxTrack& track : boxes.tracks()) objects_.push_back(object_of(track));
}

std::vector<ObjectCollector::Part> ObjectCollector::parts_of(const KittiSequence& drive,
                                                             std::size_t index,
                                                             const KittiScan& scan) const {
  constexpr double kGround_m = 0.05;
  if (scan.in_boxes.empty()) return {};
  if (scan.in_boxes.size() != scan.positions.size())
    throw std::logic_error("ObjectCollector: not one object number a point");
  const TimedPose& pose = drive.trajectory[index];
  std::map<std::size_t, ObjectScan> scans;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (scan.in_boxes[i] == 0) continue;
    const std::size_t number = scan.in_boxes[i] - std::size_t{1};
    const RecordedObject& object = objects_.at(number);
    const double time_s = time_of_point(scan, pose, i);
    const RigidTransform object_from_sensor =
        interpolate(object.world_from_object, are_of_scans_ ? pose.time_s : time_s).inverse() *
        pose.world_from_sensor;
    const MeasuredBeam beam = beam_of(drive, index, scan, i);
    const Vec3d point = object_from_sensor * beam.end;
    if (point.z < -0.5 * object.size_m.z + kGround_m) continue;
    ObjectScan& of_scan = scans[number];
    of_scan.scan = index;
    of_scan.points.push_back(point);
    of_scan.origins.push_back(object_from_sensor * beam.origin);
    if (!scan.intensities.empty()) of_scan.intensities.push_back(scan.intensities[i]);
    // The running mean.
    of_scan.time_s += (time_s - of_scan.time_s) / static_cast<double>(of_scan.points.size());
  }
  std::vector<Part> parts;
  if (scans.empty()) return parts;
  std::vector<MeasuredBeam> beams;
  beams.reserve(scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i)
    beams.push_back(beam_of(drive, index, scan, i));
  for (auto& [number, of_scan] : scans) {
    parts.push_back({number, std::move(of_scan)});
    add_passing(pose, scan, beams, parts.back());
  }
  return parts;
}

void ObjectCollector::add(std::vector<Part> parts) {
  for (Part& part : parts) objects_.at(part.number).scans.push_back(std::move(part.scan));
}

void ObjectCollector::add_passing(const TimedPose& pose, const KittiScan& scan,
                                  std::span<const MeasuredBeam> beams, Part& part) const {
  const RecordedObject& object = objects_[part.number];
  ObjectScan& of_scan = part.scan;
  of_scan.world_from_object =
      interpolate(object.world_from_object, are_of_scans_ ? pose.time_s : of_scan.time_s);
  const Vec3d half_size = kPassing * 0.5 * object.size_m;
  const RigidTransform sensor_from_object =
      pose.world_from_sensor.inverse() * of_scan.world_from_object;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (scan.in_boxes[i] == part.number + 1) continue;
    const MeasuredBeam& beam = beams[i];
    if (!may_pass(beam, sensor_from_object.translation, length(half_size))) continue;
    const double time_s = are_of_scans_ ? pose.time_s : time_of_point(scan, pose, i);
    const RigidTransform object_from_sensor =
        interpolate(object.world_from_object, time_s).inverse() * pose.world_from_sensor;
    const Vec3d origin = object_from_sensor * beam.origin, end = object_from_sensor * beam.end;
    if (passes(origin, end, half_size))
      of_scan.passing.push_back({origin, normalized(end - origin)});
  }
}

}  // namespace adasplats
