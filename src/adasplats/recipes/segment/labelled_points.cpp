// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/segment/labelled_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/las/las_writer.h"

namespace adasplats {
namespace {

/// Columns that a network gives, and their names.
struct FoundColumns {
  std::vector<std::string> names;
  std::vector<ColumnView> columns;

  explicit FoundColumns(const LabelledPoints& points) {
    if (!points.confidences.empty())
      columns.push_back({"confidence", ColumnType::f32, points.confidences.data(), sizeof(float)});
    if (points.probabilities.empty()) return;
    for (const std::uint16_t id : points.ids) names.push_back("probability_" + std::to_string(id));
    for (std::size_t c = 0; c < names.size(); ++c)
      columns.push_back({names[c], ColumnType::f32, points.probabilities.data() + c,
                         names.size() * sizeof(float)});
  }
};

/// What LAS has fields of its own for.
struct StandardFields {
  std::vector<std::uint8_t> classes;
  std::vector<std::uint16_t> intensities;

  explicit StandardFields(const PointCloud& cloud) {
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

void add_world(std::vector<ColumnView>& columns, const std::array<std::string_view, 3>& names,
               const std::vector<Vec3d>& values) {
  if (values.empty()) return;
  columns.push_back({names[0], ColumnType::f64, &values.front().x, sizeof(Vec3d)});
  columns.push_back({names[1], ColumnType::f64, &values.front().y, sizeof(Vec3d)});
  columns.push_back({names[2], ColumnType::f64, &values.front().z, sizeof(Vec3d)});
}

std::vector<Vec3d> world_of(const PointCloud& cloud, const std::vector<Vec3f>& positions) {
  std::vector<Vec3d> world;
  world.reserve(positions.size());
  for (const Vec3f p : positions) world.push_back(cloud.origin + vec_cast<double>(p));
  return world;
}

}  // namespace

void save_labelled_ply(const std::filesystem::path& file, const LabelledPoints& points) {
  save_cloud_ply(file, points.cloud, FoundColumns(points).columns);
}

void save_labelled_las(const std::filesystem::path& file, const LabelledPoints& points) {
  const PointCloud& cloud = points.cloud;
  const StandardFields fields(cloud);
  const std::vector<Vec3d> positions = world_of(cloud, cloud.positions);
  const std::vector<Vec3d> sensors = world_of(cloud, cloud.sensor_positions);
  std::vector<ColumnView> columns;
  add_world(columns, {"x", "y", "z"}, positions);
  columns.push_back({"classification", ColumnType::u8, fields.classes.data(), 1});
  if (!fields.intensities.empty())
    columns.push_back({"intensity", ColumnType::u16, fields.intensities.data(), 2});
  add_world(columns, {"x_lidar_position", "y_lidar_position", "z_lidar_position"}, sensors);
  for_each_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(cloud);
    using Value = typename std::decay_t<decltype(values)>::value_type;
    if constexpr (!std::is_same_v<Value, Vec3f>) {
      if (values.empty()) return;
      const std::string_view name = attribute.column;
      columns.push_back({name == "intensity" ? "intensity_value" : name, column_type<Value>(),
                         values.data(), sizeof(Value)});
    }
  });
  const FoundColumns found(points);
  columns.insert(columns.end(), found.columns.begin(), found.columns.end());
  LasWriteOptions options;
  options.offset_m = cloud.origin;
  options.crs = cloud.crs;
  options.is_packed = is_laz_name(file);
  write_las(file, cloud.size(), columns, options);
}

void save_labels(const std::filesystem::path& path, std::span<const std::uint32_t> labels) {
  AtomicFile file(path);
  file.write(labels.data(), labels.size_bytes());
  file.commit();
}

void save_floats(const std::filesystem::path& path, std::span<const float> values) {
  AtomicFile file(path);
  file.write(values.data(), values.size_bytes());
  file.commit();
}

}  // namespace adasplats
