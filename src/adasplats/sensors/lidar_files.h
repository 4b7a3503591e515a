// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Private to sensors/: LiDAR models in files, formats as load_lidar_model says.

LidarModel read_lidar_toml(const std::filesystem::path& path);
LidarModel read_lidar_csv(const std::filesystem::path& path);

double radians(double degrees);

/// `beams` elevations from top to bottom at equal distances, both ends included.
std::vector<double> even_fan_rad(int beams, double top_deg, double bottom_deg);

/// Unit vector; azimuth counter-clockwise from +x, elevation up from the xy-plane. (The paper's
/// R_y(eta) with z up would turn +x down.)
Vec3f direction_of(double azimuth_rad, double elevation_rad);

}  // namespace adasplats
