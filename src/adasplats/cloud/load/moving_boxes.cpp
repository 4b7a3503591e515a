// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/moving_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
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

using BoxNumbers = std::array<double, kBoxColumns.size()>;

/// The numbers of a row; `here` begins messages.
BoxNumbers numbers_of(const std::vector<std::string>& cells,
                      const std::array<std::size_t, kBoxColumns.size()>& places,
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
  return v;
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
  const auto label_at = static_cast<std::size_t>(std::ranges::find(names, "label") - names.begin());
  std::map<double, BoxTrack> tracks;
  for (std::size_t row = 2; std::getline(file, line); ++row) {
    if (line.empty()) continue;
    const std::vector<std::string> cells = cells_of(line);
    const std::string here = path.string() + ":" + std::to_string(row) + ": ";
    const BoxNumbers v = numbers_of(cells, places, here);
    const bool is_first = end_s_ < begin_s_;
    begin_s_ = is_first ? v[0] : std::min(begin_s_, v[0]);
    end_s_ = is_first ? v[0] : std::max(end_s_, v[0]);
    if (v[2] != 0) continue;
    BoxTrack& track = tracks[v[1]];
    if (label_at < cells.size()) track.label = cells[label_at];
    track.boxes.push_back({v[0], {v[3], v[4], v[5]}, {v[6] / 2, v[7] / 2, v[8] / 2}, v[9]});
  }
  if (tracks.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error(ErrorKind::data, path.string() + ": has " + std::to_string(tracks.size()) +
                                     " moving objects, more than 65,535");
  for (auto& [id, track] : tracks) {
    track.id = static_cast<std::uint64_t>(id);
    std::ranges::stable_sort(track.boxes, {}, &TimedBox::time_s);
    const auto same = std::ranges::adjacent_find(track.boxes, {}, &TimedBox::time_s);
    if (same != track.boxes.end())
      throw Error(ErrorKind::data, path.string() + ": object " + std::to_string(track.id) +
                                       " has two boxes at " + std::to_string(same->time_s) + " s");
    tracks_.push_back(std::move(track));
  }
}

MovingBoxes::MovingBoxes(std::vector<BoxTrack> tracks) : tracks_(std::move(tracks)) {
  for (const BoxTrack& track : tracks_) {
    const bool is_first = end_s_ < begin_s_;
    const double begin_s = track.boxes.front().time_s, end_s = track.boxes.back().time_s;
    begin_s_ = is_first ? begin_s : std::min(begin_s_, begin_s);
    end_s_ = is_first ? end_s : std::max(end_s_, end_s);
  }
}

TimedBox BoxTrack::at(double time_s) const {
  const auto after = std::ranges::upper_bound(boxes, time_s, {}, &TimedBox::time_s);
  const TimedBox& b = after == boxes.end() ? boxes.back() : *after;
  const TimedBox& a = after == boxes.begin() ? b : *(after - 1);
  const double share =
      b.time_s > a.time_s ? std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0) : 0;
  return {time_s, a.middle + share * (b.middle - a.middle), a.half_size,
          a.yaw_rad + share * turned_by(a.yaw_rad, b.yaw_rad)};
}

std::uint16_t MovingBoxes::object_at(double time_s, Vec3d point) const {
  std::uint16_t object = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const std::vector<TimedBox>& boxes = tracks_[k].boxes;
    const double apart_s = boxes.size() > 1 ? boxes[1].time_s - boxes[0].time_s : 0.1;
    if (time_s < boxes.front().time_s - apart_s || time_s > boxes.back().time_s + apart_s) continue;
    const TimedBox box = tracks_[k].at(time_s);
    const Vec3d from_middle = point - box.middle;
    const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
    const Vec3d in_box = {c * from_middle.x + s * from_middle.y,
                          -s * from_middle.x + c * from_middle.y, from_middle.z};
    if (std::fabs(in_box.x) > box.half_size.x + kMargin_m ||
        std::fabs(in_box.y) > box.half_size.y + kMargin_m ||
        std::fabs(in_box.z) > box.half_size.z + kMargin_m)
      continue;
    const double away_m = length(from_middle);
    if (away_m < least_m) {
      least_m = away_m;
      object = static_cast<std::uint16_t>(k + 1);
    }
  }
  return object;
}

std::vector<std::uint16_t> MovingBoxes::objects_in(const KittiSequence& drive, std::size_t index,
                                                   const KittiScan& scan,
                                                   const Executor& executor) const {
  const TimedPose& pose = drive.trajectory[index];
  std::vector<std::uint16_t> objects(scan.positions.size());
  executor.for_chunks(objects.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      objects[i] = object_at(scan.times_s.empty() ? pose.time_s : scan.times_s[i],
                             pose.world_from_sensor * beam_of(drive, index, scan, i).end);
  });
  return objects;
}

}  // namespace adasplats
