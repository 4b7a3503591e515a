// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {

namespace {

using Triple = std::array<std::string, 3>;

// Column names of programs and data sets, in lower case, most common first. CloudCompare adds the
// prefix scalar_.
const Triple kPositionNames = {"x", "y", "z"};
const std::array<Triple, 6> kSensorNames = {
    {{"x_lidar_position", "y_lidar_position", "z_lidar_position"},
     {"sensor_x", "sensor_y", "sensor_z"},
     {"x_origin", "y_origin", "z_origin"},
     {"scalar_x_lidar_position", "scalar_y_lidar_position", "scalar_z_lidar_position"},
     {"scalar_sensor_x", "scalar_sensor_y", "scalar_sensor_z"},
     {"scalar_x_origin", "scalar_y_origin", "scalar_z_origin"}}};
const std::array<Triple, 3> kColorNames = {
    {{"red", "green", "blue"}, {"r", "g", "b"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}}};

/// A table and the file it is from, for messages.
struct PointFile {
  const std::filesystem::path& path;
  const Table& table;

  std::string column_list() const {
    std::string list;
    for (const Column& column : table.columns) list += (list.empty() ? "" : ", ") + column.name;
    return list.empty() ? "no columns" : list;
  }

  /// A column by its name in lower case.
  const Column* find(std::string_view lower_name) const {
    for (const Column& column : table.columns)
      if (lower_case(column.name) == lower_name) return &column;
    return nullptr;
  }

  bool has_all(const Triple& names) const {
    return std::ranges::all_of(names,
                               [this](const std::string& name) { return find(name) != nullptr; });
  }

  /// A column that the user named.
  const Column& named(const std::string& name) const {
    if (const Column* column = table.find(name)) return *column;
    std::vector<std::string> names;
    for (const Column& column : table.columns) names.push_back(column.name);
    const auto nearest = nearest_word(name, names);
    throw Error(ErrorKind::usage,
                path.string() + ": has no column '" + name + "'" +
                    (nearest ? ", did you mean '" + *nearest + "'?" : std::string()) + " (it has " +
                    column_list() + ")");
  }

  Error value_error(const Column& column, std::size_t row, const std::string& expected) const {
    const std::string value = std::to_string(column.as_double(row));
    return Error(ErrorKind::data, path.string() + ": column '" + column.name + "' of point " +
                                      std::to_string(row) + " is " + value + ", expected " +
                                      expected);
  }
};

/// Calls visit(row, value) with the values in the column's own type.
template <class Visit>
void for_each_value(const Column& column, Visit&& visit) {
  std::visit(
      [&visit](const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i) visit(i, values[i]);
      },
      column.values);
}

std::vector<Vec3d> read_vectors(const PointFile& file,
                                const std::array<const Column*, 3>& columns) {
  std::vector<Vec3d> vectors(file.table.rows);
  for (int axis = 0; axis < 3; ++axis)
    for_each_value(*columns[static_cast<std::size_t>(axis)], [&](std::size_t i, auto value) {
      vectors[i][axis] = static_cast<double>(value);
    });
  return vectors;
}

/// Whole numbers from 0 to 2^32 - 1, in whatever type the file has them.
std::vector<std::uint32_t> read_whole_numbers(const PointFile& file, const Column& column) {
  std::vector<std::uint32_t> numbers(file.table.rows);
  for_each_value(column, [&](std::size_t i, auto value) {
    bool fits = value >= decltype(value){0};
    if constexpr (std::is_floating_point_v<decltype(value)>)
      fits = fits && std::trunc(value) == value && static_cast<double>(value) < 0x1p32;
    else if constexpr (sizeof(value) > sizeof(std::uint32_t))
      fits = fits && value <= decltype(value){0xffffffff};
    if (!fits) throw file.value_error(column, i, "a whole number from 0 to 4294967295");
    // Through 64 bits: clang-tidy cannot see that a signed char is not negative here.
    numbers[i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
  });
  return numbers;
}

/// Classes from the low 16 bits, as SemanticKITTI packs them; instances from the high 16 bits if
/// any are set.
void read_labels(const PointFile& file, const Column& column, PointCloud& cloud) {
  const std::vector<std::uint32_t> labels = read_whole_numbers(file, column);
  const bool has_instances =
      std::ranges::any_of(labels, [](std::uint32_t label) { return label > 0xffff; });
  cloud.classes.reserve(labels.size());
  for (const std::uint32_t label : labels)
    cloud.classes.push_back(static_cast<std::uint16_t>(label & 0xffff));
  if (!has_instances) return;
  cloud.instances.reserve(labels.size());
  for (const std::uint32_t label : labels)
    cloud.instances.push_back(static_cast<std::uint16_t>(label >> 16));
}

void read_instances(const PointFile& file, const Column& column, PointCloud& cloud) {
  cloud.instances.assign(file.table.rows, 0);
  const std::vector<std::uint32_t> numbers = read_whole_numbers(file, column);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] > 0xffff) throw file.value_error(column, i, "a whole number from 0 to 65535");
    cloud.instances[i] = static_cast<std::uint16_t>(numbers[i]);
  }
}

/// In the encoding of save_cloud_ply().
void read_origin_kinds(const PointFile& file, const Column& column, PointCloud& cloud) {
  const std::vector<std::uint32_t> numbers = read_whole_numbers(file, column);
  cloud.origin_kinds.resize(file.table.rows);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] > static_cast<std::uint32_t>(OriginKind::measured))
      throw file.value_error(column, i, "0 (unknown), 1 (guessed), 2 (stated) or 3 (measured)");
    cloud.origin_kinds[i] = static_cast<OriginKind>(numbers[i]);
  }
}

std::vector<Vec3d> read_positions(const PointFile& file) {
  const auto& [x, y, z] = kPositionNames;
  if (!file.has_all(kPositionNames))
    throw Error(ErrorKind::data, file.path.string() + ": has no columns x, y and z (it has " +
                                     file.column_list() + ")");
  return read_vectors(file, {file.find(x), file.find(y), file.find(z)});
}

/// The first triple of names that the file has; nothing without one.
template <std::size_t kCount>
std::optional<std::array<const Column*, 3>> find_triple(const PointFile& file,
                                                        const std::array<Triple, kCount>& names) {
  for (const auto& [x, y, z] : names)
    if (file.has_all({x, y, z})) return std::array{file.find(x), file.find(y), file.find(z)};
  return std::nullopt;
}

std::optional<std::array<const Column*, 3>> sensor_columns(const PointFile& file,
                                                           const LoadOptions& options) {
  if (!options.sensor_x_field.empty())
    return std::array{&file.named(options.sensor_x_field), &file.named(options.sensor_y_field),
                      &file.named(options.sensor_z_field)};
  return find_triple(file, kSensorNames);
}

/// Gives points guessed sensor positions, on the side that their normals point to. Points without
/// a valid normal get none.
void orient_by_normals(const PointFile& file, CloudPart& part) {
  const Table& table = file.table;
  const std::array<const Column*, 3> columns = {find_column(table, PointColumn::normal_x),
                                                find_column(table, PointColumn::normal_y),
                                                find_column(table, PointColumn::normal_z)};
  if (std::ranges::count(columns, nullptr) > 0) return;
  constexpr double kDistance_m = 10, kMinLength = 1e-6;
  part.world_sensors = read_vectors(file, columns);
  part.cloud.origin_kinds.assign(part.world_sensors.size(), OriginKind::guessed);
  for (std::size_t i = 0; i < part.world_sensors.size(); ++i) {
    const double size = length(part.world_sensors[i]);
    const bool is_valid = size >= kMinLength && std::isfinite(size);
    if (!is_valid) part.cloud.origin_kinds[i] = OriginKind::none;
    part.world_sensors[i] =
        part.world_positions[i] + (is_valid ? kDistance_m / size * part.world_sensors[i] : Vec3d{});
  }
}

/// Red, green and blue of a column that packs them into the bytes of a number, as PCL does: blue in
/// the lowest byte. With other values in the highest byte also alpha.
std::vector<Column> unpacked_colors(const Column& packed) {
  std::array<std::vector<std::uint8_t>, 4> bytes;
  for_each_value(packed, [&bytes](std::size_t, auto value) {
    std::uint32_t bits = 0;
    if constexpr (std::is_same_v<decltype(value), float>)
      bits = std::bit_cast<std::uint32_t>(value);
    else if (std::fabs(static_cast<double>(value)) < 0x1p32)  // no NaN
      bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
    for (std::size_t k = 0; k < bytes.size(); ++k)
      bytes[k].push_back(static_cast<std::uint8_t>(bits >> (8 * k)));
  });
  const bool has_alpha =
      std::ranges::adjacent_find(bytes[3], std::ranges::not_equal_to()) != bytes[3].end();
  std::vector<Column> columns = {
      {"red", std::move(bytes[2])}, {"green", std::move(bytes[1])}, {"blue", std::move(bytes[0])}};
  if (has_alpha) columns.push_back({"alpha", std::move(bytes[3])});
  return columns;
}

/// Adds the fields of LAS that repeat our extra bytes `label` and `intensity_value`, as far as they
/// fit (save_cloud_las()).
void use_copies(const PointFile& file, const PointCloud& cloud, std::vector<const Column*>& used) {
  if (file.find("intensity_value") != nullptr) used.push_back(file.find("intensity"));
  const Column* const copy = file.find("classification");
  if (copy == nullptr || cloud.classes.size() != copy->size()) return;
  constexpr std::uint16_t kMost = 255;
  for (std::size_t i = 0; i < copy->size(); ++i)
    if (copy->as_double(i) != (cloud.classes[i] > kMost ? 0 : cloud.classes[i])) return;
  used.push_back(copy);
}

/// The columns without an attribute, which are those in `used`; colours are named red, green and
/// blue.
void keep_others(const PointFile& file, std::span<const Column* const> used, KeptColumns kept,
                 CloudPart& part) {
  if (kept == KeptColumns::none) return;
  std::vector<Column>& others = part.cloud.others.columns;
  const auto colors = find_triple(file, kColorNames);
  const Column* packed = colors ? nullptr : file.find("rgb");
  if (!colors && packed == nullptr) packed = file.find("rgba");
  if (packed != nullptr) others = unpacked_colors(*packed);
  for (std::size_t k = 0; colors && k < kRgbColumns.size(); ++k)
    others.push_back({kRgbColumns[k], (*colors)[k]->values});
  if (kept == KeptColumns::colors) return;
  for (const Column& column : file.table.columns) {
    const bool is_color = &column == packed || (colors && std::ranges::count(*colors, &column) > 0);
    if (!is_color && std::ranges::count(used, &column) == 0) others.push_back(column);
  }
  part.cloud.others.has_adjusted_times = part.declared_clock == DeclaredClock::adjusted_gps;
}

bool is_las_name(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".las" || extension == ".laz";
}

/// Reports a note of the reader as a warning or an error.
void report(const PointFile& file, const ReaderNote& note, ProgressSink& progress) {
  const std::string start = file.path.string() + ": ";
  switch (note.kind) {
    case NoteKind::withheld:
      return progress.warn(start + note.text + " are flagged as withheld (deleted) and left out");
    case NoteKind::unknown_unit:
      return progress.warn(start + note.text +
                           ", which this version does not know; metres assumed");
    case NoteKind::salvaged: return progress.warn(start + "salvaged " + note.text);
    case NoteKind::left_out: return progress.warn(start + "left out: " + note.text);
    case NoteKind::intensity_scale:
    case NoteKind::own_frame:
    case NoteKind::unnamed_columns: return progress.warn(start + note.text);
    case NoteKind::geographic:
      if (file.table.rows == 0) return;
      throw Error(ErrorKind::data,
                  start + "its coordinates are longitudes and latitudes (" + note.text +
                      "), not metres; project them first (e.g. to UTM: 'pdal translate IN OUT "
                      "reprojection --filters.reprojection.out_srs=...')");
    case NoteKind::not_metres:
      if (file.table.rows == 0) return;
      throw Error(ErrorKind::data,
                  start + "its coordinates are not in metres (" + note.text +
                      "); reproject them to a system in metres, heights included (e.g. UTM zone 18 "
                      "and NAVD88: 'pdal translate IN OUT reprojection "
                      "--filters.reprojection.out_srs=EPSG:32618+5703')");
    case NoteKind::adjusted_gps:
    case NoteKind::no_return:
    case NoteKind::wrong_count: return;
  }
}

/// Least and greatest value of a column, for messages.
std::string range_text(const Column& column) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for_each_value(column, [&](std::size_t, auto value) {
    least = std::min(least, static_cast<double>(value));
    most = std::max(most, static_cast<double>(value));
  });
  return decimal_text(least) + " to " + decimal_text(most);
}

/// Remarks on columns that the user may have expected to be read.
void remark_on_columns(const PointFile& file, const LoadOptions& options, CloudPart& part) {
  for (const Column& column : file.table.columns) {
    if (column.name == options.label_field || column.name == options.sensor_x_field ||
        column.name == options.sensor_y_field || column.name == options.sensor_z_field)
      continue;
    if (const auto likely = likely_column_name(column.name))
      part.remarks.push_back("column " + shown(column.name) + " is not read, did you mean '" +
                             *likely + "'? Rename the column to use it");
    if (part.cloud.intensities.empty() && is_in_decibels(column))
      part.remarks.push_back("column " + shown(column.name) + " has values of " +
                             range_text(column) +
                             ", so it is in decibels and not used as intensity; add a column "
                             "'intensity' of linear values, such as 10^(dB / 10), to use it");
  }
  if (!options.trajectory.empty() && part.times_s.empty() && part.world_sensors.empty() &&
      has_times(options.trajectory))
    part.remarks.push_back("no column of times (found " + file.column_list() +
                           "); sensor positions on the trajectory need one");
}

/// Intensities of LAS are "0 when not included": if all are 0, they are unknown.
void read_intensities(const PointFile& file, const Column& column, CloudPart& part) {
  std::vector<float>& intensities = part.cloud.intensities;
  intensities.resize(file.table.rows);
  for_each_value(column, [&intensities](std::size_t i, auto value) {
    intensities[i] = static_cast<float>(value);
  });
  if (!is_las_name(file.path) || column.name != "intensity" || intensities.empty() ||
      std::ranges::any_of(intensities, [](float value) { return value != 0; }))
    return;
  std::ranges::fill(intensities, std::numeric_limits<float>::quiet_NaN());
}

/// What to do with the VIEWPOINT of a PCD whose points are not known to be in the sensor's frame.
/// CloudCompare stores the shift of its coordinates there, others the pose of the sensor.
void apply_viewpoint(const PointFile& file, const LoadOptions& options, CloudPart& part) {
  constexpr std::string_view kKey = "VIEWPOINT ";
  constexpr double kMinShift_m = 10e3;
  const auto comment = std::ranges::find_if(
      file.table.comments, [kKey](const std::string& text) { return text.starts_with(kKey); });
  if (comment == file.table.comments.end()) return;
  std::array<double, 7> values{};
  BlankTokens tokens(std::string_view(*comment).substr(kKey.size()));
  for (double& value : values) value = parse_number<double>(tokens.next()).value_or(0);
  const Vec3d place{values[0], values[1], values[2]};
  const bool is_turned = values[4] != 0 || values[5] != 0 || values[6] != 0;
  if (!is_turned && place == Vec3d{}) return;
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0;
  for (const Vec3d p : part.world_positions) {
    if (!is_finite(p)) continue;
    nearest_m = std::min(nearest_m, length(p - place));
    farthest_m = std::max(farthest_m, length(p));
  }
  if (!is_turned && nearest_m > kMinShift_m && farthest_m < length(place)) {
    for (Vec3d& p : part.world_positions) p = p + place;
    part.remarks.push_back(
        "VIEWPOINT is far from the points and not turned, so it is the shift "
        "of their coordinates (CloudCompare), and added: " +
        decimal_text(place.x) + ", " + decimal_text(place.y) + ", " + decimal_text(place.z) + " m");
    return;
  }
  if (options.viewpoint) return;
  part.remarks.push_back(
      "its " + *comment +
      " (x y z qw qx qy qz) is not used: for points in the world, give the "
      "sensor's position as `viewpoint`; for a scan in the sensor's frame, give its folder and the "
      "pose in a file as `trajectory`");
}

/// Only LAS declares its clock: adjusted GPS time if a note reports it, else seconds of the week.
DeclaredClock declared_clock_of(const PointFile& file) {
  if (!is_las_name(file.path)) return DeclaredClock::none;
  const bool is_adjusted = std::ranges::find(file.table.notes, NoteKind::adjusted_gps,
                                             &ReaderNote::kind) != file.table.notes.end();
  return is_adjusted ? DeclaredClock::adjusted_gps : DeclaredClock::gps_week;
}

/// Whether a file may be in the frame of a sensor without saying so: E57 and PTX have a pose per
/// scan, and files with a coordinate system are in it.
bool can_lack_pose(const std::filesystem::path& path, const Table& table) {
  const std::string extension = lower_case(path.extension().string());
  return extension != ".e57" && extension != ".ptx" && table.crs.empty();
}

/// With the unit in the column's name, and a second column of nanoseconds.
void read_times(const PointFile& file, CloudPart& part) {
  const Column* const time = find_column(file.table, PointColumn::time);
  if (time == nullptr) return;
  const double unit_s = time_unit_of_name(time->name);
  part.times_s.resize(file.table.rows);
  for_each_value(*time, [&](std::size_t i, auto value) {
    part.times_s[i] = unit_s * static_cast<double>(value);
  });
  if (const Column* const fractions = nanoseconds_beside(file.table, *time))
    for_each_value(*fractions, [&](std::size_t i, auto value) {
      part.times_s[i] += 1e-9 * static_cast<double>(value);
    });
  part.declared_clock = declared_clock_of(file);
}

}  // namespace

void mark_missing_returns(const Table& table, std::vector<Vec3d>& positions) {
  constexpr std::ptrdiff_t kMany = 100, kShare = 1000;
  const auto is_nothing = [](Vec3d p) { return p == Vec3d{}; };
  const std::ptrdiff_t count = std::ranges::count_if(positions, is_nothing);
  const bool is_grid = std::ranges::any_of(
      table.comments, [](const std::string& comment) { return comment.starts_with("HEIGHT "); });
  const bool are_many =
      count >= kMany && kShare * count >= static_cast<std::ptrdiff_t>(positions.size());
  if (count == std::ssize(positions) || !(is_grid || are_many)) return;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::ranges::replace_if(positions, is_nothing, Vec3d{kNone, kNone, kNone});
}

CloudPart read_file_part(const std::filesystem::path& path, const LoadOptions& options,
                         ProgressSink& progress, const Executor* executor) {
  require_points(path);
  const Table table = read_points(path, {options.salvage, executor, options.selection,
                                         options.other_columns == KeptColumns::all});
  CloudPart part = part_of_table(path, table, options, progress);
  mark_missing_returns(table, part.world_positions);
  if (!part.world_sensors.empty()) return part;
  part.sensor_frame = sensor_frame_of(path, table, part.world_positions);
  if (!part.sensor_frame && options.selection.is_all() && can_lack_pose(path, table)) {
    const Executor own(1);
    part.sensor_frame =
        scan_pattern_of(part.world_positions, executor != nullptr ? *executor : own);
    if (part.sensor_frame) part.sensor_frame->has_pose = has_viewpoint(table);
  }
  if (!part.sensor_frame) apply_viewpoint({path, table}, options, part);
  return part;
}

CloudPart part_of_table(const std::filesystem::path& path, const Table& table,
                        const LoadOptions& options, ProgressSink& progress) {
  const PointFile file{path, table};
  for (const ReaderNote& note : table.notes) report(file, note, progress);

  CloudPart part;
  part.cloud.crs = table.crs;
  part.runs.push_back({0, table.rows, path, {}});
  part.world_positions = read_positions(file);
  if (file.find("f_dc_0") && file.find("opacity") && file.find("rot_0"))
    throw Error(ErrorKind::data, file.path.string() +
                                     ": contains Gaussian splats, not points; give the points or "
                                     "the model that they were made from");
  std::vector<const Column*> used;
  for (const std::string& name : kPositionNames) used.push_back(file.find(name));
  const auto use = [&used](const Column* column) {
    if (column != nullptr) used.push_back(column);
    return column;
  };
  if (const auto columns = sensor_columns(file, options)) {
    part.world_sensors = read_vectors(file, *columns);
    used.insert(used.end(), columns->begin(), columns->end());
  }
  read_times(file, part);
  PointCloud& cloud = part.cloud;
  if (const Column* column = file.find("origin_kind"); column && !part.world_sensors.empty())
    read_origin_kinds(file, *use(column), cloud);
  if (!options.label_field.empty())
    read_labels(file, *use(&file.named(options.label_field)), cloud);
  else if (const Column* column = use(find_column(table, PointColumn::classification)))
    read_labels(file, *column, cloud);
  if (const Column* column = use(find_column(table, PointColumn::instance)))
    read_instances(file, *column, cloud);
  if (const Column* column = use(find_column(table, PointColumn::scan_index)))
    cloud.scan_indices = read_whole_numbers(file, *column);
  if (const Column* column = find_column(table, PointColumn::intensity)) {
    read_intensities(file, *column, part);
    // An amplitude, which need not be linear, also keeps its name.
    if (lower_case(column->name).find("amplitude") == std::string::npos) use(column);
    // One that is 0 throughout gave way to another.
    if (const Column* const zeros = file.find("intensity"); zeros != column) use(zeros);
  }
  remark_on_columns(file, options, part);
  const bool has_origins =
      !part.world_sensors.empty() || options.viewpoint || !options.trajectory.empty();
  if (!has_origins && options.other_columns != KeptColumns::all) orient_by_normals(file, part);
  use_copies(file, cloud, used);
  keep_others(file, used, options.other_columns, part);
  return part;
}

}  // namespace adasplats
