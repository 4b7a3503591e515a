// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <type_traits>

#include "adasplats/cloud/load/load_cloud.h"
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
  for_each_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(cloud);
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if constexpr (!std::is_same_v<Value, Vec3f>) {
      if (values.empty()) return;
      columns.push_back({attribute.column, column_type<Value>(), values.data(), sizeof(Value)});
    }
  });
  columns.insert(columns.end(), more.begin(), more.end());
  write_ply(path, cloud.size(), columns, crs_comments(cloud.crs));
}

}  // namespace adasplats
