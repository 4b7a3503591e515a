// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Patterns of two rotating wedge prisms (Risley prisms), as in Livox sensors.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

/// The direction at an angle to the axis, +x: the vector (y, z) gives the size of the angle and its
/// side.
Vec3f off_axis(double angle_y_rad, double angle_z_rad) {
  const double angle_rad = std::hypot(angle_y_rad, angle_z_rad);
  const double side = angle_rad > 0 ? std::sin(angle_rad) / angle_rad : 1.0;
  return vec_cast<float>(Vec3d{std::cos(angle_rad), side * angle_y_rad, side * angle_z_rad});
}

}  // namespace

std::size_t rosette_rays_per_scan(const LidarModel& model) {
  if (!(model.rotation_hz > 0) || !(model.rosette->points_per_s >= 0))
    throw std::logic_error("a rosette needs rotation_hz > 0 and points_per_s >= 0");
  return static_cast<std::size_t>(std::llround(model.rosette->points_per_s / model.rotation_hz));
}

/// Thin prisms: each deflects the ray towards its own azimuth, and the two deflections add as
/// vectors (Liu, Wang, Zhang 2021, "Low-cost Retina-like Robotic Lidars Based on Incommensurable
/// Scanning"). All lasers fire in turn.
std::vector<Firing> rosette_firings(const LidarModel& model, std::uint64_t scan_index) {
  const RosettePattern& rosette = *model.rosette;
  const std::size_t count = rosette_rays_per_scan(model);
  const std::size_t lasers = model.rings();
  std::vector<Firing> firings;
  firings.reserve(count);
  const double first = static_cast<double>(scan_index) * static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double time_s = (first + static_cast<double>(i)) / rosette.points_per_s;
    const std::size_t laser = i % lasers;
    double y_rad = 0;
    double z_rad = rosette.laser_tilts_rad.empty() ? 0.0 : rosette.laser_tilts_rad[laser];
    for (int prism = 0; prism < 2; ++prism) {
      const double turns = rosette.prism_hz[prism] * time_s;
      const double angle_rad = (turns - std::floor(turns)) * (2.0 * std::numbers::pi);
      y_rad += rosette.deflection_rad[prism] * std::cos(angle_rad);
      z_rad += rosette.deflection_rad[prism] * std::sin(angle_rad);
    }
    firings.push_back({off_axis(y_rad, z_rad),
                       static_cast<std::uint16_t>(laser),
                       static_cast<std::uint32_t>(i / lasers),
                       static_cast<float>(static_cast<double>(i) / rosette.points_per_s),
                       {}});
  }
  return firings;
}

}  // namespace adasplats
