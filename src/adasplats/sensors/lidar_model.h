// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/core/vec3.h"

namespace adasplats {

/// One emitted ray of one revolution, in the sensor frame.
struct Firing {
  Vec3f direction;       ///< unit length
  std::uint16_t ring;    ///< beam number, 0 = topmost
  std::uint32_t column;  ///< azimuth step
  float time_s;          ///< since the start of the revolution
};

/// A rotating LiDAR: which rays one revolution holds. Never sees a scene.
/// Azimuth counter-clockwise from +x, elevation up from the xy-plane.
struct LidarModel {
  std::string name;
  std::vector<double> elevations_rad;       ///< one a beam, topmost first
  std::vector<double> azimuth_offsets_rad;  ///< one a beam, or empty for zero
  std::uint32_t columns = 0;                ///< azimuth steps a revolution
  double rotation_hz = 10.0;
  double min_range_m = 0.0;
  double max_range_m = 120.0;
  double range_noise_m = 0.0;        ///< standard deviation of white noise on the range
  bool clockwise = false;            ///< seen from above
  std::vector<Firing> free_pattern;  ///< used instead of beams x columns where not empty

  std::size_t rays_per_scan() const;
  std::size_t rings() const;
};

/// The rays of one revolution ring by ring (neighbours in azimuth side by side: a laser row), or
/// the free pattern as it stands. Paper section "Firing Sequence Rays Generation".
std::vector<Firing> firings_of(const LidarModel& model);

/// Velodyne HDL-64 as in paper section "Velodyne HDL-64": 64 beams from +2.0 to -24.8 degrees, both
/// included, 2250 columns, 120 m.
LidarModel hdl_64_paper();
/// Velodyne HDL-32 as in paper section "Velodyne HDL-32": 32 beams from +10.67 to -30.67 degrees,
/// both included, 1800 columns, 100 m.
LidarModel hdl_32_paper();

/// "hdl-64-paper", "hdl-32-paper", a TOML file (keys: name, elevations_deg or beams +
/// elevation_top_deg + elevation_bottom_deg, azimuth_offsets_deg, columns, rotation_hz,
/// min_range_m, max_range_m, range_noise_m, clockwise), or a CSV of rays (azimuth_deg,
/// elevation_deg[, time_s[, ring]]).
/// Errors: usage (unknown name, with the nearest known), config (unknown key, with line), data (a
/// pattern with no rays).
LidarModel load_lidar_model(const std::string& name_or_path);

/// Names that load_lidar_model knows.
std::vector<std::string> lidar_model_names();

}  // namespace adasplats
