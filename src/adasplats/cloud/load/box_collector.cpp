// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/box_collector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/core/error.h"

namespace adasplats {

bool moves_by_boxes(const BoxTrack& track) {
  constexpr double kMinWay_m = 1, kMinSpeed_m_s = 0.5;
  for (auto last = track.boxes.begin(); last != track.boxes.end(); ++last) {
    for (auto first = track.boxes.begin(); first != last; ++first) {
      const double way_m = length(last->middle - first->middle);
      if (way_m > kMinWay_m && way_m > kMinSpeed_m_s * (last->time_s - first->time_s)) return true;
    }
  }
  return false;
}

std::uint64_t BoxCollector::number_of(const std::string& identifier) {
  return numbers_.emplace(identifier, numbers_.size() + 1).first->second;
}

void BoxCollector::add_time(double time_s) {
  const bool is_first = end_s_ < begin_s_;
  begin_s_ = is_first ? time_s : std::min(begin_s_, time_s);
  end_s_ = is_first ? time_s : std::max(end_s_, time_s);
}

void BoxCollector::add(std::uint64_t id, const std::string& label, const TimedBox& box,
                       std::optional<bool> moves, FunctionRef<std::string()> place) {
  const auto fault = [&](const std::string& what) {
    return Error(ErrorKind::data, place() + what);
  };
  if (!std::isfinite(box.time_s) || !std::isfinite(box.yaw_rad) || !is_valid_position(box.middle))
    throw fault("the time, position or yaw of the box is not finite, or beyond 1e12 m");
  const Vec3d size = box.half_size;
  if (!(std::min({size.x, size.y, size.z}) > 0) || !is_valid_position(size))
    throw fault("the size of the box is not positive and finite");
  Object& object = objects_[id];
  object.label = label;
  if (moves) object.moves = object.moves.value_or(false) || *moves;
  if (!object.boxes.emplace(box.time_s, box).second)
    throw fault("object " + std::to_string(id) + " has two boxes at " + std::to_string(box.time_s) +
                " s");
  add_time(box.time_s);
}

std::size_t BoxCollector::remove_twins() {
  struct Entry {
    std::uint64_t id;
    const TimedBox* box;
  };
  std::map<double, std::vector<Entry>> by_time;
  for (const auto& [id, object] : objects_)
    for (const auto& [time_s, box] : object.boxes) by_time[time_s].push_back({id, &box});
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::size_t> counts;  // smaller id first
  for (auto& [time_s, entries] : by_time) {
    std::ranges::sort(entries, {}, [](const Entry& entry) { return entry.box->middle.x; });
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const TimedBox& a = *entries[i].box;
      for (std::size_t j = i + 1; j < entries.size(); ++j) {
        const TimedBox& b = *entries[j].box;
        if (b.middle.x - a.middle.x > length(a.half_size)) break;
        if (a.contains(b.middle, 0) && b.contains(a.middle, 0))
          ++counts[std::minmax(entries[i].id, entries[j].id)];
      }
    }
  }
  std::set<std::uint64_t> twins;
  for (const auto& [pair, count] : counts) {
    const auto &a = objects_.at(pair.first).boxes, &b = objects_.at(pair.second).boxes;
    constexpr double kApart_m = 2;
    std::size_t common = 0;
    double apart_m = 0;
    for (const auto& [time_s, box] : a) {
      const auto other = b.find(time_s);
      if (other == b.end()) continue;
      ++common;
      apart_m = std::max(apart_m, length(box.middle - other->second.middle));
    }
    if (2 * count >= common && apart_m < kApart_m && !twins.contains(pair.first) &&
        !twins.contains(pair.second))
      twins.insert(b.size() > a.size() ? pair.first : pair.second);
  }
  for (const std::uint64_t id : twins) objects_.erase(id);
  return twins.size();
}

BoxContent BoxCollector::take(bool are_of_scans) {
  if (end_s_ < begin_s_) throw Error(ErrorKind::data, file_.string() + ": has no boxes");
  BoxContent content{{}, begin_s_, end_s_, are_of_scans};
  content.twins = remove_twins();
  for (auto& [id, object] : objects_) {
    BoxTrack track{id, std::move(object.label), {}};
    for (const auto& [time_s, box] : object.boxes) track.boxes.push_back(box);
    if (object.moves ? *object.moves : moves_by_boxes(track))
      content.moving.push_back(std::move(track));
    else
      content.at_rest.push_back(
          {id, std::move(track.label), {track.boxes[track.boxes.size() / 2]}, true});
  }
  if (objects_.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error(ErrorKind::data, file_.string() + ": has " + std::to_string(objects_.size()) +
                                     " objects, more than 65,535");
  return content;
}

}  // namespace adasplats
