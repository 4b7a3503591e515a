// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

constexpr std::size_t kKittiFloats = 4;
constexpr std::size_t kNuScenesFloats = 5;
// Sensors and file formats scale intensities to 1, 8 bits or 16 bits.
constexpr float kMaxIntensity = 65535;
// No sensor has more beams; rings are integers below it.
constexpr float kMaxRings = 256;

Table read_floats(InputFile& file, std::initializer_list<const char*> names) {
  std::vector<RecordField> fields;
  for (const char* name : names)
    fields.push_back({name, ColumnType::f32, fields.size() * sizeof(float)});
  const std::size_t record_bytes = names.size() * sizeof(float);
  Table table;
  table.rows = static_cast<std::size_t>(file.size_bytes() / record_bytes);
  table.columns = read_records(file, table.rows, record_bytes, fields, false);
  return table;
}

const std::vector<float>& floats(const Table& table, std::size_t column) {
  return std::get<std::vector<float>>(table.columns[column].values);
}

/// All floats of a table, in file order.
std::vector<float> flat(const Table& table) {
  std::vector<float> values;
  values.reserve(table.columns.size() * table.rows);
  for (std::size_t row = 0; row < table.rows; ++row)
    for (std::size_t column = 0; column < table.columns.size(); ++column)
      values.push_back(floats(table, column)[row]);
  return values;
}

/// Intensities that are not finite are unknown.
bool can_be_intensity(float value) {
  return !std::isfinite(value) || (value >= 0 && value <= kMaxIntensity);
}

/// Whether of every five floats the fourth can be an intensity and the fifth a ring.
bool has_rings(const Table& table) {
  const std::vector<float> values = flat(table);
  for (std::size_t i = 0; i + kNuScenesFloats <= values.size(); i += kNuScenesFloats) {
    const float intensity = values[i + 3];
    const float ring = values[i + 4];
    if (!can_be_intensity(intensity)) return false;
    if (!(ring >= 0 && ring < kMaxRings) || ring != std::trunc(ring)) return false;
  }
  return true;
}

/// Whether the file has five floats a point: every fifth is a ring, and no coordinate of the points
/// read as four floats is an integer throughout.
bool looks_like_five(const Table& four) {
  if (four.rows % kNuScenesFloats != 0 || four.rows == 0) return false;
  const auto is_whole = [](float value) { return value == std::trunc(value); };
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::ranges::all_of(floats(four, axis), is_whole)) return false;
  return has_rings(four);
}

/// Mean difference of floats `width` apart, among the first of a file; values that are not finite
/// or implausible count as a fixed difference.
double mean_step(std::span<const float> values, std::size_t width) {
  constexpr double kLargest = 1e4;
  double sum = 0;
  for (std::size_t i = width; i < values.size(); ++i) {
    const double step =
        std::fabs(static_cast<double>(values[i]) - static_cast<double>(values[i - width]));
    sum += step < kLargest ? step : kLargest;
  }
  return sum / static_cast<double>(values.size() - width);
}

/// The 5th to 95th percentile of every `width`-th float, from `first` on; NaN if none is finite.
double spread_of(std::span<const float> values, std::size_t width, std::size_t first) {
  std::vector<float> column;
  for (std::size_t i = first; i < values.size(); i += width)
    if (std::isfinite(values[i])) column.push_back(values[i]);
  if (column.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(column);
  const std::size_t margin = column.size() / 20;
  return static_cast<double>(column[column.size() - 1 - margin]) -
         static_cast<double>(column[margin]);
}

/// Whether two points of `width` floats read as one have other spreads in their second half: then
/// it is no second point. Alternating lasers alone do not change the spreads of x and y so much.
bool differ_in_halves(std::span<const float> values, std::size_t width) {
  constexpr double kClear = 4;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double first = spread_of(values, 2 * width, axis);
    const double second = spread_of(values, 2 * width, axis + width);
    if (std::isnan(first) || std::isnan(second)) return false;
    if (first > kClear * second || second > kClear * first) return true;
  }
  return false;
}

/// The number of floats a point, from 3 to 8, if it is clearly not `width`: values of one column
/// resemble each other, so they repeat best at the true width. That holds for points in any order.
std::optional<std::size_t> other_width(InputFile& file, std::size_t width) {
  constexpr std::size_t kMinFloats = 240, kMaxFloats = 1 << 16, kMaxWidth = 8;
  constexpr double kClear = 0.7;
  const std::uint64_t count = file.size_bytes() / sizeof(float);
  if (count < kMinFloats || file.size_bytes() % sizeof(float) != 0) return std::nullopt;
  std::vector<float> values(static_cast<std::size_t>(std::min<std::uint64_t>(count, kMaxFloats)));
  std::memcpy(values.data(), file.peek(values.size() * sizeof(float)).data(),
              values.size() * sizeof(float));
  std::size_t best = width;
  double least = kClear * mean_step(values, width);
  for (std::size_t other = 3; other <= kMaxWidth; ++other) {
    if (other == width || count % other != 0) continue;
    if (other == 2 * width && !differ_in_halves(values, width)) continue;
    const double step = mean_step(values, other);
    if (step >= least) continue;
    least = step;
    best = other;
  }
  if (best == width) return std::nullopt;
  return best;
}

constexpr const char* kFiveFloats =
    "has 5 floats a point (x, y, z, intensity, ring), as in nuScenes";

// Advice for five floats: a single file can be read by its name, one of a sequence cannot.
constexpr const char* kNameIt = "; rename it to *.pcd.bin to read it so";
constexpr const char* kConvertIt =
    "; a sequence needs 4 (float32 x, y, z, intensity): remove the ring";

/// Whether the bytes can be points of NCLT: three uint16, an intensity and a laser below 32.
bool looks_like_nclt(const Table& table) {
  constexpr std::uint32_t kLasers = 32;
  return std::ranges::all_of(std::array<std::size_t, 2>{1, 3}, [&](std::size_t column) {
    return std::ranges::all_of(floats(table, column), [](float value) {
      return std::bit_cast<std::uint32_t>(value) >> 24 < kLasers;
    });
  });
}

/// Rejects a file where more than half of the points have a coordinate that no scan has: beyond
/// 1000 km, or below an atom's size but not 0.
void require_coordinates(const std::filesystem::path& path, const Table& table) {
  constexpr float kMin_m = 1e-10F, kMax_m = 1e6F;
  std::size_t wrong = 0;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const auto is_wrong = [&](std::size_t axis) {
      const float size = std::fabs(floats(table, axis)[row]);
      return size > kMax_m || (size > 0 && size < kMin_m);
    };
    if (is_wrong(0) || is_wrong(1) || is_wrong(2)) ++wrong;
  }
  if (wrong <= table.rows / 2) return;
  throw data_error(
      {path, {}, {}},
      "not a KITTI scan (float32 x, y, z, intensity): coordinates of " + std::to_string(wrong) +
          " of " + std::to_string(table.rows) + " points would be above 1000 km or below 1e-10 m" +
          (looks_like_nclt(table)
               ? "; it seems to have 8 bytes a point (uint16 x, y, z, uint8 intensity, laser), as "
                 "velodyne_sync of NCLT"
               : "") +
          "; convert it to one, or to PLY, PCD or LAS");
}

/// Checks that the values are possible, since the format has no header.
void require_kitti_values(const std::filesystem::path& path, const Table& table,
                          const char* advice_for_five) {
  if (looks_like_five(table))
    throw data_error({path, {}, {}}, std::string(kFiveFloats) + advice_for_five);
  require_coordinates(path, table);
  const std::vector<float>& intensities = floats(table, 3);
  const auto wrong = std::ranges::find_if_not(intensities, can_be_intensity);
  if (wrong == intensities.end()) return;
  const auto row = static_cast<std::size_t>(wrong - intensities.begin());
  throw data_error({path, row * kKittiFloats * sizeof(float) + 3 * sizeof(float), {}},
                   "the intensity of point " + std::to_string(row) + " (from 0) would be " +
                       exact_text(static_cast<double>(*wrong)) +
                       ", expected 0 to 65535: not a KITTI scan (float32 x, y, z, intensity); "
                       "convert it to one, or to PLY, PCD or LAS");
}

bool is_nuscenes_name(const std::filesystem::path& path) {
  return lower_case(path.filename().string()).ends_with(".pcd.bin");
}

/// Rejects files of CloudCompare, which have the same extension.
void reject_cloud_compare(InputFile& file) {
  constexpr std::string_view kSignature = "CCB";
  if (file.size_bytes() < kSignature.size()) return;
  if (std::memcmp(file.peek(kSignature.size()).data(), kSignature.data(), kSignature.size()) == 0)
    throw data_error({file.path(), 0, {}},
                     "is in CloudCompare's own format; save it as PLY or LAS there");
}

void require_whole_points(const InputFile& file, std::size_t floats_a_point,
                          const std::string& what) {
  const std::size_t record_bytes = floats_a_point * sizeof(float);
  const std::uint64_t left = file.size_bytes() % record_bytes;
  if (left == 0) return;
  throw data_error({file.path(), file.size_bytes(), {}},
                   what + ", found " + std::to_string(left) + " bytes after the last whole point");
}

Table read_four_floats(const std::filesystem::path& path, const char* advice_for_five) {
  InputFile file(path);
  reject_cloud_compare(file);
  const bool five = file.size_bytes() % (kNuScenesFloats * sizeof(float)) == 0;
  require_whole_points(
      file, kKittiFloats,
      "a KITTI scan has 16 bytes a point (float32 x, y, z, intensity)" +
          (five ? std::string("; this file may be from nuScenes, which has 20") + advice_for_five
                : ""));
  const auto other = other_width(file, kKittiFloats);
  Table table = read_floats(file, {"x", "y", "z", "intensity"});
  require_kitti_values(path, table, advice_for_five);
  if (other)
    throw data_error(
        {path, {}, {}},
        "seems to have " + std::to_string(*other) +
            " floats a point, a KITTI scan has 4 (float32 x, y, z, intensity); convert "
            "it to one, or to PLY, PCD or LAS");
  return table;
}

}  // namespace

Table read_kitti_bin(const std::filesystem::path& path) {
  if (is_nuscenes_name(path))
    throw data_error(
        {path, {}, {}},
        "has the name of a nuScenes sweep, which has 5 floats a point" + std::string(kConvertIt));
  return read_four_floats(path, kConvertIt);
}

Table read_bin(const std::filesystem::path& path) {
  if (!is_nuscenes_name(path)) return read_four_floats(path, kNameIt);
  InputFile file(path);
  reject_cloud_compare(file);
  require_whole_points(file, kNuScenesFloats,
                       "a nuScenes sweep (*.pcd.bin) has 20 bytes a point (float32 x, y, z, "
                       "intensity, ring)");
  Table table = read_floats(file, {"x", "y", "z", "intensity", "ring"});
  if (!has_rings(table))
    throw data_error({path, {}, {}},
                     "has the name of a nuScenes sweep (float32 x, y, z, intensity, ring), but its "
                     "fifth column is not a ring (integers from 0 to 255) or its fourth not an "
                     "intensity");
  return table;
}

}  // namespace adasplats
