// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Private to sensors/: LiDAR models in files, formats as load_lidar_model says.

/// What a file says of a sensor: beams in the file's order, and those that do not fire in every
/// column.
struct LidarFile {
  LidarModel model;
  /// Beam b fires in the columns column_phases[b] + k * column_steps[b]; one a beam, or empty for
  /// every column.
  std::vector<std::uint32_t> column_steps;
  std::vector<std::uint32_t> column_phases;

  bool has_beams() const { return !model.elevations_rad.empty(); }
  /// Forgets the pattern but none of the rest.
  void clear_pattern();
};

/// What is wrong where beams fire behind the end of their column; "leave 27 us a column, but...".
std::optional<std::string> column_fault(const LidarModel& model);

/// The model of a file: beams topmost first, those that skip columns as a free pattern.
LidarModel finished_model(LidarFile file);

/// `nesting`: how many files led here by their key `like`.
LidarFile read_lidar(const std::string& name_or_path, int nesting);
/// Of the library; nothing where it has none of that name.
std::optional<LidarFile> read_library_lidar(std::string_view name);

/// `path` is for messages and for files named in the text.
LidarFile read_lidar_toml(std::string_view text, const std::filesystem::path& path, int nesting);
/// Rays, or Hesai's angle table, as the first line says.
LidarFile read_lidar_csv(std::string_view text, const std::filesystem::path& path);
LidarFile read_hesai_csv(std::string_view text, const std::filesystem::path& path);
LidarFile read_ouster_json(std::string_view text, const std::filesystem::path& path);
LidarFile read_velodyne_yaml(std::string_view text, const std::filesystem::path& path);
LidarFile read_velodyne_xml(std::string_view text, const std::filesystem::path& path);

/// A ring is a number of 16 bits.
constexpr std::size_t kMaxBeams = 65536;
constexpr std::uint32_t kMaxColumns = 1U << 24;

/// Lengths of a sensor, and ranges, are below this, which a float holds as well.
constexpr double kFar_m = 1e6;

/// What a file without these numbers has: 0.2 degrees a column at 10 Hz, clockwise.
LidarFile unknown_turning_lidar();

double radians(double degrees);

/// `beams` elevations from top to bottom at equal distances, both ends included.
std::vector<double> even_fan_rad(int beams, double top_deg, double bottom_deg);

/// Unit vector; azimuth counter-clockwise from +x, elevation up from the xy-plane. (The paper's
/// R_y(eta) with z up would turn +x down.)
Vec3f direction_of(double azimuth_rad, double elevation_rad);

/// The ray of beam `ring` of a sensor whose head has turned to `head_rad`, counter-clockwise from
/// +x; without column and time.
Firing firing_at(const LidarModel& model, std::size_t ring, double head_rad);

/// Firing `column` of beam `ring` of a sensor whose head turns.
Firing turned_firing(const LidarModel& model, std::size_t ring, std::uint32_t column);

/// Of a model with a rosette.
std::size_t rosette_rays_per_scan(const LidarModel& model);
std::vector<Firing> rosette_firings(const LidarModel& model, std::uint64_t scan_index);

}  // namespace adasplats
