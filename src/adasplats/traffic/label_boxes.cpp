// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/label_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/function_ref.h"
#include "adasplats/traffic/fit_boxes.h"
#include "adasplats/traffic/ground_heights.h"
#include "adasplats/traffic/object_kind.h"
#include "adasplats/traffic/track_clusters.h"

namespace adasplats {
namespace {

/// Class and instance.
using ObjectKey = std::pair<std::uint16_t, std::uint16_t>;

struct ObjectAtRest {
  std::vector<Vec3d> points, sensors;  ///< world coordinates, m
};

/// The label of an object of a class.
std::string label_of(const SemanticClass& of) {
  constexpr std::string_view kMoving = "moving-";
  return of.name.starts_with(kMoving) ? of.name.substr(kMoving.size()) : of.name;
}

/// One point per cube of 5 cm: near scans do not outweigh far ones.
std::vector<Vec3d> thinned(const std::vector<Vec3d>& points) {
  constexpr double kCube_m = 0.05;
  std::set<std::array<std::int64_t, 3>> cubes;
  std::vector<Vec3d> kept;
  for (const Vec3d& p : points)
    if (cubes
            .insert({std::llround(p.x / kCube_m), std::llround(p.y / kCube_m),
                     std::llround(p.z / kCube_m)})
            .second)
      kept.push_back(p);
  return kept;
}

/// Collects the labelled points scan by scan.
class Collector {
 public:
  explicit Collector(const LabelScheme& scheme) : scheme_(scheme) {}

  void add(const KittiSequence& drive, std::size_t index, const KittiScan& scan) {
    const TimedPose& pose = drive.trajectory[index];
    LoosePoints& of_scan = loose_.emplace_back();
    of_scan.scan = index;
    of_scan.time_s = pose.time_s;
    of_scan.sensor = pose.world_from_sensor.translation;
    std::map<ObjectKey, std::vector<std::uint32_t>> clusters;
    std::set<ObjectKey> seen;
    for (std::size_t i = 0; i < scan.instances.size(); ++i) {
      const ObjectKey key = {scan.classes[i], scan.instances[i]};
      const SemanticClass* const of = scheme_.find(key.first);
      if (of == nullptr || of->mobility == Mobility::fixed) continue;
      const bool moves = of->mobility == Mobility::moving;
      ++points_;
      if (key.second == 0) continue;
      const Vec3d place = pose.world_from_sensor * beam_of(drive, index, scan, i).end;
      if (!is_finite(place)) continue;
      if (moves) {
        clusters[key].push_back(static_cast<std::uint32_t>(of_scan.points.size()));
        of_scan.points.push_back(place);
        of_scan.times_s.push_back(time_of_point(scan, pose, i));
      } else {
        at_rest_[key].points.push_back(place);
        if (seen.insert(key).second) at_rest_[key].sensors.push_back(of_scan.sensor);
      }
    }
    constexpr std::size_t kMinPoints = 5;
    for (auto& [key, points] : clusters)
      if (points.size() >= kMinPoints)
        tracks_[key].push_back(cluster_of(of_scan, loose_.size() - 1, std::move(points)));
  }

  BoxContent boxes(FunctionRef<double(Vec3d)> height_below) {
    BoxContent content;
    for (const auto& [key, track] : tracks_) {
      constexpr std::size_t kMinScans = 3;
      if (track.size() < kMinScans) continue;
      std::optional<BoxTrack> boxes = fit_boxes(track, loose_, height_below, {});
      if (!boxes) {
        at_rest_[key] = at_rest(track);
        continue;
      }
      for (const Cluster& cluster : track) points_of_objects_ += cluster.points.size();
      boxes->id = key.second;
      boxes->label = label_of(*scheme_.find(key.first));
      content.moving.push_back(std::move(*boxes));
    }
    for (const auto& [key, object] : at_rest_) {
      const std::string label = label_of(*scheme_.find(key.first));
      BoxTrack track{key.second, label, {}, true};
      track.boxes.push_back(fit_box_at_rest(thinned(object.points), object.sensors, label));
      constexpr double kMaxLength_m = 20;
      if (2 * track.boxes.front().half_size.x > kMaxLength_m) continue;
      content.at_rest.push_back(std::move(track));
      points_of_objects_ += object.points.size();
    }
    return content;
  }

  /// Points of moving and movable classes, and those of them in no object of boxes().
  std::size_t points() const { return points_; }
  std::size_t points_of_none() const { return points_ - points_of_objects_; }

 private:
  /// An object of a moving class that hardly moves, such as a person who waits.
  ObjectAtRest at_rest(const ClusterTrack& track) const {
    ObjectAtRest object;
    for (const Cluster& cluster : track) {
      const LoosePoints& of_scan = loose_[cluster.scan];
      for (const std::uint32_t i : cluster.points) object.points.push_back(of_scan.points[i]);
      object.sensors.push_back(of_scan.sensor);
    }
    return object;
  }

  const LabelScheme& scheme_;
  std::vector<LoosePoints> loose_;
  std::map<ObjectKey, ClusterTrack> tracks_;
  std::map<ObjectKey, ObjectAtRest> at_rest_;
  std::size_t points_ = 0, points_of_objects_ = 0;
};

/// Every object gets an id of its own.
void make_unique(BoxContent& content) {
  std::set<std::uint64_t> used;
  for (std::vector<BoxTrack>* const tracks : {&content.moving, &content.at_rest}) {
    for (BoxTrack& track : *tracks)
      if (!used.insert(track.id).second) {
        while (used.contains(track.id)) ++track.id;
        used.insert(track.id);
      }
    std::ranges::sort(*tracks, {}, &BoxTrack::id);
  }
}

}  // namespace

BoxContent boxes_of_labels(const KittiSequence& drive, const LabelScheme& scheme,
                           const Executor& executor, ProgressSink& progress) {
  if (drive.labels.empty() && !drive.reader) return {};
  progress.begin_step("find labelled objects", drive.scans.size());
  Collector collector(scheme);
  GroundHeights ground;
  constexpr std::size_t kAtOnce = 16;
  for (std::size_t begin = 0; begin < drive.scans.size(); begin += kAtOnce) {
    std::vector<KittiScan> scans(std::min(kAtOnce, drive.scans.size() - begin));
    std::vector<ScanHeights> heights(scans.size());
    executor.for_chunks(scans.size(), 1, [&](std::size_t n, std::size_t) {
      scans[n] = read_all_returns(drive, begin + n);
      heights[n] = ScanHeights(drive, begin + n, scans[n]);
    });
    for (std::size_t n = 0; n < scans.size(); ++n) {
      ground.add(heights[n]);
      collector.add(drive, begin + n, scans[n]);
      progress.advance(begin + n + 1);
    }
  }
  BoxContent content = collector.boxes([&](Vec3d point) { return ground.at(point.x, point.y); });
  make_unique(content);
  progress.end_step();
  constexpr std::size_t kWorthALine = 100;  // one in so many
  if (collector.points_of_none() * kWorthALine > collector.points())
    progress.warn(std::to_string(collector.points_of_none()) + " of " +
                  std::to_string(collector.points()) +
                  " points of moving and movable classes are of no object: they have no instance, "
                  "or move and are seen in fewer than 3 scans with 5 points each, or their "
                  "instance extends over more than 20 m");
  return content;
}

}  // namespace adasplats
