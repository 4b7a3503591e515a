// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/error_points.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/cloud_metrics.h"
#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/ply/ply_header.h"

namespace adasplats {
namespace {

constexpr float kNoError = std::numeric_limits<float>::quiet_NaN();
constexpr const char* kErrorName = "error_m";
constexpr std::string_view kCountComment = "adasplats.model_splats ";
/// The limits of load_cloud: beyond, doubles do not resolve 0.1 mm; maximum distance from the
/// median.
constexpr double kLargest_m = 1e12;
constexpr double kFarthest_m = 100e3;

// In lower case, the most common first.
const std::initializer_list<std::string_view> kErrorNames = {"error_m", "scalar_error_m",
                                                             "scalar_c2c_absolute_distances"};
const std::initializer_list<std::string_view> kSplatNames = {"splat", "scalar_splat"};

const Column* first_of(const Table& table, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    for (const Column& column : table.columns)
      if (lower_case(column.name) == name) return &column;
  return nullptr;
}

const Column& required(const Table& table, const std::filesystem::path& path,
                       std::initializer_list<std::string_view> names) {
  if (const Column* const column = first_of(table, names)) return *column;
  std::string list;
  for (const Column& column : table.columns) list += (list.empty() ? "" : ", ") + column.name;
  throw Error(ErrorKind::data, path.string() + ": has no column '" + std::string(*names.begin()) +
                                   "', expected points with errors (found " +
                                   (list.empty() ? "no columns" : list) + ")");
}

/// The low 16 bits, as SemanticKITTI packs labels.
std::uint16_t class_at(const Column& column, std::size_t row, const std::filesystem::path& path) {
  const double value = column.as_double(row);
  if (!(value >= 0 && value < 0x1p32 && std::trunc(value) == value))
    throw Error(ErrorKind::data, path.string() + ": column '" + column.name + "' of point " +
                                     std::to_string(row) + " is " + std::to_string(value) +
                                     ", expected a whole number from 0 to 4294967295");
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(value) & 0xffffU);
}

/// -1: none.
std::uint32_t splat_at(const Column& column, std::size_t row, const std::filesystem::path& path) {
  const double value = column.as_double(row);
  if (value == -1) return Hit::kNone;
  if (!(value >= 0 && value < 0x1p31 && std::trunc(value) == value))
    throw Error(ErrorKind::data, path.string() + ": column '" + column.name + "' of point " +
                                     std::to_string(row) + " is " + std::to_string(value) +
                                     ", expected a whole number, -1 or more");
  return static_cast<std::uint32_t>(value);
}

bool is_valid_position(Vec3d p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) <= kLargest_m && is_finite(p);
}

/// Componentwise, lower, of one or more positions.
Vec3d median_position(const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& rows) {
  Vec3d median;
  std::vector<double> values(rows.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < rows.size(); ++k) values[k] = positions[rows[k]][axis];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

/// Rows of positions that are finite and not far from the others.
std::vector<std::uint32_t> near_rows(const std::vector<Vec3d>& positions) {
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (is_valid_position(positions[i])) rows.push_back(static_cast<std::uint32_t>(i));
  if (rows.empty()) return rows;
  const Vec3d median = median_position(positions, rows);
  std::erase_if(rows, [&](std::uint32_t i) { return length(positions[i] - median) > kFarthest_m; });
  return rows;
}

/// Sets origin and positions of the cloud from rows of positions in world coordinates.
void set_positions(PointCloud& cloud, const std::vector<Vec3d>& positions,
                   const std::vector<std::uint32_t>& rows) {
  if (rows.empty()) return;
  Vec3d low = positions[rows.front()], high = low;
  for (const std::uint32_t i : rows) {
    low = min(low, positions[i]);
    high = max(high, positions[i]);
  }
  cloud.origin = choose_origin(low, high);
  cloud.positions.reserve(rows.size());
  for (const std::uint32_t i : rows)
    cloud.positions.push_back(vec_cast<float>(positions[i] - cloud.origin));
}

constexpr double kMaxError_m = 0.5;  // limit for one beam

/// Throws data unless the beams are of a model with `splats`.
void require_model(const ErrorPoints& points, std::size_t splats,
                   const std::filesystem::path& path) {
  if (!has_splat_hits(points))
    throw Error(ErrorKind::data, path.string() +
                                     ": has no column 'splat' for the splats that its beams "
                                     "hit; write it again with 'evaluate resimulate --errors'");
  if (points.primitive_count == 0)
    throw Error(ErrorKind::data,
                path.string() +
                    ": has no comment 'adasplats.model_splats N' with the number of splats of "
                    "its model; write it again with 'evaluate resimulate --errors'");
  if (points.primitive_count != splats)
    throw Error(ErrorKind::data, path.string() + ": the errors are of another model, of " +
                                     std::to_string(points.primitive_count) +
                                     " splats; this one has " + std::to_string(splats));
  for (const std::uint32_t splat : points.primitives)
    if (splat != Hit::kNone && splat >= splats)
      throw Error(ErrorKind::data, path.string() + ": a beam hit splat " + std::to_string(splat) +
                                       " of " + std::to_string(splats));
}

}  // namespace

ErrorPoints distance_points(PointCloud simulated, const PointCloud& original,
                            const Executor& executor) {
  ErrorPoints points;
  points.errors_m = distances_to(simulated, original, executor);
  points.cloud = std::move(simulated);
  return points;
}

ErrorPoints beam_points(std::vector<ScanErrors> scans, const Trajectory& trajectory,
                        std::size_t primitive_count) {
  if (scans.size() != trajectory.size())
    throw std::logic_error("beam_points: " + std::to_string(scans.size()) + " scans, " +
                           std::to_string(trajectory.size()) + " poses");
  ErrorPoints points;
  points.primitive_count = primitive_count;
  std::vector<Vec3d> positions;
  for (std::size_t index = 0; index < scans.size(); ++index) {
    const ScanErrors scan = std::move(scans[index]);  // releases its memory
    const RigidTransform& world_from_sensor = trajectory[index].world_from_sensor;
    for (const Vec3f p : scan.measured)
      positions.push_back(world_from_sensor * vec_cast<double>(p));
    points.errors_m.insert(points.errors_m.end(), scan.errors_m.begin(), scan.errors_m.end());
    points.primitives.insert(points.primitives.end(), scan.primitives.begin(),
                             scan.primitives.end());
  }
  std::vector<std::uint32_t> rows(positions.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<std::uint32_t>(i);
  set_positions(points.cloud, positions, rows);
  return points;
}

void write_error_points(const std::filesystem::path& path, const ErrorPoints& points) {
  const PointCloud& cloud = points.cloud;
  const auto fits = [&](std::size_t size) { return size == 0 || size == cloud.size(); };
  if (points.errors_m.size() != cloud.size() || !fits(cloud.classes.size()) ||
      !fits(cloud.intensities.size()) || !fits(points.primitives.size()))
    throw std::logic_error("write_error_points: an attribute of another size than the points");
  const bool far = !(cloud.origin == Vec3d{});
  std::vector<Vec3d> world;
  for (std::size_t i = 0; far && i < cloud.size(); ++i) world.push_back(cloud.world(i));
  std::vector<ColumnView> columns;
  const Vec3f* const local = cloud.positions.data();
  const auto add_axis = [&](const char* name, float Vec3f::*near_axis, double Vec3d::*far_axis) {
    if (cloud.empty())
      columns.push_back({name, ColumnType::f32, nullptr, sizeof(float)});
    else if (far)
      columns.push_back({name, ColumnType::f64, &(world.data()->*far_axis), sizeof(Vec3d)});
    else
      columns.push_back({name, ColumnType::f32, &(local->*near_axis), sizeof(Vec3f)});
  };
  add_axis("x", &Vec3f::x, &Vec3d::x);
  add_axis("y", &Vec3f::y, &Vec3d::y);
  add_axis("z", &Vec3f::z, &Vec3d::z);
  columns.push_back({kErrorName, ColumnType::f32, points.errors_m.data(), sizeof(float)});
  if (!cloud.intensities.empty())
    columns.push_back({"intensity", ColumnType::f32, cloud.intensities.data(), sizeof(float)});
  if (!cloud.classes.empty())
    columns.push_back({"label", ColumnType::u16, cloud.classes.data(), sizeof(std::uint16_t)});
  // The bits of Hit::kNone are those of -1.
  if (!points.primitives.empty())
    columns.push_back({"splat", ColumnType::i32, points.primitives.data(), sizeof(std::uint32_t)});
  std::vector<std::string> comments;
  if (!points.primitives.empty())
    comments.push_back(std::string(kCountComment) + std::to_string(points.primitive_count));
  write_ply(path, cloud.size(), columns, comments);
}

bool has_error_points(const std::filesystem::path& path) {
  if (lower_case(path.extension().string()) != ".ply") return false;
  InputFile file(path);
  LineReader lines(file);
  const PlyHeader header = read_ply_header(lines);
  const PlyElement* const vertices = header.find("vertex");
  return vertices != nullptr &&
         std::ranges::any_of(vertices->properties, [](const PlyProperty& property) {
           return std::ranges::find(kErrorNames, lower_case(property.name)) != kErrorNames.end();
         });
}

ErrorPoints read_error_points(const std::filesystem::path& path) {
  const Table table = read_points(path);
  const Column& errors = required(table, path, kErrorNames);
  const Column* const axes[3] = {&required(table, path, {"x"}), &required(table, path, {"y"}),
                                 &required(table, path, {"z"})};
  std::vector<Vec3d> positions(table.rows);
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i][axis] = axes[axis]->as_double(i);
  const std::vector<std::uint32_t> rows = near_rows(positions);
  ErrorPoints points;
  points.dropped = table.rows - rows.size();
  set_positions(points.cloud, positions, rows);
  const auto finite = [](double value) {
    const float narrow = static_cast<float>(value);
    return std::isfinite(narrow) ? narrow : kNoError;
  };
  for (const std::uint32_t i : rows) points.errors_m.push_back(finite(errors.as_double(i)));
  if (const Column* const classes = find_column(table, PointColumn::classification))
    for (const std::uint32_t i : rows) points.cloud.classes.push_back(class_at(*classes, i, path));
  if (const Column* const intensities = find_column(table, PointColumn::intensity))
    for (const std::uint32_t i : rows)
      points.cloud.intensities.push_back(finite(intensities->as_double(i)));
  if (const Column* const splats = first_of(table, kSplatNames))
    for (const std::uint32_t i : rows) points.primitives.push_back(splat_at(*splats, i, path));
  for (const std::string& comment : table.comments)
    if (comment.starts_with(kCountComment))
      points.primitive_count = std::strtoull(comment.c_str() + kCountComment.size(), nullptr, 10);
  return points;
}

void SplatErrors::add(const ErrorPoints& points, const std::filesystem::path& path) {
  require_model(points, counts_.size(), path);
  for (std::size_t i = 0; i < points.primitives.size(); ++i) {
    const std::uint32_t splat = points.primitives[i];
    if (splat == Hit::kNone || std::isnan(points.errors_m[i])) continue;
    sums_m_[splat] +=
        std::clamp(static_cast<double>(points.errors_m[i]), -kMaxError_m, kMaxError_m);
    ++counts_[splat];
  }
}

std::vector<float> SplatErrors::means_m() const {
  std::vector<float> means(counts_.size(), kNoError);
  for (std::size_t i = 0; i < means.size(); ++i)
    if (counts_[i] > 0) means[i] = static_cast<float>(sums_m_[i] / counts_[i]);
  return means;
}

}  // namespace adasplats
