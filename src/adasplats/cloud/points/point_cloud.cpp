// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace adasplats {

namespace {

template <class T>
std::vector<T> gathered(const std::vector<T>& values, std::span<const std::uint32_t> indices) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const std::uint32_t i : indices) result.push_back(values[i]);
  return result;
}

template <class T>
void append_values(std::vector<T>& values, std::vector<T>&& more) {
  if (values.empty()) {
    values = std::move(more);
  } else {
    values.insert(values.end(), more.begin(), more.end());
    std::vector<T>().swap(more);
  }
}

/// Whether two columns have one name and type.
bool is_alike(const Column& a, const Column& b) {
  return a.name == b.name && a.values.index() == b.values.index();
}

bool same_attributes(const PointCloud& a, const PointCloud& b) {
  bool same = true;
  for_each_attribute([&](const auto& attribute) {
    same = same && attribute.of(a).empty() == attribute.of(b).empty();
  });
  return same && std::ranges::equal(a.others.columns, b.others.columns, is_alike);
}

double choose_origin_along_axis(double low, double high) {
  // At 1024 m the next float is 0.12 mm away, so rounding errs by at most 0.06 mm.
  constexpr double kFloatRangeM = 1000.0;
  if (!(low <= high)) return 0.0;
  if (-kFloatRangeM <= low && high <= kFloatRangeM) return 0.0;
  const double middle = low / 2 + high / 2;  // low + high may overflow
  return std::round(middle / 1000.0) * 1000.0;
}

}  // namespace

bool PointCloud::has_beams() const {
  if (sensor_positions.empty()) return false;
  return origin_kinds.empty() || std::ranges::any_of(origin_kinds, is_beam);
}

bool PointCloud::has_all_origins() const {
  return !sensor_positions.empty() && std::ranges::all_of(origin_kinds, is_known);
}

OriginCounts count_origins(const PointCloud& cloud) {
  OriginCounts counts{};
  if (cloud.origin_kinds.empty()) {
    counts[static_cast<std::size_t>(
        cloud.sensor_positions.empty() ? OriginKind::none : OriginKind::measured)] = cloud.size();
  }
  for (const OriginKind kind : cloud.origin_kinds) ++counts[static_cast<std::size_t>(kind)];
  return counts;
}

std::string describe_origins(const OriginCounts& counts) {
  constexpr std::array<std::string_view, 4> kWords = {"not known", "guessed", "stated", "measured"};
  const auto kinds = std::ranges::count_if(counts, [](std::size_t count) { return count != 0; });
  if (kinds == 0 || (kinds == 1 && counts[0] != 0)) return "no";
  std::string text;
  for (std::size_t kind = counts.size(); kind-- > 0;) {
    if (counts[kind] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(kWords[kind]);
    if (kinds > 1) text += " " + std::to_string(counts[kind]);
  }
  return text;
}

std::vector<ColorBytes> color_bytes(std::span<const Column> columns, std::size_t rows) {
  std::array<const Column*, 3> channels{};
  double most = 0;
  bool are_whole = true;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const auto found = std::ranges::find(columns, std::string_view(kRgbColumns[k]), &Column::name);
    if (found == columns.end() || found->size() != rows) return {};
    channels[k] = &*found;
    for (std::size_t i = 0; i < rows; ++i) {
      const double value = found->as_double(i);
      if (!std::isfinite(value)) continue;
      most = std::max(most, value);
      are_whole = are_whole && std::trunc(value) == value;
    }
  }
  constexpr double kMost = 255, kOfByte = 256;
  const double scale = most > kMost ? 1 / kOfByte : most <= 1 && !are_whole ? kMost : 1;
  std::vector<ColorBytes> colors(rows);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const double value = scale * channels[k]->as_double(i);
      colors[i][k] =
          value > 0 ? static_cast<std::uint8_t>(std::min(value, kMost)) : std::uint8_t{0};
    }
  return colors;
}

PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  PointCloud result;
  result.origin = cloud.origin;
  result.crs = cloud.crs;
  result.label_scheme = cloud.label_scheme;
  result.scan_poses = cloud.scan_poses;
  result.sensors = cloud.sensors;
  result.empty_beams = cloud.empty_beams;
  result.positions = gathered(cloud.positions, indices);
  for_each_attribute([&](const auto& attribute) {
    attribute.of(result) = gathered(attribute.of(cloud), indices);
  });
  result.others.has_adjusted_times = cloud.others.has_adjusted_times;
  for (const Column& column : cloud.others.columns)
    result.others.columns.push_back(std::visit(
        [&](const auto& values) {
          return Column{column.name, gathered(values, indices)};
        },
        column.values));
  return result;
}

void keep_sensors_of_model(PointCloud& cloud) {
  if (std::ranges::all_of(cloud.sensors, &CloudSensor::is_in_model)) return;
  std::vector<bool> is_kept;  // scan by scan
  for (const CloudSensor& sensor : cloud.sensors)
    is_kept.insert(is_kept.end(), sensor.scans, sensor.is_in_model);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_kept[cloud.scan_indices[i]]) kept.push_back(static_cast<std::uint32_t>(i));
  std::erase_if(cloud.empty_beams, [&](const EmptyBeam& beam) { return !is_kept[beam.scan]; });
  cloud = gather(cloud, kept);
}

void append(PointCloud& cloud, PointCloud&& other) {
  if (cloud.empty()) {
    cloud = std::move(other);
    return;
  }
  if (other.empty()) return;
  if (!(cloud.origin == other.origin)) throw std::logic_error("append: clouds of two origins");
  if (!same_attributes(cloud, other))
    throw std::logic_error("append: clouds of two attribute sets");
  if (cloud.scan_poses.empty() || other.scan_poses.empty())
    cloud.scan_poses = {};
  else
    append_values(cloud.scan_poses, std::move(other.scan_poses));
  append_values(cloud.empty_beams, std::move(other.empty_beams));
  append_values(cloud.positions, std::move(other.positions));
  for_each_attribute([&](const auto& attribute) {
    append_values(attribute.of(cloud), std::move(attribute.of(other)));
  });
  for (std::size_t k = 0; k < cloud.others.columns.size(); ++k)
    std::visit(
        [&](auto& values) {
          using Values = std::decay_t<decltype(values)>;
          append_values(values, std::move(std::get<Values>(other.others.columns[k].values)));
        },
        cloud.others.columns[k].values);
}

Vec3d choose_origin(Vec3d low, Vec3d high) {
  return {choose_origin_along_axis(low.x, high.x), choose_origin_along_axis(low.y, high.y),
          choose_origin_along_axis(low.z, high.z)};
}

}  // namespace adasplats
