// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/frame_tree.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "adasplats/cloud/origins/track.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxFrames = 100;  // in a chain, and in a message; robots have about ten

std::string quoted_frame(const std::string& frame) { return "'" + frame + "'"; }

void require_usable(const FrameEdge& edge) {
  if (!edge.fault.empty()) throw Error(ErrorKind::data, edge.fault);
}

/// One transform of a chain over time.
class EdgeAtTimes {
 public:
  explicit EdgeAtTimes(const FrameEdge& edge) : edge_(edge) {
    if (!edge.is_static) gaps_ = track_of(edge.parent_from_child).gaps;
  }
  /// Nothing outside its poses.
  std::optional<RigidTransform> at(double time_s) const {
    const Trajectory& poses = edge_.parent_from_child;
    if (edge_.is_static) return poses.front().world_from_sensor;
    if (time_s < poses.front().time_s || time_s > poses.back().time_s) return std::nullopt;
    // Gaps begin and end one pose step inside the missing part.
    if (is_in_gap(gaps_, {time_s, time_s})) return std::nullopt;
    return interpolate(poses, time_s);
  }

 private:
  const FrameEdge& edge_;
  std::vector<TimeSpan> gaps_;
};

}  // namespace

void FrameTree::add(FrameEdge edge) {
  const auto found = edges_.find(edge.child);
  if (found != edges_.end() && found->second.parent != edge.parent)
    throw Error(ErrorKind::data, "frame " + quoted_frame(edge.child) + " has two parents, " +
                                     quoted_frame(found->second.parent) + " and " +
                                     quoted_frame(edge.parent));
  // A transform that changes over time replaces a static one of the same frames.
  if (found == edges_.end() || (found->second.is_static && !edge.is_static))
    edges_.insert_or_assign(edge.child, std::move(edge));
}

bool FrameTree::has(const std::string& frame) const {
  return std::ranges::any_of(edges_, [&](const auto& entry) {
    return entry.first == frame || entry.second.parent == frame;
  });
}

std::string FrameTree::frame_names() const {
  std::set<std::string> names;
  for (const auto& [child, edge] : edges_) {
    names.insert(child);
    names.insert(edge.parent);
  }
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (++count > kMaxFrames) return text + " and more";
    text += (text.empty() ? "" : ", ") + quoted_frame(name);
  }
  return text.empty() ? "none" : text;
}

std::vector<const FrameEdge*> FrameTree::way_up(const std::string& frame) const {
  std::vector<const FrameEdge*> way;
  for (auto edge = edges_.find(frame); edge != edges_.end();
       edge = edges_.find(edge->second.parent)) {
    way.push_back(&edge->second);
    if (way.size() > kMaxFrames && edges_.size() > kMaxFrames)
      throw Error(ErrorKind::data, "frame " + quoted_frame(frame) + " is more than " +
                                       std::to_string(kMaxFrames) + " transforms below its root");
    if (way.size() > edges_.size())
      throw Error(ErrorKind::data, "the transforms of frame " + quoted_frame(frame) +
                                       " form a cycle (frames: " + frame_names() + ")");
  }
  return way;
}

std::string FrameTree::root_of(const std::string& frame) const {
  const auto way = way_up(frame);
  return way.empty() ? frame : way.back()->parent;
}

bool FrameTree::moves(const std::string& frame) const {
  return std::ranges::any_of(way_up(frame), [](const FrameEdge* edge) { return !edge->is_static; });
}

Trajectory FrameTree::poses_of(const std::string& frame) const {
  const auto way = way_up(frame);
  std::vector<double> times_s;
  std::vector<EdgeAtTimes> edges;
  for (const FrameEdge* edge : way) {
    require_usable(*edge);
    edges.emplace_back(*edge);
    if (edge->is_static) continue;
    for (const TimedPose& pose : edge->parent_from_child) times_s.push_back(pose.time_s);
  }
  std::ranges::sort(times_s);
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  Trajectory poses;
  for (const double time_s : times_s) {
    std::optional<RigidTransform> pose = RigidTransform{};
    for (const EdgeAtTimes& edge : edges) {
      const auto above = edge.at(time_s);
      if (!above) pose.reset();
      if (!pose) break;
      pose = *above * *pose;
    }
    if (pose) poses.push_back({time_s, *pose});
  }
  if (poses.empty())
    throw Error(ErrorKind::data, "the transforms between frame " + quoted_frame(frame) + " and " +
                                     quoted_frame(root_of(frame)) + " have no time in common");
  return poses;
}

RigidTransform FrameTree::fixed_between(const std::string& from, const std::string& to) const {
  if (from == to) return {};
  const auto up_from = way_up(from), up_to = way_up(to);
  if (root_of(from) != root_of(to))
    throw Error(ErrorKind::data, "no transforms connect frame " + quoted_frame(from) +
                                     " and frame " + quoted_frame(to) +
                                     " (frames: " + frame_names() + ")");
  // Above the lowest common frame the two chains are the same.
  std::size_t common = 0;
  while (common < up_from.size() && common < up_to.size() &&
         up_from[up_from.size() - 1 - common] == up_to[up_to.size() - 1 - common])
    ++common;
  const auto along = [&](const std::vector<const FrameEdge*>& way) {
    RigidTransform above_from_frame;
    for (std::size_t k = 0; k + common < way.size(); ++k) {
      require_usable(*way[k]);
      if (!way[k]->is_static)
        throw Error(ErrorKind::data, "frame " + quoted_frame(way[k]->child) + " moves in " +
                                         quoted_frame(way[k]->parent) + ", so frame " +
                                         quoted_frame(to) + " is not fixed in " +
                                         quoted_frame(from));
      above_from_frame = way[k]->parent_from_child.front().world_from_sensor * above_from_frame;
    }
    return above_from_frame;
  };
  return along(up_from).inverse() * along(up_to);
}

}  // namespace adasplats
