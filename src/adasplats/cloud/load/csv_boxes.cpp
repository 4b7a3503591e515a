// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::array<std::string_view, 10> kBoxColumns = {
    "time", "id", "stationary", "x", "y", "z", "size_x", "size_y", "size_z", "yaw"};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) {
    while (!cell.empty() && (cell.back() == '\r' || cell.back() == ' ')) cell.pop_back();
    cells.push_back(cell);
  }
  return cells;
}

using BoxNumbers = std::array<double, kBoxColumns.size()>;
using BoxPlaces = std::array<std::size_t, kBoxColumns.size()>;

/// The columns of the first line.
BoxPlaces places_of_columns(const std::filesystem::path& file,
                            const std::vector<std::string>& names) {
  BoxPlaces places{};
  for (std::size_t k = 0; k < kBoxColumns.size(); ++k) {
    places[k] = static_cast<std::size_t>(std::ranges::find(names, kBoxColumns[k]) - names.begin());
    if (places[k] == names.size())
      throw Error(ErrorKind::data,
                  file.string() + ": has no column '" + std::string(kBoxColumns[k]) +
                      "' (expected time, id, stationary, x, y, z, size_x, size_y, size_z, yaw)");
  }
  return places;
}

/// The numbers of a row; `here` begins messages.
BoxNumbers numbers_of_box(const std::vector<std::string>& cells, const BoxPlaces& places,
                          const std::string& here) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  BoxNumbers v{};
  v.fill(kNone);
  for (std::size_t k = 0; k < kBoxColumns.size(); ++k) {
    if (places[k] < cells.size()) v[k] = parse_number<double>(cells[places[k]]).value_or(kNone);
    if (!std::isfinite(v[k]))
      throw Error(ErrorKind::data,
                  here + "column '" + std::string(kBoxColumns[k]) + "' is not a finite number");
  }
  if (v[1] < 0 || v[1] > 9e15 || v[1] != std::floor(v[1]))
    throw Error(ErrorKind::data, here + "column 'id' is not a whole number from 0");
  if (!(std::min({v[6], v[7], v[8]}) > 0))
    throw Error(ErrorKind::data, here + "the size of the box is not positive");
  constexpr double kMaxYaw_rad = 4 * std::numbers::pi;  // two turns
  if (std::fabs(v[9]) > kMaxYaw_rad)
    throw Error(ErrorKind::data,
                here + "column 'yaw' is more than two turns; it must be in radians");
  return v;
}

}  // namespace

BoxContent read_csv_boxes(const std::filesystem::path& path) {
  std::istringstream file(read_file(path));
  std::string line;
  if (!std::getline(file, line)) throw Error(ErrorKind::no_input, path.string() + ": is empty");
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
  const std::vector<std::string> names = cells_of(line);
  const BoxPlaces places = places_of_columns(path, names);
  const auto label_at = static_cast<std::size_t>(std::ranges::find(names, "label") - names.begin());
  BoxCollector boxes(path);
  for (std::size_t row = 2; std::getline(file, line); ++row) {
    if (line.empty()) continue;
    const std::vector<std::string> cells = cells_of(line);
    const std::string here = path.string() + ":" + std::to_string(row) + ": ";
    const BoxNumbers v = numbers_of_box(cells, places, here);
    boxes.add(static_cast<std::uint64_t>(v[1]), label_at < cells.size() ? cells[label_at] : "",
              {v[0], {v[3], v[4], v[5]}, {v[6] / 2, v[7] / 2, v[8] / 2}, v[9]}, v[2] == 0,
              [&] { return std::string(here); });
  }
  return boxes.take(false);
}

}  // namespace adasplats
