// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/moving_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr double kMargin_m = 0.2;
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

double turned_by(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

}  // namespace

MovingBoxes::MovingBoxes(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line))
    throw Error(ErrorKind::no_input, path.string() + ": cannot be read, or is empty");
  const std::vector<std::string> names = cells_of(line);
  std::array<std::size_t, kBoxColumns.size()> places{};
  for (std::size_t k = 0; k < kBoxColumns.size(); ++k) {
    places[k] = static_cast<std::size_t>(std::ranges::find(names, kBoxColumns[k]) - names.begin());
    if (places[k] == names.size())
      throw Error(ErrorKind::data, path.string() + ": has no column '" +
                                       std::string(kBoxColumns[k]) +
                                       "' (expected time, id, stationary, x, y, z, size_x, "
                                       "size_y, size_z, yaw)");
  }
  std::map<double, Track> tracks;
  for (std::size_t row = 2; std::getline(file, line); ++row) {
    if (line.empty()) continue;
    const std::vector<std::string> cells = cells_of(line);
    std::array<double, kBoxColumns.size()> v{};
    for (std::size_t k = 0; k < kBoxColumns.size(); ++k) {
      const auto value = places[k] < cells.size() ? parse_number<double>(cells[places[k]])
                                                  : std::optional<double>();
      if (!value || !std::isfinite(*value))
        throw Error(ErrorKind::data, path.string() + ":" + std::to_string(row) + ": column '" +
                                         std::string(kBoxColumns[k]) + "' is not a finite number");
      v[k] = *value;
    }
    const bool is_first = end_s_ < begin_s_;
    begin_s_ = is_first ? v[0] : std::min(begin_s_, v[0]);
    end_s_ = is_first ? v[0] : std::max(end_s_, v[0]);
    if (v[2] != 0) continue;
    tracks[v[1]].push_back({v[0], {v[3], v[4], v[5]}, {v[6] / 2, v[7] / 2, v[8] / 2}, v[9]});
  }
  for (auto& [id, track] : tracks) {
    std::ranges::stable_sort(track, {}, &Box::time_s);
    tracks_.push_back(std::move(track));
  }
}

bool MovingBoxes::contains(double time_s, Vec3d point) const {
  for (const Track& track : tracks_) {
    const double apart_s = track.size() > 1 ? track[1].time_s - track[0].time_s : 0.1;
    if (time_s < track.front().time_s - apart_s || time_s > track.back().time_s + apart_s) continue;
    const auto after = std::ranges::upper_bound(track, time_s, {}, &Box::time_s);
    const Box& b = after == track.end() ? track.back() : *after;
    const Box& a = after == track.begin() ? b : *(after - 1);
    const double share =
        b.time_s > a.time_s ? std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0) : 0;
    const Vec3d from_middle = point - (a.middle + share * (b.middle - a.middle));
    const double yaw_rad = a.yaw_rad + share * turned_by(a.yaw_rad, b.yaw_rad);
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    const Vec3d in_box = {c * from_middle.x + s * from_middle.y,
                          -s * from_middle.x + c * from_middle.y, from_middle.z};
    if (std::fabs(in_box.x) <= a.half_size.x + kMargin_m &&
        std::fabs(in_box.y) <= a.half_size.y + kMargin_m &&
        std::fabs(in_box.z) <= a.half_size.z + kMargin_m)
      return true;
  }
  return false;
}

}  // namespace adasplats
