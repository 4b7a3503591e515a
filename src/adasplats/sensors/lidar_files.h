// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

class TomlTable;

// Private to sensors/: the formats of load_lidar_model.

/// A sensor as its file describes it: beams in the file's order, including those that do not fire
/// in every column.
struct LidarFile {
  LidarModel model;
  /// Beam b fires in the columns column_phases[b] + k * column_steps[b]; one a beam, or empty if
  /// all beams fire in every column.
  std::vector<std::uint32_t> column_steps;
  std::vector<std::uint32_t> column_phases;

  bool has_beams() const { return !model.elevations_rad.empty(); }
  /// Removes the beams, or rosette, and everything that is given per beam.
  void clear_pattern();
};

/// The error text if beams fire after the end of their column: "leave 27 us a column, but...".
std::optional<std::string> column_fault(const LidarModel& model);

/// The error text if all elevations of a manufacturer's file are 0, or two beams have the same
/// ones. Both lists of angles have a value a beam, in the order of the file.
std::optional<std::string> angle_fault(const LidarModel& model);
/// The error text if angles from a file in degrees seem to be radians.
std::optional<std::string> degrees_fault(const LidarModel& model);

/// The model of a file: beams topmost first; beams that skip columns become a free pattern.
LidarModel finished_model(LidarFile file);

/// `nesting`: the number of files that led here through their key `like`.
LidarFile read_lidar(const std::string& name_or_path, int nesting);
/// Nothing if the library has no sensor of that name.
std::optional<LidarFile> read_library_lidar(std::string_view name);

/// `path` is used in messages and to find files that the text names.
LidarFile read_lidar_toml(std::string_view text, const std::filesystem::path& path, int nesting);
/// Rays, or Hesai's angle table, depending on the first line.
LidarFile read_lidar_csv(std::string_view text, const std::filesystem::path& path);
LidarFile read_hesai_csv(std::string_view text, const std::filesystem::path& path);
/// The binary angle correction of an AT128.
LidarFile read_hesai_dat(std::string_view text, const std::filesystem::path& path);
LidarFile read_ouster_json(std::string_view text, const std::filesystem::path& path);
/// "LEGACY, RNG15_RFL8_NIR8, ...": the supported profiles of an Ouster's packets.
std::string ouster_profiles();
LidarFile read_velodyne_yaml(std::string_view text, const std::filesystem::path& path);
LidarFile read_velodyne_xml(std::string_view text, const std::filesystem::path& path);

/// The ray drop model in the table under `key` of a sensor file. Errors: config with the line.
RayDropModel read_ray_drop_table(const TomlTable& parent, std::string_view key);

/// Rings are 16-bit numbers.
constexpr std::size_t kMaxBeams = 65536;
constexpr std::uint32_t kMaxColumns = 1U << 24;

/// Upper limit of ranges and of lengths within a sensor.
constexpr double kFar_m = 1e6;

/// Defaults for files without these numbers: 0.2 degrees a column at 10 Hz, clockwise.
LidarFile default_rotating_lidar();

double radians(double degrees);

/// `beams` equidistant elevations from top to bottom, both ends included.
std::vector<double> even_fan_rad(int beams, double top_deg, double bottom_deg);

/// Unit vector; azimuth counter-clockwise from +x, elevation up from the xy-plane. (With z up the
/// paper's R_y(eta) would rotate +x down.)
Vec3f direction_of(double azimuth_rad, double elevation_rad);

/// The ray of beam `ring` at the head's azimuth `head_rad`, counter-clockwise from +x; without
/// column and time.
Firing firing_at(const LidarModel& model, std::size_t ring, double head_rad);

/// The firing of beam `ring` in `column`.
Firing turned_firing(const LidarModel& model, std::size_t ring, std::uint32_t column);

// For models with a rosette.
std::size_t rosette_rays_per_scan(const LidarModel& model);
std::vector<Firing> rosette_firings(const LidarModel& model, std::uint64_t scan_index);

}  // namespace adasplats
