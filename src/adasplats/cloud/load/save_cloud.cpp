// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/las/las_writer.h"
#include "adasplats/io/pcd/pcd_writer.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/text/csv_writer.h"

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

/// The values of a column as T; nothing if T does not hold them exactly.
template <class T>
std::optional<std::vector<T>> exact_values(const Column& column) {
  std::vector<T> values;
  values.reserve(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    const double value = column.as_double(i);
    const bool fits = value >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
                      value <= static_cast<double>(std::numeric_limits<T>::max()) &&
                      std::trunc(value) == value;
    if (!fits) return std::nullopt;
    values.push_back(static_cast<T>(value));
  }
  return values;
}

ColumnView column_view(const Column& column) {
  return std::visit(
      [&column](const auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        return ColumnView{column.name, column_type<Value>(), values.data(), sizeof(Value)};
      },
      column.values);
}

/// Columns that are written, with values of their own where the format needs other types.
class OtherViews {
 public:
  explicit OtherViews(std::vector<ColumnView>& columns) : columns_(columns) {}

  bool has(const std::string& name) const {
    return std::ranges::any_of(columns_, [&name](const ColumnView& other) {
      return lower_case(other.name) == lower_case(name);
    });
  }

  /// Under the column's name, or a free one.
  void add(Column column) {
    while (has(column.name)) column.name += '_';
    columns_.push_back(column_view(owned_.emplace_back(std::move(column))));
  }

 private:
  std::vector<ColumnView>& columns_;
  std::deque<Column> owned_;
};

/// Whether three columns are 8-bit colours, also as multiples of 256 or 257; if so the factor.
unsigned factor_of_bytes(std::span<const Column* const> colors) {
  for (const unsigned factor : {1U, 256U, 257U}) {
    const auto is_byte = [factor](const Column* column) {
      const auto values = exact_values<std::uint16_t>(*column);
      return values && std::ranges::all_of(*values, [factor](std::uint16_t value) {
               return value % factor == 0 && value / factor <= 255;
             });
    };
    if (std::ranges::all_of(colors, is_byte)) return factor;
  }
  return 0;
}

std::vector<const Column*> colors_in(const OtherColumns& others) {
  std::vector<const Column*> colors;
  for (const std::string_view name : kRgbColumns) {
    const auto found = std::ranges::find(others.columns, name, &Column::name);
    if (found != others.columns.end()) colors.push_back(&*found);
  }
  return colors.size() == kRgbColumns.size() ? colors : std::vector<const Column*>();
}

/// Properties of PLY have no blanks and at most 32 bits, or are doubles. Colours are bytes where
/// that is exact, as other programs expect. Fields of PCD and columns of CSV are the same.
void add_others_named(const OtherColumns& others, OtherViews& views) {
  const std::vector<const Column*> colors = colors_in(others);
  const unsigned factor = colors.empty() ? 0 : factor_of_bytes(colors);
  for (const Column& column : others.columns) {
    Column written = column;
    const auto separates = [](char c) {
      return std::string_view(" \t\r\n,;\"").find(c) != std::string_view::npos;
    };
    std::ranges::replace_if(written.name, separates, '_');
    if (factor != 0 && std::ranges::count(colors, &column) > 0) {
      std::vector<std::uint8_t> bytes;
      for (std::size_t i = 0; i < column.size(); ++i)
        bytes.push_back(static_cast<std::uint8_t>(column.as_double(i) / factor));
      written.values = std::move(bytes);
    } else if (std::holds_alternative<std::vector<std::int64_t>>(column.values) ||
               std::holds_alternative<std::vector<std::uint64_t>>(column.values)) {
      std::vector<double> values(column.size());
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = column.as_double(i);
      written.values = std::move(values);
    }
    views.add(std::move(written));
  }
}

/// The fields of LAS for whole numbers.
template <class T>
bool is_las_field(std::string_view name) {
  constexpr std::array<std::string_view, 9> kBytes = {
      "return_number",   "number_of_returns",   "user_data",
      "synthetic",       "key_point",           "overlap",
      "scanner_channel", "scan_direction_flag", "edge_of_flight_line"};
  if constexpr (sizeof(T) == 1) return std::ranges::find(kBytes, name) != kBytes.end();
  return name == "point_source_id";
}

template <class T>
bool add_las_field(const Column& column, OtherViews& views) {
  const std::string name = las_field_name(column.name);
  if (!is_las_field<T>(name)) return false;
  auto values = exact_values<T>(column);
  constexpr int kMaxReturns = 15, kMaxChannel = 3;
  const int most = name == "scanner_channel"   ? kMaxChannel
                   : name == "point_source_id" ? std::numeric_limits<std::uint16_t>::max()
                   : name == "user_data"       ? std::numeric_limits<std::uint8_t>::max()
                   : name.find("return") != std::string::npos ? kMaxReturns
                                                              : 1;
  if (!values || std::ranges::any_of(*values, [most](T value) { return value > most; }))
    return false;
  views.add({name, std::move(*values)});
  return true;
}

/// Degrees in steps of LAS; nothing if one is beyond its range.
std::optional<std::vector<std::int16_t>> las_angles(const Column& column) {
  constexpr double kStep_deg = 0.006, kMost = 30000;
  std::vector<std::int16_t> steps;
  for (std::size_t i = 0; i < column.size(); ++i) {
    const double step = std::round(column.as_double(i) / kStep_deg);
    if (!(std::fabs(step) <= kMost)) return std::nullopt;
    steps.push_back(static_cast<std::int16_t>(step));
  }
  return steps;
}

/// Whether a column has seconds of a clock, which LAS has a field for.
bool is_timestamp(const Column& column) {
  constexpr double kMax_s = 1e11;  // in the year 5138; other units since 1970 are larger
  const auto* const times = std::get_if<std::vector<double>>(&column.values);
  return times != nullptr && lower_case(column.name) == "timestamp" &&
         std::ranges::none_of(*times, [](double time) { return std::fabs(time) > kMax_s; });
}

/// The field of LAS for a column, or its own name.
std::string field_for(const Column& column, const OtherColumns& others) {
  const auto is_gps_time = [](const Column& other) {
    return las_field_name(other.name) == "gps_time";
  };
  if (is_timestamp(column) && std::ranges::none_of(others.columns, is_gps_time)) return "gps_time";
  return las_field_name(column.name);
}

/// Red, green, blue and near infrared, if LAS can hold them; bytes become 16 bits as the
/// specification says. Columns that LAS has no field for become extra bytes.
void add_others_las(const OtherColumns& others, OtherViews& views) {
  std::vector<const Column*> colors = colors_in(others);
  const bool are_bytes = !colors.empty() && factor_of_bytes(colors) == 1 &&
                         !std::holds_alternative<std::vector<std::uint16_t>>(colors[0]->values);
  const bool fit = std::ranges::all_of(colors, [](const Column* column) {
    return exact_values<std::uint16_t>(*column).has_value();
  });
  if (!fit) colors.clear();
  for (const Column& column : others.columns) {
    const bool is_color = std::ranges::count(colors, &column) > 0;
    const std::string name = field_for(column, others);
    const std::string field = views.has(name) ? std::string() : name;
    if (is_color || (field == "nir" && !colors.empty())) {
      if (auto values = exact_values<std::uint16_t>(column)) {
        for (std::uint16_t& value : *values)
          if (is_color && are_bytes) value = static_cast<std::uint16_t>(256 * value);
        views.add({is_color ? column.name : field, std::move(*values)});
        continue;
      }
    }
    if (field == "gps_time") {
      std::vector<double> times(column.size());
      for (std::size_t i = 0; i < times.size(); ++i) times[i] = column.as_double(i);
      views.add({field, std::move(times)});
      continue;
    }
    if (field == "scan_angle") {
      if (auto steps = las_angles(column)) {
        views.add({"scan_angle", std::move(*steps)});
        continue;
      }
    }
    if (!field.empty() &&
        (add_las_field<std::uint8_t>(column, views) || add_las_field<std::uint16_t>(column, views)))
      continue;
    // Extra bytes: a name that is no field's, of at most 31 bytes.
    constexpr std::size_t kMaxName = 31;
    const std::string lower = lower_case(column.name);
    const bool is_reserved = is_las_field<std::uint8_t>(lower) ||
                             is_las_field<std::uint16_t>(lower) || lower == "gps_time" ||
                             lower == "scan_angle" || lower == "nir" || lower == "classification" ||
                             std::ranges::count(kRgbColumns, lower) > 0;
    views.add({column.name.substr(0, kMaxName - 1) + (is_reserved ? "_" : ""), column.values});
  }
}

/// The columns of a cloud for PLY, PCD and CSV. The cloud must outlive it.
class NamedColumns {
 public:
  NamedColumns(const PointCloud& cloud, std::span<const ColumnView> more) : others_(columns_) {
    if (cloud.empty()) {
      for (const std::string_view name : kPositionColumns)
        columns_.push_back({name, ColumnType::f32, nullptr, sizeof(float)});
    } else if (cloud.origin == Vec3d{}) {
      add_vectors(columns_, kPositionColumns, ColumnType::f32, cloud.positions);
      add_vectors(columns_, kSensorColumns, ColumnType::f32, cloud.sensor_positions);
    } else {
      positions_ = in_world(cloud.origin, cloud.positions);
      sensors_ = in_world(cloud.origin, cloud.sensor_positions);
      add_vectors(columns_, kPositionColumns, ColumnType::f64, positions_);
      add_vectors(columns_, kSensorColumns, ColumnType::f64, sensors_);
    }
    add_attributes(columns_, cloud, "intensity");
    columns_.insert(columns_.end(), more.begin(), more.end());
    add_others_named(cloud.others, others_);
  }
  NamedColumns(const NamedColumns&) = delete;
  NamedColumns& operator=(const NamedColumns&) = delete;

  std::span<const ColumnView> columns() const { return columns_; }

 private:
  std::vector<ColumnView> columns_;
  std::vector<Vec3d> positions_, sensors_;
  OtherViews others_;
};

/// The coordinate system and the label scheme as comments of a file.
std::vector<std::string> comments_of(const PointCloud& cloud) {
  std::vector<std::string> comments = crs_comments(cloud.crs);
  if (!cloud.label_scheme.empty() && !cloud.classes.empty())
    comments.push_back(std::string(kLabelsComment) + cloud.label_scheme);
  return comments;
}

}  // namespace

void save_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                    std::span<const ColumnView> more) {
  write_ply(path, cloud.size(), NamedColumns(cloud, more).columns(), comments_of(cloud));
}

void save_cloud_pcd(const std::filesystem::path& path, const PointCloud& cloud) {
  write_pcd(path, cloud.size(), NamedColumns(cloud, {}).columns(), {0, 0, 0, 1, 0, 0, 0},
            comments_of(cloud));
}

void save_cloud_csv(const std::filesystem::path& path, const PointCloud& cloud) {
  write_csv(path, cloud.size(), NamedColumns(cloud, {}).columns(), comments_of(cloud));
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
  OtherViews others(columns);
  add_others_las(cloud.others, others);
  LasWriteOptions options;
  options.has_adjusted_times = cloud.others.has_adjusted_times;
  if (!cloud.classes.empty()) options.labels = cloud.label_scheme;
  options.offset_m = cloud.origin;
  options.crs = cloud.crs;
  options.is_packed = is_laz_name(path);
  write_las(path, cloud.size(), columns, options);
}

}  // namespace adasplats
