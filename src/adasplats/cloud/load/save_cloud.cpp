// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {

namespace {

using Names = std::array<std::string_view, 3>;
constexpr Names kPositionColumns = {"x", "y", "z"};
constexpr Names kSensorColumns = {"x_lidar_position", "y_lidar_position", "z_lidar_position"};

std::vector<Vec3d> in_world(Vec3d origin, const std::vector<Vec3f>& positions) {
  std::vector<Vec3d> world;
  world.reserve(positions.size());
  for (const Vec3f p : positions) world.push_back(origin + vec_cast<double>(p));
  return world;
}

template <class T>
void add_vectors(std::vector<ColumnView>& columns, const Names& names, ColumnType type,
                 const std::vector<Vec3<T>>& values) {
  if (values.empty()) return;
  columns.push_back({names[0], type, &values.front().x, sizeof(Vec3<T>)});
  columns.push_back({names[1], type, &values.front().y, sizeof(Vec3<T>)});
  columns.push_back({names[2], type, &values.front().z, sizeof(Vec3<T>)});
}

/// What LAS has fields of its own for.
struct LasStandardFields {
  std::vector<std::uint8_t> classes;
  std::vector<std::uint16_t> intensities;

  explicit LasStandardFields(const PointCloud& cloud) {
    constexpr std::uint16_t kMost = 255;
    for (const std::uint16_t id : cloud.classes)
      classes.push_back(id > kMost ? std::uint8_t{0} : static_cast<std::uint8_t>(id));
    const bool are_shares =
        std::ranges::none_of(cloud.intensities, [](float value) { return value > 1; });
    for (const float value : cloud.intensities) {
      const float scaled = are_shares ? 65535 * value : value;
      intensities.push_back(std::isnan(scaled) ? std::uint16_t{0}
                                               : static_cast<std::uint16_t>(std::lround(
                                                     std::clamp(scaled, 0.0F, 65535.0F))));
    }
  }
};

/// The attributes but for vectors, and what LAS's own intensity cannot hold under a name of its
/// own.
void add_attributes(std::vector<ColumnView>& columns, const PointCloud& cloud,
                    std::string_view intensity) {
  for_each_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(cloud);
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if constexpr (!std::is_same_v<Value, Vec3f>) {
      if (values.empty()) return;
      const std::string_view name = attribute.column;
      columns.push_back({name == "intensity" ? intensity : name, column_type<Value>(),
                         values.data(), sizeof(Value)});
    }
  });
}

}  // namespace

void save_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more) {
  std::vector<ColumnView> columns;
  std::vector<Vec3d> world_positions, world_sensors;
  if (cloud.empty()) {
    for (const std::string_view name : kPositionColumns)
      columns.push_back({name, ColumnType::f32, nullptr, sizeof(float)});
  } else if (cloud.origin == Vec3d{}) {
    add_vectors(columns, kPositionColumns, ColumnType::f32, cloud.positions);
    add_vectors(columns, kSensorColumns, ColumnType::f32, cloud.sensor_positions);
  } else {
    world_positions = in_world(cloud.origin, cloud.positions);
    world_sensors = in_world(cloud.origin, cloud.sensor_positions);
    add_vectors(columns, kPositionColumns, ColumnType::f64, world_positions);
    add_vectors(columns, kSensorColumns, ColumnType::f64, world_sensors);
  }
  add_attributes(columns, cloud, "intensity");
  columns.insert(columns.end(), more.begin(), more.end());
  write_ply(path, cloud.size(), columns, crs_comments(cloud.crs));
}

void save_cloud_las(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more) {
  const LasStandardFields fields(cloud);
  const std::vector<Vec3d> positions = in_world(cloud.origin, cloud.positions);
  const std::vector<Vec3d> sensors = in_world(cloud.origin, cloud.sensor_positions);
  std::vector<ColumnView> columns;
  for (const std::string_view name : kPositionColumns)
    if (cloud.empty()) columns.push_back({name, ColumnType::f64, nullptr, sizeof(double)});
  add_vectors(columns, kPositionColumns, ColumnType::f64, positions);
  if (!fields.classes.empty())
    columns.push_back({"classification", ColumnType::u8, fields.classes.data(), 1});
  if (!fields.intensities.empty())
    columns.push_back({"intensity", ColumnType::u16, fields.intensities.data(), 2});
  add_vectors(columns, kSensorColumns, ColumnType::f64, sensors);
  add_attributes(columns, cloud, "intensity_value");
  columns.insert(columns.end(), more.begin(), more.end());
  LasWriteOptions options;
  options.offset_m = cloud.origin;
  options.crs = cloud.crs;
  options.is_packed = is_laz_name(path);
  write_las(path, cloud.size(), columns, options);
}

}  // namespace adasplats
