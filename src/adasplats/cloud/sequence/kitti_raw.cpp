// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

Error fault(const fs::path& file, const std::string& what) {
  return {ErrorKind::data, file.string() + ": " + what};
}

/// Calls body(line, its number from 1) for the lines that are not empty.
template <class Body>
void for_each_line(std::string_view text, Body&& body) {
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (!line.empty()) body(line, number);
  }
}

/// The numbers between the blanks of a line, as many as asked for; more may follow.
template <std::size_t kCount>
std::array<double, kCount> numbers_of(std::string_view line, const fs::path& file,
                                      std::size_t number) {
  std::array<double, kCount> values{};
  for (double& value : values) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const auto parsed = parse_number<double>(line.substr(0, end));
    if (!parsed || !std::isfinite(*parsed))
      throw fault(file, "line " + std::to_string(number) + ": '" +
                            std::string(line.substr(0, end)) + "', expected " +
                            std::to_string(kCount) + " numbers");
    value = *parsed;
    line.remove_prefix(end);
  }
  return values;
}

/// "2011-09-26 13:02:25.964389445" as seconds since 1970.
double seconds_of(std::string_view stamp, const fs::path& file, std::size_t number) {
  const auto part = [&](std::size_t begin, std::size_t size) {
    return stamp.size() < begin + size ? std::nullopt
                                       : parse_number<std::uint16_t>(stamp.substr(begin, size));
  };
  const auto year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2),
             minute = part(14, 2);
  constexpr double kNone = -1;
  const double second =
      stamp.size() < 19 ? kNone : parse_number<double>(stamp.substr(17)).value_or(kNone);
  const bool is_stamp = stamp.size() >= 19 && year && month && day && hour && minute &&
                        stamp[4] == '-' && stamp[7] == '-' && stamp[13] == ':' && stamp[16] == ':';
  const std::chrono::year_month_day date{std::chrono::year(year.value_or(0)),
                                         std::chrono::month(month.value_or(0)),
                                         std::chrono::day(day.value_or(0))};
  if (!is_stamp || !date.ok() || *hour > 23 || *minute > 59 || !(second >= 0 && second < 61))
    throw fault(file, "line " + std::to_string(number) + ": '" + std::string(stamp) +
                          "', expected a time such as 2011-09-26 13:02:25.964389445");
  constexpr double kDay_s = 86400;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return kDay_s * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + second;
}

std::vector<double> read_stamps(const fs::path& file) {
  std::vector<double> times_s;
  const std::string text = read_file(file);
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    times_s.push_back(seconds_of(line, file, number));
  });
  return times_s;
}

/// The stamp of a file by the number that its name is.
double stamp_of(const fs::path& file, const std::vector<double>& times_s, const fs::path& stamps) {
  const auto number = number_in_name(file);
  if (!number || *number >= times_s.size())
    throw fault(file, "its name is not the number (from 0) of one of the " +
                          std::to_string(times_s.size()) + " times in " + stamps.string());
  return times_s[*number];
}

/// velodyne_from_imu, from calib_imu_to_velo.txt.
RigidTransform read_imu_to_velodyne(const fs::path& drive) {
  constexpr const char* kName = "calib_imu_to_velo.txt";
  constexpr double kMaxError = 1e-3;
  fs::path file = drive / kName;
  // A trailing slash makes the last part of a path empty.
  const fs::path above = fs::absolute(drive / ".").lexically_normal().parent_path().parent_path();
  std::error_code ignored;  // what cannot be looked at is not there
  if (!fs::exists(file, ignored)) file = above / kName;
  if (!fs::exists(file, ignored))
    throw Error(ErrorKind::no_input, drive.string() + ": " + kName + " is neither in it nor in " +
                                         above.string() +
                                         ", where KITTI's calibration of the day "
                                         "is unpacked");
  RigidTransform transform;
  bool has_rotation = false, has_translation = false;
  const std::string text = read_file(file);
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    if (line.starts_with("R:")) {
      const auto r = numbers_of<9>(line.substr(2), file, number);
      transform.rotation = {{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}}};
      has_rotation = true;
    } else if (line.starts_with("T:")) {
      const auto t = numbers_of<3>(line.substr(2), file, number);
      transform.translation = {t[0], t[1], t[2]};
      has_translation = true;
    }
  });
  if (!has_rotation || !has_translation || !(orthonormality_error(transform.rotation) < kMaxError))
    throw fault(file, "expected lines R: (a rotation by rows) and T:");
  transform.rotation = orthonormalized(transform.rotation);
  return transform;
}

/// A record of the GPS/IMU unit: latitude and longitude in degrees, altitude in metres, roll, pitch
/// and yaw in radians (yaw 0: east, counter-clockwise).
RigidTransform pose_of_record(const std::array<double, 6>& record, double scale) {
  constexpr double kEarth_m = 6378137;
  const auto [latitude, longitude, altitude, roll, pitch, yaw] = record;
  RigidTransform pose;
  pose.rotation = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
  pose.translation = {
      scale * kEarth_m * longitude * kDegree,
      scale * kEarth_m * std::log(std::tan((90 + latitude) * std::numbers::pi / 360)), altitude};
  return pose;
}

/// Throws data where a record has no place or no angles that can be.
void require_possible(const std::array<double, 6>& record, const fs::path& file) {
  const auto [latitude, longitude, altitude, roll, pitch, yaw] = record;
  if (!(std::fabs(latitude) < 85) || !(std::fabs(longitude) <= 360))
    throw fault(file, "expected latitude, longitude, altitude, roll, pitch and yaw first");
  constexpr double kTurn = 2 * std::numbers::pi, kMaxTilt = std::numbers::pi / 2;
  if (std::fabs(roll) > kMaxTilt || std::fabs(pitch) > kMaxTilt || std::fabs(yaw) > kTurn)
    throw fault(file, "roll, pitch and yaw are " + exact_text(roll) + ", " + exact_text(pitch) +
                          " and " + exact_text(yaw) +
                          ", beyond a quarter turn, a quarter turn and a turn; expected radians");
}

/// world_from_imu by the records, whose first is the origin of the world.
Trajectory read_records(const fs::path& drive) {
  const fs::path stamps = drive / "oxts" / "timestamps.txt";
  const std::vector<double> times_s = read_stamps(stamps);
  Trajectory poses;
  double scale = 0;
  Vec3d origin;
  for (const fs::path& file : files_by_name(drive / "oxts" / "data", ".txt")) {
    const std::string text = read_file(file);
    std::array<double, 6> record{};
    bool is_read = false;
    for_each_line(text, [&](std::string_view line, std::size_t number) {
      if (!is_read) record = numbers_of<6>(line, file, number);
      is_read = true;
    });
    if (!is_read) throw fault(file, "is empty, expected a record");
    require_possible(record, file);
    if (poses.empty()) {
      scale = std::cos(record[0] * kDegree);
      origin = pose_of_record(record, scale).translation;
    }
    TimedPose pose{stamp_of(file, times_s, stamps), pose_of_record(record, scale)};
    pose.world_from_sensor.translation = pose.world_from_sensor.translation - origin;
    // KITTI's own stamps repeat or go back in places, which says nothing new.
    if (poses.empty() || pose.time_s > poses.back().time_s) poses.push_back(pose);
  }
  if (poses.size() < 2) throw fault(drive / "oxts" / "data", "expected two records and more");
  return poses;
}

/// How far records may be from a scan, as drives that are synced have them.
constexpr double kRecord_s = 0.1;

/// Throws data where a scan was measured in a gap of the records or beyond them.
void require_record_near(const Trajectory& records, double time_s, const fs::path& scan) {
  constexpr double kMaxApart = 3;  // of the usual distance of records
  std::vector<double> apart_s;
  for (std::size_t k = 1; k < records.size(); ++k)
    apart_s.push_back(records[k].time_s - records[k - 1].time_s);
  const double usual_s = upper_median_of(apart_s);
  const auto behind = std::ranges::upper_bound(records, time_s, {}, &TimedPose::time_s);
  const bool is_between = behind != records.begin() && behind != records.end();
  // A clock's rounding apart.
  const double max_s = std::max(kMaxApart * usual_s, 1.001 * kRecord_s);
  if (is_between && behind->time_s - std::prev(behind)->time_s <= max_s) return;
  throw fault(scan, "no record of oxts is near its time, " +
                        exact_text(std::round(1e3 * (time_s - records[1].time_s)) / 1e3) +
                        " s after the first record; remove the scan");
}

/// Scans as text, x y z reflectance a line: those of drives that are not synced.
class TextScanReader final : public ScanReader {
 public:
  KittiScan read(const fs::path& file) const override {
    KittiScan scan;
    const std::string text = read_file(file);
    for_each_line(text, [&](std::string_view line, std::size_t number) {
      const auto v = numbers_of<4>(line, file, number);
      scan.positions.push_back(vec_cast<float>(Vec3d{v[0], v[1], v[2]}));
      scan.intensities.push_back(static_cast<float>(v[3]));
    });
    return scan;
  }
};

}  // namespace

bool is_kitti_raw_drive(const fs::path& folder) {
  std::error_code ignored;  // what cannot be looked into is no drive
  return fs::is_directory(folder / "velodyne_points" / "data", ignored) &&
         fs::is_directory(folder / "oxts" / "data", ignored);
}

KittiSequence open_kitti_raw_drive(const fs::path& folder) {
  const fs::path data = folder / "velodyne_points" / "data";
  KittiSequence sequence;
  sequence.folder = folder;
  sequence.scans = files_by_name(data, ".bin");
  if (sequence.scans.empty()) {
    sequence.scans = files_by_name(data, ".txt");
    sequence.reader = std::make_shared<TextScanReader>();
  }
  if (sequence.scans.empty())
    throw Error(ErrorKind::no_input, data.string() + ": holds no .bin or .txt files");
  const fs::path stamps = folder / "velodyne_points" / "timestamps.txt";
  const std::vector<double> times_s = read_stamps(stamps);
  const RigidTransform imu_from_velodyne = read_imu_to_velodyne(folder).inverse();
  const Trajectory records = with_extrapolated_ends(read_records(folder), kRecord_s);
  for (const fs::path& scan : sequence.scans) {
    const double time_s = stamp_of(scan, times_s, stamps);
    require_record_near(records, time_s, scan);
    if (!sequence.trajectory.empty() && !(time_s > sequence.trajectory.back().time_s))
      throw fault(stamps,
                  "the time of " + scan.filename().string() + " is not after the one before");
    sequence.trajectory.push_back({time_s, interpolate(records, time_s) * imu_from_velodyne});
  }
  const Vec3d origin = sequence.trajectory.front().world_from_sensor.translation;
  sequence.trajectory = shifted(std::move(sequence.trajectory), -origin);
  return sequence;
}

}  // namespace adasplats
