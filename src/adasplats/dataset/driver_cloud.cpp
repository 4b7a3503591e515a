// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/driver_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/ros_messages.h"

namespace adasplats {
namespace {

constexpr double kNanosecondsOfSecond = 1e9;
constexpr std::uint32_t kNoRow = ~std::uint32_t{0};
constexpr double kFullByte = 255;

/// What a field of a cloud holds.
enum class Value : std::uint8_t {
  x,
  y,
  z,
  intensity,    ///< 0 to 255
  ring,         ///< 0 the topmost
  ring_above,   ///< 0 the lowest
  seconds,      ///< since the time of the message
  nanoseconds,  ///< likewise
  clock_s,      ///< in the clock of the message
  millimetres,  ///< the range from the axis of the sensor
  zero,
  return_type,
  azimuth,  ///< clockwise from +y, rad
  elevation,
  distance
};

struct DriverField {
  std::string_view name;
  ColumnType type;
  std::uint32_t offset;
  Value value;
};

constexpr DriverField kVelodyne[] = {{"x", ColumnType::f32, 0, Value::x},
                                     {"y", ColumnType::f32, 4, Value::y},
                                     {"z", ColumnType::f32, 8, Value::z},
                                     {"intensity", ColumnType::f32, 12, Value::intensity},
                                     {"ring", ColumnType::u16, 16, Value::ring_above},
                                     {"time", ColumnType::f32, 18, Value::seconds}};
// With the fourth coordinate of PCL's points.
constexpr DriverField kOuster[] = {{"x", ColumnType::f32, 0, Value::x},
                                   {"y", ColumnType::f32, 4, Value::y},
                                   {"z", ColumnType::f32, 8, Value::z},
                                   {"intensity", ColumnType::f32, 16, Value::intensity},
                                   {"t", ColumnType::u32, 20, Value::nanoseconds},
                                   {"reflectivity", ColumnType::u16, 24, Value::intensity},
                                   {"ring", ColumnType::u16, 26, Value::ring},
                                   {"ambient", ColumnType::u16, 28, Value::zero},
                                   {"range", ColumnType::u32, 32, Value::millimetres}};
constexpr DriverField kHesai[] = {{"x", ColumnType::f32, 0, Value::x},
                                  {"y", ColumnType::f32, 4, Value::y},
                                  {"z", ColumnType::f32, 8, Value::z},
                                  {"intensity", ColumnType::f32, 12, Value::intensity},
                                  {"ring", ColumnType::u16, 16, Value::ring},
                                  {"timestamp", ColumnType::f64, 18, Value::clock_s}};
constexpr DriverField kNebula[] = {{"x", ColumnType::f32, 0, Value::x},
                                   {"y", ColumnType::f32, 4, Value::y},
                                   {"z", ColumnType::f32, 8, Value::z},
                                   {"intensity", ColumnType::u8, 12, Value::intensity},
                                   {"return_type", ColumnType::u8, 13, Value::return_type},
                                   {"channel", ColumnType::u16, 14, Value::ring},
                                   {"azimuth", ColumnType::f32, 16, Value::azimuth},
                                   {"elevation", ColumnType::f32, 20, Value::elevation},
                                   {"distance", ColumnType::f32, 24, Value::distance},
                                   {"time_stamp", ColumnType::u32, 28, Value::nanoseconds}};

struct DriverLayout {
  DriverTopic topic;
  std::span<const DriverField> fields;
  std::size_t step;
  float none_m;          ///< coordinates of beams without return
  float none_intensity;  ///< their intensity
};

DriverLayout layout_of(CloudDriver driver) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  switch (driver) {
    case CloudDriver::velodyne:
      return {{"/velodyne_points", "velodyne"}, kVelodyne, 22, kNaN, kNaN};
    case CloudDriver::ouster: return {{"/ouster/points", "os_lidar"}, kOuster, 48, kNaN, 0};
    case CloudDriver::hesai: return {{"/lidar_points", "hesai_lidar"}, kHesai, 26, 0, 0};
    case CloudDriver::nebula: return {{"/pandar_points", "hesai"}, kNebula, 32, 0, 0};
    case CloudDriver::adasplats: break;
  }
  return {{"/points", "lidar"}, {}, 0, 0, 0};
}

bool is_regular(const LidarModel& sensor, const std::vector<Firing>& firings) {
  const ImageSize size = image_size_of(firings);
  if (sensor.columns == 0 || !repeats(sensor) || size.columns > sensor.columns) return false;
  std::vector<std::uint8_t> fires(size.rings * size.columns);
  return std::ranges::all_of(firings, [&](const Firing& firing) {
    return fires[firing.ring * size.columns + firing.column]++ == 0;
  });
}

void put_number(char* to, ColumnType type, double value) {
  const auto put = [to](auto number) { std::memcpy(to, &number, sizeof(number)); };
  switch (type) {
    case ColumnType::f32: return put(static_cast<float>(value));
    case ColumnType::f64: return put(value);
    case ColumnType::u8: return put(static_cast<std::uint8_t>(value));
    case ColumnType::u16: return put(static_cast<std::uint16_t>(value));
    case ColumnType::u32: return put(static_cast<std::uint32_t>(value));
    default: throw std::logic_error("put_number: no driver has fields of this type");
  }
}

/// Columns by which a beam points later than the head, so that the columns of an image have equal
/// azimuths: Ouster's pixel_shift_by_row.
std::vector<std::size_t> column_shifts(const LidarModel& sensor, std::size_t rings) {
  std::vector<std::size_t> shifts(rings, 0);
  if (sensor.azimuth_offsets_rad.size() != rings) return shifts;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double ahead = (sensor.clockwise ? -1 : 1) * sensor.azimuth_offsets_rad[ring];
    const double turns = ahead / (2 * std::numbers::pi);
    shifts[ring] =
        static_cast<std::size_t>(std::lround((turns - std::floor(turns)) * sensor.columns));
  }
  return shifts;
}

}  // namespace

DriverTopic topic_of(CloudDriver driver) { return layout_of(driver).topic; }

RigidTransform sensor_from_frame(CloudDriver driver, const LidarModel& sensor) {
  switch (driver) {
    case CloudDriver::ouster: {
      const double height_m = sensor.beam_origins_m.empty() ? 0.0 : sensor.beam_origins_m.front().z;
      return {{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}, {0, 0, height_m}};
    }
    case CloudDriver::hesai:
    case CloudDriver::nebula: return {{{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}}, {}};
    default: return {};
  }
}

void require_driver(CloudDriver driver, const PacketOptions& options) {
  if (driver == CloudDriver::adasplats) return;
  if (options.sensor == nullptr) throw std::logic_error("clouds of drivers need the sensor");
  const LidarModel& sensor = *options.sensor;
  const auto reject = [&](const std::string& why) {
    throw Error(ErrorKind::usage, "cannot write scans of sensor '" + sensor.name +
                                      "' as the driver '" +
                                      std::string(word_of(driver, kCloudDrivers)) + "': " + why);
  };
  if (!is_regular(sensor, firings_of(sensor)))
    reject(
        "its clouds need beams that fire column by column, but the pattern of this sensor has no "
        "rings and columns; use --driver adasplats");
  if (!options.is_raw)
    reject("drivers publish points as measured, without motion compensation; use --points raw");
  const bool has_nanoseconds = driver == CloudDriver::ouster || driver == CloudDriver::nebula;
  constexpr double kLongest_s = 4.29;  // 32 bits of nanoseconds
  if (has_nanoseconds && sensor.rotation_hz * kLongest_s < 1)
    reject("times of points hold 4.29 s, but a revolution takes " +
           std::to_string(1 / sensor.rotation_hz) + " s; increase --rotation-rate");
  if (driver == CloudDriver::ouster && options.returns > 1)
    reject("it publishes each return as a topic of its own; use --returns 1");
}

struct DriverClouds::Point {
  Vec3f position;  ///< in the driver's frame
  double intensity = 0, range_mm = 0;
  std::size_t ring = 0, rings = 0;
  double time_s = 0, stamp_s = 0;  ///< the former since the latter
  double return_type = 0;

  double value(Value value) const {
    const auto x = static_cast<double>(position.x), y = static_cast<double>(position.y),
               z = static_cast<double>(position.z);
    constexpr double kTurn_rad = 2 * std::numbers::pi;
    switch (value) {
      case Value::x: return x;
      case Value::y: return y;
      case Value::z: return z;
      case Value::intensity: return intensity;
      case Value::ring: return static_cast<double>(ring);
      case Value::ring_above: return static_cast<double>(rings - 1 - ring);
      case Value::seconds: return time_s;
      case Value::nanoseconds: return std::max(0.0, std::round(time_s * kNanosecondsOfSecond));
      case Value::clock_s: return stamp_s + time_s;
      case Value::millimetres: return range_mm;
      case Value::return_type: return return_type;
      case Value::azimuth: {
        const double azimuth = std::atan2(x, y);
        return azimuth < 0 ? azimuth + kTurn_rad : azimuth;
      }
      case Value::elevation: return std::atan2(z, std::hypot(x, y));
      case Value::distance: return std::sqrt(x * x + y * y + z * z);
      case Value::zero: break;
    }
    return 0;
  }
  void write(const DriverLayout& layout, std::size_t place, char* to) const {
    for (const DriverField& field : layout.fields)
      put_number(to + place * layout.step + field.offset, field.type, value(field.value));
  }
};

DriverClouds::DriverClouds(CloudDriver driver, const PacketOptions& options) : driver_(driver) {
  if (driver == CloudDriver::adasplats) return;
  require_driver(driver, options);
  const LidarModel& sensor = *options.sensor;
  sensor_from_points_ = sensor_from_frame(driver, sensor);
  returns_ = static_cast<std::size_t>(options.returns);
  constexpr double kLast = 1, kFirst = 2, kStrongest = 3;
  return_type_ = options.mode == ReturnMode::first  ? kFirst
                 : options.mode == ReturnMode::last ? kLast
                                                    : kStrongest;
  full_intensity_ = options.full_intensity;
  size_ = {sensor.rings(), sensor.columns};
  column_shift_ = column_shifts(sensor, size_.rings);
  from_axis_m_.assign(size_.rings, 0);
  for (std::size_t ring = 0; ring < sensor.beam_origins_m.size(); ++ring)
    from_axis_m_[ring] = sensor.beam_origins_m[ring].x;
  row_of_.assign(size_.columns, kNoRow);
  const double columns_hz = sensor.rotation_hz * sensor.columns;
  for (std::size_t ring = 0; ring < size_.rings; ++ring)
    for (std::size_t column = 0; column < size_.columns; ++column)
      times_s_.push_back(static_cast<float>(static_cast<double>(column) / columns_hz));
  for (const Firing& firing : firings_of(sensor)) {
    row_of_[firing.column] = 0;
    times_s_[firing.ring * size_.columns + firing.column] = firing.time_s;
  }
  for (std::uint32_t& row : row_of_)
    if (row != kNoRow) row = static_cast<std::uint32_t>(rows_++);
}

std::size_t DriverClouds::place_of(std::size_t ring, std::size_t column, std::size_t number) const {
  if (driver_ == CloudDriver::ouster) {
    const std::size_t shifted = column + column_shift_[ring];
    return ring * size_.columns + (shifted < size_.columns ? shifted : shifted - size_.columns);
  }
  const std::size_t from_first = driver_ == CloudDriver::velodyne ? size_.rings - 1 - ring : ring;
  return (row_of_[column] * returns_ + number) * size_.rings + from_first;
}

DriverClouds::Point DriverClouds::point_of(const ScanView& scan, std::size_t i,
                                           double stamp_s) const {
  const std::size_t number = scan.return_indices.empty() ? 0 : scan.return_indices[i];
  constexpr double kMillimetres = 1000;
  constexpr double kSecond = 7;  // return type of Nebula
  Point point;
  const Vec3d position = sensor_from_points_.inverse() * vec_cast<double>(scan.positions[i]);
  point.position = vec_cast<float>(position);
  const double share = scan.intensities.empty() ? 0 : double{scan.intensities[i]} / full_intensity_;
  point.intensity = share > 0 ? std::round(kFullByte * std::min(share, 1.0)) : 0;  // 0 for NaN
  point.ring = scan.rings[i];
  point.range_mm = std::round(kMillimetres * (double{scan.ranges_m[i]} + from_axis_m_[point.ring]));
  point.rings = size_.rings;
  point.time_s = scan.moved() ? double{scan.times_s[i]} : 0;
  point.stamp_s = stamp_s;
  point.return_type = number == 0 ? return_type_ : kSecond;
  return point;
}

void DriverClouds::write_grid(const ScanView& scan, double stamp_s, char* to) const {
  const DriverLayout layout = layout_of(driver_);
  Point nothing;
  nothing.position = {layout.none_m, layout.none_m, layout.none_m};
  nothing.intensity = double{layout.none_intensity};
  nothing.rings = size_.rings;
  nothing.stamp_s = stamp_s;
  for (std::size_t ring = 0; ring < size_.rings; ++ring)
    for (std::size_t column = 0; column < size_.columns; ++column) {
      const bool fires = row_of_[column] != kNoRow;
      if (!fires && driver_ != CloudDriver::ouster) continue;
      nothing.ring = ring;
      nothing.time_s = scan.moved() && fires ? double{times_s_[ring * size_.columns + column]} : 0;
      for (std::size_t number = 0; number < returns_; ++number)
        nothing.write(layout, place_of(ring, column, number), to);
    }
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::size_t number = scan.return_indices.empty() ? 0 : scan.return_indices[i];
    point_of(scan, i, stamp_s).write(layout, place_of(scan.rings[i], scan.columns[i], number), to);
  }
}

std::string DriverClouds::message(const ScanView& scan, std::string_view frame,
                                  double later_s) const {
  if (driver_ == CloudDriver::adasplats) return point_cloud2_message(scan, frame, later_s);
  if (scan.rings.size() != scan.size() || scan.columns.size() != scan.size() ||
      scan.ranges_m.size() != scan.size() || (scan.moved() && scan.times_s.size() != scan.size()))
    throw std::logic_error("clouds of drivers need rings, columns, ranges and times of the scan");
  const DriverLayout layout = layout_of(driver_);
  std::vector<RosCloudField> fields;
  for (const auto& [name, type, offset, value] : layout.fields)
    fields.push_back({name, type, offset});
  RosCloud cloud{ros_stamp_s(scan) + later_s,    frame,  1,
                 rows_ * returns_ * size_.rings, fields, layout.step};
  if (driver_ == CloudDriver::velodyne) {
    cloud.height = rows_ * returns_;
    cloud.width = size_.rings;
  } else if (driver_ == CloudDriver::ouster) {
    cloud.height = size_.rings;
    cloud.width = size_.columns;
  } else if (driver_ == CloudDriver::nebula) {
    cloud.width = scan.size();
  }
  const double stamp_s = cloud.time_s;
  const bool is_full = scan.size() == cloud.height * cloud.width;
  cloud.is_dense = driver_ != CloudDriver::velodyne && driver_ != CloudDriver::hesai && is_full;
  return cloud_message(cloud, [&](char* to) {
    if (driver_ != CloudDriver::nebula) return write_grid(scan, stamp_s, to);
    std::size_t place = 0;
    for (const std::uint32_t i : driver_order(scan, FirstRing::top))
      point_of(scan, i, stamp_s).write(layout, place++, to);
  });
}

}  // namespace adasplats
