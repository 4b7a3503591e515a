// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_values.h"

#include <algorithm>
#include <cmath>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

template <class T>
void add_column(std::vector<ColumnView>& columns, std::string_view name, ColumnType type,
                const std::vector<T>& values, std::size_t points) {
  if (values.size() == points) columns.push_back({name, type, values.data(), sizeof(T)});
}

/// The same for attributes that not every scan has: an empty scan has none of them.
template <class T>
void add_optional(std::vector<ColumnView>& columns, std::string_view name, ColumnType type,
                  const std::vector<T>& values, std::size_t points) {
  if (!values.empty()) add_column(columns, name, type, values, points);
}

}  // namespace

std::vector<float> points_with_intensity(const Scan& scan) {
  std::vector<float> values;
  values.reserve(4 * scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3f p = scan.positions[i];
    // Networks that are trained on such files do not survive a NaN.
    const float intensity =
        scan.intensities.empty() || std::isnan(scan.intensities[i]) ? 0.0F : scan.intensities[i];
    values.insert(values.end(), {p.x, p.y, p.z, intensity});
  }
  return values;
}

std::vector<std::uint32_t> packed_labels(const Scan& scan) {
  std::vector<std::uint32_t> labels(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::uint32_t instance = scan.instances.empty() ? 0 : scan.instances[i];
    const std::uint32_t semantic_class = scan.classes.empty() ? 0 : scan.classes[i];
    labels[i] = instance << 16 | semantic_class;
  }
  return labels;
}

std::vector<std::uint8_t> returns_of_firings(const Scan& scan) {
  std::vector<std::uint8_t> counts(scan.size(), 1);
  if (scan.return_indices.empty()) return counts;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= scan.size(); ++end) {
    // Indices ascend within a firing.
    const bool same = end < scan.size() && scan.rings[end] == scan.rings[begin] &&
                      scan.columns[end] == scan.columns[begin] &&
                      scan.return_indices[end] > scan.return_indices[end - 1];
    if (same) continue;
    // Where a return was dropped the others keep their numbers.
    const int most = scan.return_indices[end - 1] + 1;
    for (std::size_t i = begin; i < end; ++i) counts[i] = static_cast<std::uint8_t>(most);
    begin = end;
  }
  return counts;
}

std::vector<ColumnView> scan_columns(const Scan& scan) {
  const std::size_t points = scan.size();
  // An empty scan has no first point to take addresses from.
  const Vec3f* const first = scan.positions.data();
  std::vector<ColumnView> columns = {
      {"x", ColumnType::f32, first != nullptr ? &first->x : nullptr, sizeof(Vec3f)},
      {"y", ColumnType::f32, first != nullptr ? &first->y : nullptr, sizeof(Vec3f)},
      {"z", ColumnType::f32, first != nullptr ? &first->z : nullptr, sizeof(Vec3f)}};
  add_optional(columns, "intensity", ColumnType::f32, scan.intensities, points);
  add_optional(columns, "label", ColumnType::u16, scan.classes, points);
  add_optional(columns, "instance", ColumnType::u16, scan.instances, points);
  add_column(columns, "ring", ColumnType::u16, scan.rings, points);
  add_column(columns, "column", ColumnType::u32, scan.columns, points);
  add_column(columns, "time", ColumnType::f32, scan.times_s, points);
  add_column(columns, "range", ColumnType::f32, scan.ranges_m, points);
  add_optional(columns, "return_index", ColumnType::u8, scan.return_indices, points);
  return columns;
}

std::string scan_name(std::size_t index) {
  const std::string digits = std::to_string(index);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

void create_folder(const std::filesystem::path& folder) {
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem)
    throw system_error(ErrorKind::cannot_create, folder, "cannot be created", problem.value());
}

}  // namespace adasplats
