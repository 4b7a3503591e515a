// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/wkt.h"
#include "adasplats/io/e57/e57_content.h"
#include "adasplats/io/e57/e57_points.h"
#include "adasplats/io/e57/e57_section.h"

namespace adasplats {
namespace {

/// The columns of several scans other than coordinates.
struct SharedColumns {
  std::vector<std::string> names;              ///< in the order of the first scan that has them
  std::map<std::string, std::size_t> dropped;  ///< and the number of scans that have them
};

/// Keeps the columns that all scans have, and the intensity, which may be unknown. That also bounds
/// the size of the table, which scans with different columns would multiply.
SharedColumns shared_columns(const std::vector<E57Scan>& scans) {
  std::map<std::string, std::size_t> scans_with;
  std::vector<std::string> order;
  for (const E57Scan& scan : scans)
    for (const E57Field& field : scan.fields)
      if (!field.column.empty() && ++scans_with[field.column] == 1) order.push_back(field.column);
  SharedColumns columns;
  for (std::string& name : order) {
    const std::size_t count = scans_with[name];
    if (count == scans.size() || name == "intensity")
      columns.names.push_back(std::move(name));
    else
      columns.dropped[name] = count;
  }
  return columns;
}

/// Reads the sections and rejects overlapping ones, which would be read repeatedly.
std::vector<E57Section> sections_of(PagedFile& file, const std::vector<E57Scan>& scans) {
  std::vector<E57Section> sections;
  sections.reserve(scans.size());
  for (const E57Scan& scan : scans) sections.push_back(read_e57_section(file, scan));
  std::vector<std::size_t> order(scans.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::sort(order, {}, [&](std::size_t k) { return sections[k].begin; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (sections[order[k]].begin < sections[order[k - 1]].end)
      throw file.error_at(
          sections[order[k]].begin,
          scans[order[k]].name + ": its points overlap those of " + scans[order[k - 1]].name);
  return sections;
}

void append(std::vector<double>& to, std::vector<double>&& from) {
  if (to.empty())
    to = std::move(from);
  else
    to.insert(to.end(), from.begin(), from.end());
}

/// Builds the table scan by scan.
class E57Table {
 public:
  explicit E57Table(SharedColumns columns)
      : columns_(std::move(columns)), values_(6 + columns_.names.size()) {}

  void add(const E57Scan& scan, E57Points&& points) {
    const std::size_t count = points.x.size();
    append(values_[0], std::move(points.x));
    append(values_[1], std::move(points.y));
    append(values_[2], std::move(points.z));
    for (std::size_t k = 0; k < points.columns.size(); ++k)
      append(values_[3 + k], std::move(points.columns[k]));
    has_scanners_ = has_scanners_ || scan.has_scanner;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double position = scan.has_scanner
                                  ? scan.world_from_scanner.translation[static_cast<int>(axis)]
                                  : std::numeric_limits<double>::quiet_NaN();
      auto& values = values_[values_.size() - 3 + axis];
      values.insert(values.end(), count, position);
    }
    without_return_ += points.without_return;
  }

  Table take(std::size_t scans) {
    std::vector<std::string> names = {"x", "y", "z"};
    names.insert(names.end(), columns_.names.begin(), columns_.names.end());
    if (has_scanners_) names.insert(names.end(), {"sensor_x", "sensor_y", "sensor_z"});
    Table table;
    table.rows = values_.front().size();
    for (std::size_t k = 0; k < names.size(); ++k)
      table.columns.push_back(Column{names[k], std::move(values_[k])});
    if (without_return_ > 0)
      table.notes.push_back(
          {NoteKind::no_return, std::to_string(without_return_) + " points without a return"});
    for (const auto& [name, count] : columns_.dropped)
      table.notes.push_back({NoteKind::left_out, "column '" + name + "', which only " +
                                                     std::to_string(count) + " of " +
                                                     std::to_string(scans) + " scans have"});
    return table;
  }

 private:
  SharedColumns columns_;
  std::vector<std::vector<double>> values_;  ///< x, y, z, columns, position of the scanner
  bool has_scanners_ = false;
  std::uint64_t without_return_ = 0;
};

/// Adds the start of the scan to times, which count from it, so that all scans have one clock.
void add_starts(const E57Scan& scan, const std::vector<std::string>& columns, E57Points& points) {
  const auto found = std::ranges::find(columns, "timestamp");
  if (found == columns.end()) return;
  for (double& time_s : points.columns[static_cast<std::size_t>(found - columns.begin())])
    time_s += *scan.start_gps_s;
}

/// Whether all scans with intensities have limits for them.
bool have_intensity_limits(const std::vector<E57Scan>& scans) {
  return std::ranges::all_of(scans, [](const E57Scan& scan) {
    return scan.field("intensity") == nullptr || scan.intensity_limits;
  });
}

/// Scales the intensities of a scan to 0..1 by its limits, so that all scans have one scale.
/// Returns how many exceed the limits by more than a thousandth of the range.
std::size_t scale_intensities(const E57Scan& scan, const std::vector<std::string>& columns,
                              E57Points& points) {
  constexpr double kBeyond = 1e-3;
  const auto found = std::ranges::find(columns, "intensity");
  if (found == columns.end() || !scan.intensity_limits) return 0;
  const auto [minimum, maximum] = *scan.intensity_limits;
  std::size_t beyond = 0;
  for (double& value : points.columns[static_cast<std::size_t>(found - columns.begin())]) {
    value = (value - minimum) / (maximum - minimum);
    if (value < -kBeyond || value > 1 + kBeyond) ++beyond;
  }
  return beyond;
}

/// Notes where intensities are not on one scale from 0 to 1.
void add_intensity_notes(const std::vector<E57Scan>& scans, std::size_t beyond, Table& table) {
  std::size_t with = 0, limited = 0;
  for (const E57Scan& scan : scans) {
    if (scan.field("intensity") == nullptr) continue;
    ++with;
    if (scan.intensity_limits) ++limited;
  }
  if (limited > 0 && limited < with)
    table.notes.push_back({NoteKind::intensity_scale,
                           "intensities are as stored: only " + std::to_string(limited) + " of " +
                               std::to_string(with) + " scans have intensityLimits"});
  if (beyond > 0)
    table.notes.push_back({NoteKind::intensity_scale,
                           std::to_string(beyond) +
                               " intensities exceed the intensityLimits of their scan, and thus "
                               "the range 0 to 1"});
}

void add_content_notes(const E57Content& content, Table& table) {
  if (content.images > 0)
    table.notes.push_back({NoteKind::left_out, std::to_string(content.images) + " images"});
  table.crs = crs_of_wkt(content.coordinate_system);
  if (const auto system = geographic_system_of_wkt(content.coordinate_system))
    table.notes.push_back({NoteKind::geographic, *system});
  if (const auto units = foreign_units_of_wkt(content.coordinate_system))
    table.notes.push_back({NoteKind::not_metres, *units});
}

}  // namespace

Table read_e57(const std::filesystem::path& path) {
  PagedFile file(path);
  E57Content content = read_e57_content(file);
  if (content.scans.empty()) throw data_error({path, {}, {}}, "the file has no scans");
  std::vector<E57Scan> scans = std::move(content.scans);
  std::erase_if(scans, [](const E57Scan& scan) { return scan.points == 0; });
  const std::vector<E57Section> sections = sections_of(file, scans);
  SharedColumns columns = shared_columns(scans);
  const std::vector<std::string> names = columns.names;
  const bool have_starts =
      std::ranges::all_of(scans, [](const E57Scan& scan) { return scan.start_gps_s.has_value(); });
  const bool have_limits = have_intensity_limits(scans);
  std::size_t beyond = 0;
  E57Table gathered(std::move(columns));
  for (std::size_t k = 0; k < scans.size(); ++k) {
    E57Points points = read_e57_points(file, scans[k], sections[k], names);
    if (have_starts) add_starts(scans[k], names, points);
    if (have_limits) beyond += scale_intensities(scans[k], names, points);
    gathered.add(scans[k], std::move(points));
  }
  Table table = gathered.take(scans.size());
  add_content_notes(content, table);
  add_intensity_notes(scans, beyond, table);
  return table;
}

Crs read_e57_crs(const std::filesystem::path& path) {
  PagedFile file(path);
  return crs_of_wkt(read_e57_content(file).coordinate_system);
}

}  // namespace adasplats
