// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/splat_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/gaussians/spz_reader.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/text/gltf.h"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/splats/model/calibration_comments.h"
#include "adasplats/splats/model/gaussians.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

constexpr const char* kNetworkComment = "adasplats.network_sha256 ";
/// Keys of the response's tables, in the order of response_tables().
constexpr std::array<const char*, 4> kResponseComments = {
    "adasplats.response_ranges_m ", "adasplats.response_range_gains ",
    "adasplats.response_cosines ", "adasplats.response_cosine_gains "};

const Column& required(const Table& table, const std::filesystem::path& path,
                       std::string_view name) {
  const Column* column = table.find(name);
  if (column == nullptr)
    throw data_error({path, {}, {}}, "not a model (no vertex property '" + std::string(name) +
                                         "'); 'adasplats model' builds one from a point cloud");
  return *column;
}

Disk checked_disk(const std::filesystem::path& path, std::size_t row, Vec3d center, Vec3d normal,
                  double radius) {
  const auto fail = [&](const std::string& what) {
    throw data_error({path, {}, {}}, "splat " + std::to_string(row) + ": " + what);
  };
  if (!is_finite(center) || !is_finite(normal)) fail("center or normal is not finite");
  if (!(radius > 0.0) || !std::isfinite(radius))
    fail("radius is " + std::to_string(radius) + ", expected greater than 0");
  const double norm = length(normal);
  if (!(std::fabs(norm - 1.0) <= 1e-3))
    fail("normal has length " + std::to_string(norm) + ", expected 1");
  const Disk disk = {vec_cast<float>(center), static_cast<float>(radius), vec_cast<float>(normal)};
  if (!is_finite(disk.center)) fail("center is too far from the other splats for single precision");
  if (!(disk.radius > 0.0F) || !std::isfinite(disk.radius))
    fail("radius is out of range for single precision");
  return disk;
}

/// An integer property of every splat, from 0 to `max`.
template <class T>
std::vector<T> whole_numbers(const std::filesystem::path& path, const Column& column,
                             std::size_t rows, int max) {
  std::vector<T> numbers;
  for (std::size_t i = 0; i < rows; ++i) {
    const double number = column.as_double(i);
    if (!(number >= 0 && number <= max) || number != std::trunc(number))
      throw data_error({path, {}, {}}, "splat " + std::to_string(i) + ", " + column.name +
                                           ": found " + std::to_string(number) +
                                           ", expected an integer from 0 to " +
                                           std::to_string(max));
    numbers.push_back(static_cast<T>(number));
  }
  return numbers;
}

constexpr int kMostDrop = 100;  // odds of e^100

std::vector<float> numbers_within(const std::filesystem::path& path, const Column& column,
                                  std::size_t rows, int low, int high) {
  std::vector<float> numbers;
  for (std::size_t i = 0; i < rows; ++i) {
    const double number = column.as_double(i);
    if (!(number >= low && number <= high))
      throw data_error({path, {}, {}}, "splat " + std::to_string(i) + ": " + column.name + " is " +
                                           std::to_string(number) + ", expected " +
                                           std::to_string(low) + " to " + std::to_string(high));
    numbers.push_back(static_cast<float>(number));
  }
  return numbers;
}

std::pair<Vec3d, Vec3d> extent_of(const std::array<const Column*, 3>& columns, std::size_t rows) {
  Vec3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = rows > 0 ? columns[static_cast<std::size_t>(axis)]->as_double(0) : 0;
    high[axis] = low[axis];
    for (std::size_t i = 1; i < rows; ++i) {
      const double v = columns[static_cast<std::size_t>(axis)]->as_double(i);
      low[axis] = std::min(low[axis], v);
      high[axis] = std::max(high[axis], v);
    }
  }
  return {low, high};
}

/// The members of an IntensityResponse, const or not.
template <class Response>
auto response_tables(Response& response) {
  return std::array{&response.ranges_m, &response.range_gains, &response.cos_incidences,
                    &response.incidence_gains};
}

/// The shortest text that parses to the same number.
template <class Float>
std::string number_text(Float value) {
  std::array<char, 32> buffer;
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

void add_response_comments(const IntensityResponse& response, std::vector<std::string>& comments) {
  if (response.empty()) return;
  const auto tables = response_tables(response);
  for (std::size_t k = 0; k < tables.size(); ++k) {
    std::string comment = kResponseComments[k];
    for (const float value : *tables[k]) comment += number_text(value) + " ";
    comment.pop_back();
    comments.push_back(comment);
  }
}

std::vector<float> numbers_of(const std::filesystem::path& path, const std::string& text) {
  std::vector<float> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::optional<float> value = parse_number<float>(word);
    if (!value || !std::isfinite(*value) || *value < 0)
      throw data_error({path, {}, {}}, std::string("the intensity response contains ") +
                                           shown(word) + ", expected a number of at least 0");
    numbers.push_back(*value);
  }
  return numbers;
}

IntensityResponse response_of(const Table& table, const std::filesystem::path& path) {
  IntensityResponse response;
  const auto tables = response_tables(response);
  for (std::size_t k = 0; k < tables.size(); ++k)
    *tables[k] = numbers_of(path, comment_value(table, kResponseComments[k]));
  const auto is_table = [](const std::vector<float>& nodes, const std::vector<float>& values) {
    const auto not_after = [](float a, float b) { return a >= b; };
    return nodes.size() == values.size() && nodes.size() != 1 &&
           std::adjacent_find(nodes.begin(), nodes.end(), not_after) == nodes.end();
  };
  if (!is_table(response.ranges_m, response.range_gains) ||
      !is_table(response.cos_incidences, response.incidence_gains) ||
      response.ranges_m.empty() != response.cos_incidences.empty())
    throw data_error({path, {}, {}},
                     "the intensity response in the comments must be tables of at least two "
                     "ascending nodes with one gain each");
  return response;
}

/// The splats of a file; Gaussians of other programs with a comment on where they come from.
Table read_splats(const std::filesystem::path& path) {
  Table table;
  const char* source = "Gaussians (PLY, axes as in the file)";
  if (is_gltf(path)) {
    table = read_gltf_splats(path);
    source = "Gaussians (glTF, y up turned to z up)";
  } else if (is_spz(path)) {
    table = read_spz(path);
    source = "Gaussians (SPZ, y up turned to z up)";
  } else {
    table = read_ply(path);
  }
  const bool is_ours = table.find("radius") != nullptr;
  table = disks_of_gaussians(path, std::move(table));
  if (!is_ours && comment_value(table, kMethodComment).empty())
    table.comments.push_back(std::string(kMethodComment) + source);
  return table;
}

}  // namespace

std::pair<Vec3f, Vec3f> bounds(const SplatModel& model) {
  if (model.disks.empty()) return {};
  Vec3f low = model.disks[0].center, high = low;
  for (const Disk& disk : model.disks) {
    const Vec3f half = disk_half_extent(disk);
    low = min(low, disk.center - half);
    high = max(high, disk.center + half);
  }
  return {low, high};
}

std::vector<Disk> opaque_disks(const SplatModel& model) {
  constexpr float kOpaque = 0.3F;
  std::vector<Disk> disks = model.disks;
  for (std::size_t i = 0; i < model.opacities.size(); ++i)
    disks[i].radius = opaque_radius(disks[i], model.opacities[i], kOpaque);
  return disks;
}

SplatModel opaque(SplatModel model) {
  if (model.opacities.empty()) return model;
  model.disks = opaque_disks(model);
  model.opacities.clear();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < model.size(); ++i)
    if (model.disks[i].radius > 0) kept.push_back(i);
  const auto keep = [&kept](auto& values) {
    if (values.empty()) return;
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  keep(model.disks);
  keep(model.classes);
  keep(model.groups);
  keep(model.intensities);
  keep(model.drop_log_odds);
  keep(model.colors);
  return model;
}

std::vector<std::string> comments_of(const SplatModel& model) {
  std::vector<std::string> comments = {std::string(kSplatsComment) + "1"};
  if (!model.method.empty()) comments.push_back(kMethodComment + model.method);
  if (!model.label_scheme.empty())
    comments.push_back(std::string(kLabelsComment) + model.label_scheme);
  if (!model.network_sha256.empty()) comments.push_back(kNetworkComment + model.network_sha256);
  for (std::string& comment : crs_comments(model.crs)) comments.push_back(std::move(comment));
  add_response_comments(model.response, comments);
  add_calibration_comments(model.calibration, comments);
  return comments;
}

void save_model(const std::filesystem::path& path, const SplatModel& model) {
  const bool far = !(model.origin == Vec3d{});
  std::vector<Vec3d> centers;
  if (far)
    for (const Disk& disk : model.disks)
      centers.push_back(model.origin + vec_cast<double>(disk.center));
  std::vector<ColumnView> columns;
  const Disk* disks = model.disks.data();
  const auto add_axis = [&](const char* name, const float* local, const double* world) {
    if (far)
      columns.push_back({name, ColumnType::f64, world, sizeof(Vec3d)});
    else
      columns.push_back({name, ColumnType::f32, local, sizeof(Disk)});
  };
  const Disk none{};
  const Vec3d nowhere{};
  const Disk* d = model.disks.empty() ? &none : disks;
  const Vec3d* c = centers.empty() ? &nowhere : centers.data();
  add_axis("x", &d->center.x, &c->x);
  add_axis("y", &d->center.y, &c->y);
  add_axis("z", &d->center.z, &c->z);
  columns.push_back({"nx", ColumnType::f32, &d->normal.x, sizeof(Disk)});
  columns.push_back({"ny", ColumnType::f32, &d->normal.y, sizeof(Disk)});
  columns.push_back({"nz", ColumnType::f32, &d->normal.z, sizeof(Disk)});
  columns.push_back({"radius", ColumnType::f32, &d->radius, sizeof(Disk)});
  if (!model.opacities.empty())
    columns.push_back({"opacity", ColumnType::f32, model.opacities.data(), sizeof(float)});
  if (!model.classes.empty())
    columns.push_back({"class", ColumnType::u16, model.classes.data(), sizeof(std::uint16_t)});
  if (!model.groups.empty())
    columns.push_back({"group", ColumnType::u8, model.groups.data(), sizeof(SemanticGroup)});
  if (!model.intensities.empty())
    columns.push_back({"intensity", ColumnType::f32, model.intensities.data(), sizeof(float)});
  if (!model.drop_log_odds.empty())
    columns.push_back({"drop", ColumnType::f32, model.drop_log_odds.data(), sizeof(float)});
  if (!model.colors.empty())
    for (std::size_t k = 0; k < kRgbColumns.size(); ++k)
      columns.push_back({kRgbColumns[k], ColumnType::u8, &model.colors[0][k], sizeof(ColorBytes)});
  write_ply(path, model.size(), columns, comments_of(model));
}

SplatModel load_model(const std::filesystem::path& path) {
  const Table table = read_splats(path);
  require_version_1(table, kSplatsComment, path);
  const std::array<const Column*, 3> position = {
      &required(table, path, "x"), &required(table, path, "y"), &required(table, path, "z")};
  const std::array<const Column*, 3> normal = {
      &required(table, path, "nx"), &required(table, path, "ny"), &required(table, path, "nz")};
  const Column& radius = required(table, path, "radius");
  SplatModel model;
  model.crs = table.crs;
  const auto [low, high] = extent_of(position, table.rows);
  if (!is_finite(low) || !is_finite(high))
    throw data_error({path, {}, {}}, "the center of a splat is not finite");
  model.origin = choose_origin(low, high);
  model.disks.reserve(table.rows);
  const auto vec = [](const std::array<const Column*, 3>& columns, std::size_t i) {
    return Vec3d{columns[0]->as_double(i), columns[1]->as_double(i), columns[2]->as_double(i)};
  };
  for (std::size_t i = 0; i < table.rows; ++i)
    model.disks.push_back(checked_disk(path, i, vec(position, i) - model.origin, vec(normal, i),
                                       radius.as_double(i)));
  if (const Column* opacities = table.find("opacity"))
    model.opacities = numbers_within(path, *opacities, table.rows, 0, 1);
  if (const Column* classes = table.find("class"))
    model.classes = whole_numbers<std::uint16_t>(path, *classes, table.rows, 0xffff);
  if (const Column* groups = table.find("group"))
    model.groups = whole_numbers<SemanticGroup>(path, *groups, table.rows, kSemanticGroups - 1);
  if (const Column* intensities = table.find("intensity"))
    for (std::size_t i = 0; i < table.rows; ++i)
      model.intensities.push_back(static_cast<float>(intensities->as_double(i)));
  if (const Column* drops = table.find("drop"))
    model.drop_log_odds = numbers_within(path, *drops, table.rows, -kMostDrop, kMostDrop);
  model.colors = color_bytes(table.columns, table.rows);
  model.method = comment_value(table, kMethodComment);
  model.label_scheme = comment_value(table, kLabelsComment);
  model.network_sha256 = comment_value(table, kNetworkComment);
  model.response = response_of(table, path);
  model.calibration = calibration_of_comments(table.comments, path);
  return model;
}

}  // namespace adasplats
