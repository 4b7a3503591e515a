// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/vehicle_path.h"

#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/street_plan.h"

namespace adasplats {
namespace {

constexpr double kMargin_m = 2;      // not driven at both ends
constexpr double kTurnRound_s = 15;  // between passes
constexpr double kWander_m = 0.12;   // nobody drives dead straight
constexpr double kWanderLength_m = 9;
constexpr std::uint64_t kPoseErrorStream = 0x706f7365;

double vehicle_y(int direction, int pass, double x) {
  return -direction * kLaneCenter + kWander_m * std::sin(x / kWanderLength_m + pass);
}

/// The vehicle on the road after `travelled` metres of a pass, along the slope, level across.
RigidTransform world_from_vehicle(const Street& street, int pass, double travelled) {
  const int direction = pass % 2 == 0 ? 1 : -1;
  const double x = direction > 0 ? kMargin_m + travelled : street.length_m - kMargin_m - travelled;
  const auto on_road = [&](double at) {
    const double y = vehicle_y(direction, pass, at);
    return Vec3d{at, y, road_height(at, y)};
  };
  const Vec3d here = on_road(x);
  const Vec3d ahead = on_road(x + direction * 1.0) - here;
  const double yaw = std::atan2(ahead.y, ahead.x);
  const double climb = std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
  return {rotation_from_yaw_pitch_roll(yaw, -climb, 0), here};
}

/// recorded_from_true of a pass.
RigidTransform pass_error(const Street& street, const StreetScanOptions& options, int pass) {
  Random random(options.seed, kPoseErrorStream, static_cast<std::uint64_t>(pass));
  const double yaw = options.pose_error_rad * random.normal();
  const double pitch = options.pose_error_rad * random.normal();
  const double roll = options.pose_error_rad * random.normal();
  const double dx = options.pose_error_m * random.normal();
  const double dy = options.pose_error_m * random.normal();
  const double dz = options.pose_error_m * random.normal();
  const Mat3d rotation = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
  const Vec3d middle = {0.5 * street.length_m, 0, 0};
  return {rotation, middle - rotation * middle + Vec3d{dx, dy, dz}};
}

}  // namespace

RigidTransform vehicle_from_mapping_sensor() {
  // A negative pitch turns +x up: the plane of the scan rises in front and meets the road behind.
  return {rotation_from_yaw_pitch_roll(0, -0.25 * std::numbers::pi, 0), {-0.4, 0, 2.0}};
}

RigidTransform vehicle_from_driving_sensor() {
  return {rotation_from_yaw_pitch_roll(0, 0, 0), {0, 0, 1.73}};
}

double drive_length(const Street& street) { return street.length_m - 2 * kMargin_m; }

std::vector<RecordedPose> poses_of_pass(const Street& street, const StreetScanOptions& options,
                                        int pass, std::size_t count,
                                        const RigidTransform& vehicle_from_sensor) {
  const double way = drive_length(street);
  const double start_s = pass * (way / options.speed_m_per_s + kTurnRound_s);
  const RigidTransform recorded_from_true = pass_error(street, options, pass);
  std::vector<RecordedPose> poses;
  poses.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double travelled = way * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const double time_s = start_s + travelled / options.speed_m_per_s;
    const RigidTransform truth = world_from_vehicle(street, pass, travelled) * vehicle_from_sensor;
    poses.push_back({{time_s, truth}, {time_s, recorded_from_true * truth}});
  }
  return poses;
}

}  // namespace adasplats
