// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The calibration files that drivers need in addition to the packets.

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {
namespace {

using MetadataJson = nlohmann::ordered_json;

constexpr double kMillimetres = 1e3;
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

Vec3d origin_of_beam(const LidarModel& model, std::size_t ring) {
  return model.beam_origins_m.empty() ? Vec3d{} : model.beam_origins_m[ring];
}

double offset_of_beam(const LidarModel& model, std::size_t ring) {
  return model.azimuth_offsets_rad.empty() ? 0.0 : model.azimuth_offsets_rad[ring];
}

/// The origin of a beam in components along the beam, upwards and to the left of it. The component
/// along the beam is a correction of the range (read_velodyne_yaml() is the inverse).
struct LaserOffsets {
  double along_m = 0, up_m = 0, left_m = 0;

  LaserOffsets(const LidarModel& model, std::size_t ring) {
    const Vec3d at = origin_of_beam(model, ring);
    const double offset_rad = offset_of_beam(model, ring), tilt_rad = model.elevations_rad[ring];
    const double ahead_m = std::cos(offset_rad) * at.x + std::sin(offset_rad) * at.y;
    left_m = std::cos(offset_rad) * at.y - std::sin(offset_rad) * at.x;
    along_m = std::cos(tilt_rad) * ahead_m + std::sin(tilt_rad) * at.z;
    up_m = std::cos(tilt_rad) * at.z - std::sin(tilt_rad) * ahead_m;
  }
};

std::string velodyne_yaml(const PacketSensor& sensor) {
  const LidarModel& model = sensor.model;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(12);
  text << "lasers:\n";
  for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
    const std::size_t ring = sensor.ring_of_laser[laser];
    const LaserOffsets at(model, ring);
    text << "- {dist_correction: " << at.along_m << ", dist_correction_x: " << at.along_m
         << ", dist_correction_y: " << at.along_m
         << ", focal_distance: 0.0, focal_slope: 0.0,\n  horiz_offset_correction: " << at.left_m
         << ", laser_id: " << laser << ", rot_correction: " << offset_of_beam(model, ring)
         << ",\n  vert_correction: " << model.elevations_rad[ring]
         << ", vert_offset_correction: " << at.up_m << "}\n";
  }
  text << "num_lasers: " << sensor.lasers() << "\ndistance_resolution: " << sensor.facts.quantum_m
       << "\n";
  return text.str();
}

/// The number of columns to shift each row by to align the azimuths of the rows.
std::vector<int> pixel_shifts(const LidarModel& model, const std::vector<double>& azimuths_deg) {
  std::vector<int> shifts;
  shifts.reserve(azimuths_deg.size());
  for (const double azimuth_deg : azimuths_deg)
    shifts.push_back(static_cast<int>(std::lround(azimuth_deg * model.columns / 360.0)));
  const int smallest = std::ranges::min(shifts);
  for (int& shift : shifts) shift -= smallest;
  return shifts;
}

/// The SDK's name of the model: OS-1-64.
std::string product_line(const PacketSensor& sensor) {
  const std::string& name = sensor.model.name;
  const std::size_t beams = sensor.laser_of_ring.size();
  for (const char* kind : {"0", "1", "2"})
    if (name.find(std::string("os") + kind) != std::string::npos)
      return std::string("OS-") + kind + "-" + std::to_string(beams);
  return "OS-1-" + std::to_string(beams);
}

/// The first and the last column of the window in which the sensor fires.
std::array<std::uint32_t, 2> column_window(const LidarModel& model) {
  const auto column_at = [&](double share) {
    return static_cast<std::uint32_t>(std::lround(share * model.columns));
  };
  return {column_at(model.window_begin),
          (column_at(model.window_end) + model.columns - 1) % model.columns};
}

Error not_ouster(const LidarModel& model, const std::string& why) {
  return {ErrorKind::usage, "sensor '" + model.name + "': " + why};
}

/// The common origin of all beams; metadata hold only one.
Vec3d common_origin(const LidarModel& model) {
  const Vec3d origin = origin_of_beam(model, 0);
  for (std::size_t ring = 0; ring < model.elevations_rad.size(); ++ring)
    if (origin_of_beam(model, ring) != origin)
      throw not_ouster(model,
                       "its beams have different origins, which Ouster metadata cannot hold");
  if (origin.y != 0)
    throw not_ouster(model,
                     "the origin of its beams is off the axis (y is not 0), which Ouster "
                     "metadata cannot hold");
  return origin;
}

std::string ouster_json(const PacketSensor& sensor) {
  const LidarModel& model = sensor.model;
  const Vec3d origin = common_origin(model);
  std::vector<double> altitudes_deg, azimuths_deg;
  for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
    const std::size_t ring = sensor.ring_of_laser[laser];
    if (ring == kNoRing) {
      altitudes_deg.push_back(0);
      azimuths_deg.push_back(0);
      continue;
    }
    altitudes_deg.push_back(kDegreesPerRadian * model.elevations_rad[ring]);
    azimuths_deg.push_back(-kDegreesPerRadian * offset_of_beam(model, ring));
  }
  const double cos = std::cos(model.first_azimuth_rad), sin = std::sin(model.first_azimuth_rad);
  MetadataJson json;
  json["prod_line"] = product_line(sensor);
  json["prod_sn"] = "000000000000";
  json["prod_pn"] = "simulated";
  json["build_rev"] = "v2.0.0";
  json["image_rev"] = "simulated";
  json["hostname"] = "";
  json["status"] = "RUNNING";
  json["json_calibration_version"] = 4;
  json["lidar_mode"] =
      std::to_string(model.columns) + "x" + std::to_string(std::lround(model.rotation_hz));
  json["beam_altitude_angles"] = altitudes_deg;
  json["beam_azimuth_angles"] = azimuths_deg;
  json["lidar_origin_to_beam_origin_mm"] = kMillimetres * origin.x;
  json["lidar_to_sensor_transform"] = {cos, -sin, 0.0, 0.0, sin, cos,
                                       0.0, 0.0,  0.0, 0.0, 1.0, kMillimetres * origin.z,
                                       0.0, 0.0,  0.0, 1.0};
  json["imu_to_sensor_transform"] = {1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1};
  json["data_format"] = {{"pixels_per_column", sensor.lasers()},
                         {"columns_per_packet", sensor.facts.columns},
                         {"columns_per_frame", model.columns},
                         {"column_window", column_window(model)},
                         {"pixel_shift_by_row", pixel_shifts(model, azimuths_deg)},
                         {"udp_profile_lidar", "LEGACY"},
                         {"udp_profile_imu", "LEGACY"}};
  json["udp_port_lidar"] = sensor.facts.port;
  json["udp_port_imu"] = sensor.facts.port + 1;
  return json.dump(2) + "\n";
}

/// All lasers take 57.6 us in an S3, 48 us in an S2.
std::string hdl64_generation(const LidarModel& model) {
  constexpr double kLongestOfS2_s = 50e-6;
  const auto& times_s = model.firing_times_s;
  return !times_s.empty() && std::ranges::max(times_s) > kLongestOfS2_s ? "s3" : "s2";
}

/// Whether two sensors with packets have the same beams at the same times, within rounding.
bool has_same_beams(const LidarModel& one, const LidarModel& other) {
  constexpr double kAngle_rad = 1e-9, kTime_s = 1e-9;
  const auto are_near = [](const std::vector<double>& a, const std::vector<double>& b, double by) {
    return std::ranges::equal(a, b, [&](double x, double y) { return std::fabs(x - y) <= by; });
  };
  return one.packets->format == other.packets->format &&
         are_near(one.elevations_rad, other.elevations_rad, kAngle_rad) &&
         are_near(one.firing_times_s, other.firing_times_s, kTime_s);
}

/// The angle correction file. It has no firing times: readers use those of the model.
CalibrationFile hesai_csv(const PacketSensor& sensor) {
  const LidarModel& model = sensor.model;
  CalibrationFile file{"correction.csv", "Channel,Elevation,Azimuth\n"};
  for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
    const std::size_t ring = sensor.ring_of_laser[laser];
    const double azimuth_deg = -kDegreesPerRadian * offset_of_beam(model, ring);
    file.text += std::to_string(laser + 1) + "," +
                 exact_text(kDegreesPerRadian * model.elevations_rad[ring]) + "," +
                 exact_text(azimuth_deg == 0 ? 0 : azimuth_deg) + "\n";
  }
  const LidarModel found = finished_model(read_hesai_csv(file.text, file.name));
  if (!found.packets || !has_same_beams(packet_sensor(found).model, model))
    throw Error(ErrorKind::usage, "sensor '" + model.name +
                                      "': its beams or firing times are not those of a " +
                                      std::string(word_of(sensor.format, kPacketFormats)) +
                                      ", which readers of its packets assume");
  return file;
}

}  // namespace

CalibrationFile calibration_file(const PacketSensor& sensor) {
  if (is_hesai(sensor.format)) return hesai_csv(sensor);
  if (is_ouster(sensor.format)) return {"metadata.json", ouster_json(sensor)};
  // load_lidar_model() derives the firing times from this name.
  const std::string name = sensor.format == PacketFormat::hdl_64e
                               ? "calibration-" + hdl64_generation(sensor.model) + ".yaml"
                               : "calibration.yaml";
  return {name, velodyne_yaml(sensor)};
}

}  // namespace adasplats
