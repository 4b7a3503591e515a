// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/street_plan.h"
#include "adasplats/synth/street_scan.h"

namespace adasplats {
namespace {

constexpr double kMargin_m = 2;      // left out at both ends
constexpr double kTurnRound_s = 15;  // between passes
constexpr double kWander_m = 0.12;   // lateral drift of the vehicle
constexpr double kWanderLength_m = 9;
constexpr std::uint64_t kPoseErrorStream = 0x706f7365;

double vehicle_y(int direction, int pass, double x) {
  return -direction * kLaneCenter + kWander_m * std::sin(x / kWanderLength_m + pass);
}

/// Forward path of a pass with turns: up the cross street at the begin, around the corner, along
/// the street, around the corner and up the cross street at the end; quarter arcs between straight
/// lines.
constexpr double kApproach_m = 10, kTurnRadius_m = 6;
constexpr double kArc_m = 0.5 * std::numbers::pi * kTurnRadius_m;

double straight_between_turns(const Street& street) {
  return street.length_m + kCrossRoad - 2 * kTurnRadius_m;
}

/// Position after `travelled` metres; z is 0.
Vec3d position_on_turning_path(const Street& street, double travelled) {
  const double r = kTurnRadius_m;
  const Vec3d right = {-0.5 * kCrossRoad + r, -kLaneCenter - r, 0};  // centers of the turns
  const double straight_m = straight_between_turns(street);
  const Vec3d left = {right.x + straight_m, -kLaneCenter + r, 0};
  if (travelled < kApproach_m) return right + Vec3d{-r, travelled - kApproach_m, 0};
  travelled -= kApproach_m;
  if (travelled < kArc_m)
    return right + r * Vec3d{-std::cos(travelled / r), std::sin(travelled / r), 0};
  travelled -= kArc_m;
  if (travelled < straight_m) return right + Vec3d{travelled, r, 0};
  travelled -= straight_m;
  if (travelled < kArc_m)
    return left + r * Vec3d{std::sin(travelled / r), -std::cos(travelled / r), 0};
  return left + Vec3d{r, travelled - kArc_m, 0};
}

/// Pose of the vehicle on the road, pitched towards a position ahead, without roll.
RigidTransform vehicle_between(Vec3d here, Vec3d further) {
  const Vec3d ahead = further - here;
  const double yaw = std::atan2(ahead.y, ahead.x);
  const double climb = std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
  return {rotation_from_yaw_pitch_roll(yaw, -climb, 0), here};
}

/// Pose of the vehicle after `travelled` metres of a pass.
RigidTransform world_from_vehicle(const Street& street, bool turns, int pass, double travelled) {
  const int direction = pass % 2 == 0 ? 1 : -1;
  const auto on_road = [](double x, double y) { return Vec3d{x, y, road_height(x, y)}; };
  if (turns) {
    const auto position = [&](double at) {
      const Vec3d forth = position_on_turning_path(street, at);
      return direction > 0 ? on_road(forth.x, forth.y)
                           : on_road(street.length_m - forth.x, -forth.y);
    };
    return vehicle_between(position(travelled), position(travelled + 1));
  }
  const double x = direction > 0 ? kMargin_m + travelled : street.length_m - kMargin_m - travelled;
  const auto position = [&](double at) { return on_road(at, vehicle_y(direction, pass, at)); };
  return vehicle_between(position(x), position(x + direction * 1.0));
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
  // A negative pitch turns +x up: the scan plane rises at the front and meets the road at the rear.
  return {rotation_from_yaw_pitch_roll(0, -0.25 * std::numbers::pi, 0), {-0.4, 0, 2.0}};
}

RigidTransform vehicle_from_driving_sensor() {
  return {rotation_from_yaw_pitch_roll(0, 0, 0), {0, 0, 1.73}};
}

double drive_length(const Street& street, const StreetScanOptions& options) {
  if (options.turns) return 2 * (kApproach_m + kArc_m) + straight_between_turns(street);
  return street.length_m - 2 * kMargin_m;
}

std::vector<RecordedPose> poses_of_pass(const Street& street, const StreetScanOptions& options,
                                        int pass, std::size_t count,
                                        const RigidTransform& vehicle_from_sensor) {
  const double way_m = drive_length(street, options);
  const double start_s = pass * (way_m / options.speed_m_per_s + kTurnRound_s);
  const RigidTransform recorded_from_true = pass_error(street, options, pass);
  std::vector<RecordedPose> poses;
  poses.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double travelled = way_m * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const double time_s = start_s + travelled / options.speed_m_per_s;
    const RigidTransform truth =
        world_from_vehicle(street, options.turns, pass, travelled) * vehicle_from_sensor;
    poses.push_back({{time_s, truth}, {time_s, recorded_from_true * truth}});
  }
  return poses;
}

}  // namespace adasplats
