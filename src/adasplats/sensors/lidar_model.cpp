// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>

#include "adasplats/core/error.h"
#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

void check(const LidarModel& model) {
  const auto& offsets = model.azimuth_offsets_rad;
  if (!offsets.empty() && offsets.size() != model.elevations_rad.size())
    throw std::logic_error("a LiDAR model needs one azimuth offset a beam, or none");
  if (!(model.rotation_hz > 0)) throw std::logic_error("a LiDAR model needs rotation_hz > 0");
}

}  // namespace

std::vector<double> even_fan_rad(int beams, double top_deg, double bottom_deg) {
  std::vector<double> elevations_rad;
  for (int i = 0; i < beams; ++i) {
    const double share = beams == 1 ? 0.0 : static_cast<double>(i) / (beams - 1);
    elevations_rad.push_back(radians(top_deg + share * (bottom_deg - top_deg)));
  }
  return elevations_rad;
}

Vec3f direction_of(double azimuth_rad, double elevation_rad) {
  const double flat = std::cos(elevation_rad);
  return vec_cast<float>(
      Vec3d{flat * std::cos(azimuth_rad), flat * std::sin(azimuth_rad), std::sin(elevation_rad)});
}

double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

std::size_t LidarModel::rays_per_scan() const {
  return free_pattern.empty() ? elevations_rad.size() * columns : free_pattern.size();
}

std::size_t LidarModel::rings() const {
  std::size_t count = free_pattern.empty() ? elevations_rad.size() : 0;
  for (const Firing& firing : free_pattern)
    count = std::max(count, static_cast<std::size_t>(firing.ring) + 1);
  return count;
}

std::vector<Firing> firings_of(const LidarModel& model) {
  if (!model.free_pattern.empty()) return model.free_pattern;
  check(model);
  std::vector<Firing> firings;
  firings.reserve(model.rays_per_scan());
  const double turn = model.clockwise ? -1.0 : 1.0;
  for (std::size_t ring = 0; ring < model.elevations_rad.size(); ++ring) {
    const double offset_rad =
        model.azimuth_offsets_rad.empty() ? 0.0 : model.azimuth_offsets_rad[ring];
    for (std::uint32_t column = 0; column < model.columns; ++column) {
      const double share = static_cast<double>(column) / model.columns;
      const double azimuth_rad = turn * share * (2.0 * std::numbers::pi) + offset_rad;
      firings.push_back({direction_of(azimuth_rad, model.elevations_rad[ring]),
                         static_cast<std::uint16_t>(ring), column,
                         static_cast<float>(share / model.rotation_hz)});
    }
  }
  return firings;
}

LidarModel hdl_64_paper() {
  LidarModel model;
  model.name = "hdl-64-paper";
  // The paper prints 0.419 degrees = 26.8 / 64; with both ends it is 26.8 / 63 = 0.4254.
  model.elevations_rad = even_fan_rad(64, 2.0, -24.8);
  model.columns = 2250;  // 0.16 degrees
  model.max_range_m = 120.0;
  return model;
}

LidarModel hdl_32_paper() {
  LidarModel model;
  model.name = "hdl-32-paper";
  model.elevations_rad = even_fan_rad(32, 10.67, -30.67);
  model.columns = 1800;  // 0.2 degrees
  model.max_range_m = 100.0;
  return model;
}

std::vector<std::string> lidar_model_names() { return {"hdl-64-paper", "hdl-32-paper"}; }

LidarModel load_lidar_model(const std::string& name_or_path) {
  if (name_or_path == "hdl-64-paper") return hdl_64_paper();
  if (name_or_path == "hdl-32-paper") return hdl_32_paper();
  const std::filesystem::path path(name_or_path);
  if (path.extension() == ".toml") return read_lidar_toml(path);
  if (path.extension() == ".csv") return read_lidar_csv(path);
  const auto nearest = nearest_word(name_or_path, lidar_model_names());
  std::string known;
  for (const std::string& name : lidar_model_names()) known += name + ", ";
  throw Error(ErrorKind::usage,
              "unknown sensor '" + name_or_path + "'" +
                  (nearest ? ", did you mean '" + *nearest + "'?"
                           : ": expected " + known + "a .toml file or a .csv file of rays"));
}

}  // namespace adasplats
