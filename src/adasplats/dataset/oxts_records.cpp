// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/oxts_records.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <utility>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr double kFirstLatitude_deg = 49, kFirstLongitude_deg = 8.4;
constexpr double kEarthRadius_m = 6378137;  // value of the devkit
constexpr double kGravity_m_s2 = 9.81;

/// Name and meaning of each value, in order.
constexpr std::array<std::pair<const char*, const char*>, 30> kOxtsValues = {{
    {"lat", "latitude (deg)"},
    {"lon", "longitude (deg)"},
    {"alt", "altitude (m)"},
    {"roll", "roll angle (rad), 0: level, positive: left side up"},
    {"pitch", "pitch angle (rad), 0: level, positive: front down"},
    {"yaw", "heading (rad), 0: east, positive: counter-clockwise"},
    {"vn", "velocity towards north (m/s)"},
    {"ve", "velocity towards east (m/s)"},
    {"vf", "forward velocity, parallel to the ground (m/s)"},
    {"vl", "leftward velocity, parallel to the ground (m/s)"},
    {"vu", "upward velocity (m/s)"},
    {"ax", "acceleration in x, the front of the vehicle, with gravity (m/s^2)"},
    {"ay", "acceleration in y, its left, with gravity (m/s^2)"},
    {"az", "acceleration in z, its top, with gravity (m/s^2)"},
    {"af", "forward acceleration, parallel to the ground (m/s^2)"},
    {"al", "leftward acceleration, parallel to the ground (m/s^2)"},
    {"au", "upward acceleration, with gravity (m/s^2)"},
    {"wx", "angular rate around x (rad/s)"},
    {"wy", "angular rate around y (rad/s)"},
    {"wz", "angular rate around z (rad/s)"},
    {"wf", "angular rate around the forward axis (rad/s)"},
    {"wl", "angular rate around the leftward axis (rad/s)"},
    {"wu", "angular rate around the upward axis (rad/s)"},
    {"pos_accuracy", "accuracy of the position (m)"},
    {"vel_accuracy", "accuracy of the velocity (m/s)"},
    {"navstat", "navigation status"},
    {"numsats", "satellites tracked"},
    {"posmode", "mode of the position"},
    {"velmode", "mode of the velocity"},
    {"orimode", "mode of the orientation"},
}};

/// The inverse of rotation_from_yaw_pitch_roll(): yaw, pitch and roll of `r`.
struct Angles {
  double yaw_rad, pitch_rad, roll_rad;

  explicit Angles(const Mat3d& r)
      : yaw_rad(std::atan2(r.rows[1].x, r.rows[0].x)),
        pitch_rad(std::atan2(-r.rows[2].x, std::hypot(r.rows[0].x, r.rows[1].x))),
        roll_rad(std::atan2(r.rows[2].y, r.rows[2].z)) {}
};

/// The rotation from a to b as a rotation vector, radians, world axes.
Vec3d turn_between(const Mat3d& a, const Mat3d& b) {
  const Quaternion q = quaternion_from_rotation(b * a.transposed());
  const Vec3d axis = {q.x, q.y, q.z};
  const double sine = length(axis);
  return sine < 1e-12 ? 2.0 * axis : (2 * std::atan2(sine, q.w) / sine) * axis;
}

/// Latitude and longitude of a position in metres relative to the first record.
std::array<double, 2> degrees_of(Vec3d from_first_m) {
  const double mercator_m = std::cos(kFirstLatitude_deg * kDegree) * kEarthRadius_m;
  constexpr double kQuarter = std::numbers::pi / 4;
  const double first = std::log(std::tan(kQuarter + 0.5 * kFirstLatitude_deg * kDegree));
  const double latitude = 2 * (std::atan(std::exp(first + from_first_m.y / mercator_m)) - kQuarter);
  return {latitude / kDegree, kFirstLongitude_deg + from_first_m.x / mercator_m / kDegree};
}

}  // namespace

OxtsRecords::OxtsRecords(const Trajectory& imu) : imu_(imu) {}

OxtsRecords::Motion OxtsRecords::motion_at(std::size_t index) const {
  const TimedPose& before = imu_[index == 0 ? 0 : index - 1];
  const TimedPose& behind = imu_[std::min(index + 1, imu_.size() - 1)];
  const double apart_s = behind.time_s - before.time_s;
  if (!(apart_s > 0)) return {};
  const RigidTransform &a = before.world_from_sensor, &b = behind.world_from_sensor;
  return {(b.translation - a.translation) / apart_s,
          turn_between(a.rotation, b.rotation) / apart_s};
}

Vec3d OxtsRecords::acceleration_at(std::size_t index) const {
  const std::size_t before = index == 0 ? 0 : index - 1;
  const std::size_t behind = std::min(index + 1, imu_.size() - 1);
  const double apart_s = imu_[behind].time_s - imu_[before].time_s;
  if (!(apart_s > 0)) return {};
  return (motion_at(behind).velocity_m_s - motion_at(before).velocity_m_s) / apart_s;
}

OxtsPlace OxtsRecords::place(std::size_t index) const {
  const Vec3d at = imu_[index].world_from_sensor.translation;
  const auto [latitude, longitude] = degrees_of(at - imu_.front().world_from_sensor.translation);
  return {latitude, longitude, at.z, motion_at(index).velocity_m_s};
}

std::string OxtsRecords::line(std::size_t index) const {
  const RigidTransform& pose = imu_[index].world_from_sensor;
  const OxtsPlace at = place(index);
  const Angles angles(pose.rotation);
  // The frame of the vehicle's heading on level ground: forward, left, up.
  const Mat3d level = rotation_from_yaw_pitch_roll(angles.yaw_rad, 0, 0).transposed();
  const Mat3d body = pose.rotation.transposed();
  const Vec3d turning = motion_at(index).rate_rad_s;
  const Vec3d felt = acceleration_at(index) + Vec3d{0, 0, kGravity_m_s2};
  const Vec3d v = level * at.velocity_m_s, a = body * felt, a_level = level * felt;
  const Vec3d w = body * turning, w_level = level * turning;
  std::string line;
  for (const double value : {at.latitude_deg,
                             at.longitude_deg,
                             at.altitude_m,
                             angles.roll_rad,
                             angles.pitch_rad,
                             angles.yaw_rad,
                             at.velocity_m_s.y,
                             at.velocity_m_s.x,
                             v.x,
                             v.y,
                             v.z,
                             a.x,
                             a.y,
                             a.z,
                             a_level.x,
                             a_level.y,
                             a_level.z,
                             w.x,
                             w.y,
                             w.z,
                             w_level.x,
                             w_level.y,
                             w_level.z})
    line += exact_text(value) + ' ';
  // Accuracies, and the usual states of KITTI's records.
  return line + "0.05 0.01 4 10 4 4 0\n";
}

std::string oxts_data_format() {
  std::string text;
  for (const auto& [name, meaning] : kOxtsValues) text += std::string(name) + ": " + meaning + "\n";
  return text;
}

std::string date_and_time(double time_s, std::string_view what) {
  constexpr double kFirst_s = -62167219200, kEnd_s = 253402300800;  // years 0 to 9999
  constexpr double kNanoseconds = 1e9;
  if (!(time_s >= kFirst_s && time_s < kEnd_s - 1))
    throw Error(ErrorKind::data, std::string(what) + ": the time " + exact_text(time_s) +
                                     " s is not a date, expected seconds since 1970");
  double whole_s = std::floor(time_s);
  auto nanoseconds = static_cast<std::int64_t>(std::llround((time_s - whole_s) * kNanoseconds));
  if (nanoseconds == static_cast<std::int64_t>(kNanoseconds)) {
    nanoseconds = 0;
    whole_s += 1;
  }
  const std::chrono::sys_seconds at{std::chrono::seconds(static_cast<std::int64_t>(whole_s))};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(at - day);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u %02d:%02d:%02d.%09lld",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()), static_cast<long long>(nanoseconds));
  return text.data();
}

}  // namespace adasplats
