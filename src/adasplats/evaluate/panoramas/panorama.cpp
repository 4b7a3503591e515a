// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/panoramas/panorama.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace adasplats {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

double elevation_of(const PanoramaLayout& layout, std::uint32_t row) {
  return layout.top_rad - layout.span_rad * row / layout.rows;
}

/// The pixel nearest in direction. Halves are rounded to even, as by Python's round().
std::optional<std::size_t> pixel_of(const PanoramaLayout& layout, Vec3d point) {
  const double elevation_rad = std::atan2(point.z, std::hypot(point.x, point.y));
  const double clockwise_rad = std::numbers::pi - std::atan2(point.y, point.x);
  const double row =
      std::nearbyint((layout.top_rad - elevation_rad) / (layout.span_rad / layout.rows));
  const double column = std::nearbyint(clockwise_rad / (kTurn_rad / layout.columns));
  if (!(row >= 0 && row < layout.rows && column >= 0 && column < layout.columns)) return {};
  return static_cast<std::size_t>(row) * layout.columns + static_cast<std::size_t>(column);
}

}  // namespace

Panorama panorama_of(std::span<const Vec3f> points, std::span<const float> intensities,
                     const PanoramaLayout& layout) {
  Panorama image{std::vector<float>(layout.pixels()), std::vector<float>(layout.pixels())};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d point = vec_cast<double>(points[i]);
    const double range_m = length(point);
    if (!(range_m > 0 && range_m < layout.max_range_m)) continue;
    const std::optional<std::size_t> pixel = pixel_of(layout, point);
    if (!pixel) continue;
    float& nearest_m = image.ranges_m[*pixel];
    if (nearest_m > 0 && static_cast<double>(nearest_m) <= range_m) continue;
    nearest_m = static_cast<float>(range_m);
    image.intensities[*pixel] = i < intensities.size() ? intensities[i] : 0.0F;
  }
  return image;
}

std::vector<Vec3f> points_of(const Panorama& image, const PanoramaLayout& layout) {
  std::vector<Vec3f> points;
  for (std::uint32_t row = 0; row < layout.rows; ++row) {
    const double elevation_rad = elevation_of(layout, row);
    for (std::uint32_t column = 0; column < layout.columns; ++column) {
      const double range_m =
          static_cast<double>(image.ranges_m[std::size_t{row} * layout.columns + column]);
      if (!(range_m > 0)) continue;
      const double azimuth_rad = std::numbers::pi - kTurn_rad * column / layout.columns;
      points.push_back(
          vec_cast<float>(range_m * Vec3d{std::cos(elevation_rad) * std::cos(azimuth_rad),
                                          std::cos(elevation_rad) * std::sin(azimuth_rad),
                                          std::sin(elevation_rad)}));
    }
  }
  return points;
}

LidarModel sensor_of(const PanoramaLayout& layout) {
  LidarModel sensor;
  sensor.name = "range image";
  for (std::uint32_t row = 0; row < layout.rows; ++row)
    sensor.elevations_rad.push_back(elevation_of(layout, row));
  sensor.columns = layout.columns;
  sensor.first_azimuth_rad = std::numbers::pi;
  sensor.clockwise = true;
  sensor.min_range_m = 0;
  sensor.max_range_m = layout.max_range_m;
  return sensor;
}

}  // namespace adasplats
