// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/scan_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "adasplats/core/error.h"

namespace adasplats {

std::string points_with_intensity(const ScanView& scan, std::span<const std::uint32_t> order) {
  using Record = std::array<float, 4>;
  const std::size_t count = scan.size();
  const Vec3f* const positions = scan.positions.data();
  const float* const intensities = scan.intensities.empty() ? nullptr : scan.intensities.data();
  std::string bytes(count * sizeof(Record), '\0');
  char* to = bytes.data();
  for (std::size_t i = 0; i < count; ++i, to += sizeof(Record)) {
    const std::size_t from = order.empty() ? i : order[i];
    const Vec3f p = positions[from];
    const float measured = intensities == nullptr ? 0.0F : intensities[from];
    // A NaN would break the training of networks on these files.
    const Record record = {p.x, p.y, p.z, std::isnan(measured) ? 0.0F : measured};
    std::memcpy(to, record.data(), sizeof(record));
  }
  return bytes;
}

std::vector<std::uint32_t> packed_labels(const ScanView& scan,
                                         std::span<const std::uint32_t> order) {
  const std::size_t count = scan.size();
  const bool has_instances = !scan.instances.empty(), has_classes = !scan.classes.empty();
  std::vector<std::uint32_t> labels(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = order.empty() ? i : order[i];
    const std::uint32_t instance = has_instances ? scan.instances[from] : 0;
    const std::uint32_t semantic_class = has_classes ? scan.classes[from] : 0;
    labels[i] = instance << 16 | semantic_class;
  }
  return labels;
}

std::vector<std::uint8_t> returns_of_firings(const ScanView& scan) {
  std::vector<std::uint8_t> counts(scan.size(), 1);
  if (scan.return_indices.empty()) return counts;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= counts.size(); ++end) {
    // Indices ascend within a firing.
    const bool same = end < counts.size() && scan.rings[end] == scan.rings[begin] &&
                      scan.columns[end] == scan.columns[begin] &&
                      scan.return_indices[end] > scan.return_indices[end - 1];
    if (same) continue;
    // If a return was dropped, the others keep their numbers.
    const int most = scan.return_indices[end - 1] + 1;
    for (std::size_t i = begin; i < end; ++i) counts[i] = static_cast<std::uint8_t>(most);
    begin = end;
  }
  return counts;
}

std::vector<float> times_from_pose(const ScanView& scan) {
  std::vector<float> times;
  if (!scan.moved()) return times;
  const double begin_s = scan.begin_s() - scan.time_s;
  times.reserve(scan.times_s.size());
  for (const float since_begin_s : scan.times_s)
    times.push_back(static_cast<float>(begin_s + static_cast<double>(since_begin_s)));
  return times;
}

std::vector<ColumnView> scan_columns(const ScanView& given, std::span<const float> times) {
  ScanView scan = given;
  scan.times_s = times;
  // An empty scan has no first point whose address could be used.
  const Vec3f* const first = scan.positions.data();
  std::vector<ColumnView> columns = {
      {"x", ColumnType::f32, first != nullptr ? &first->x : nullptr, sizeof(Vec3f)},
      {"y", ColumnType::f32, first != nullptr ? &first->y : nullptr, sizeof(Vec3f)},
      {"z", ColumnType::f32, first != nullptr ? &first->z : nullptr, sizeof(Vec3f)}};
  for_each_scan_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(scan);
    if (values.size() != scan.size() || (attribute.is_optional && values.empty())) return;
    if (!scan.moved() && attribute.column == std::string_view("time")) return;
    using Value = typename std::decay_t<decltype(values)>::value_type;
    columns.push_back({attribute.column, column_type<Value>(), values.data(), sizeof(Value)});
  });
  if (!scan.velocities.empty()) {
    const Vec3f& velocity = scan.velocities.front();
    columns.push_back({"vx", ColumnType::f32, &velocity.x, sizeof(Vec3f)});
    columns.push_back({"vy", ColumnType::f32, &velocity.y, sizeof(Vec3f)});
    columns.push_back({"vz", ColumnType::f32, &velocity.z, sizeof(Vec3f)});
  }
  return columns;
}

double intensity_scale_for(double highest) {
  for (const double scale : {1.0, 255.0})
    if (highest <= scale) return scale;
  return 65535.0;
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
