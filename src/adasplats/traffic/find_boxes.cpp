// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/find_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace adasplats {
namespace {

constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

std::size_t points_of(const ClusterTrack& track) {
  std::size_t count = 0;
  for (const Cluster& cluster : track) count += cluster.points.size();
  return count;
}

/// The share of loose points in the boxes of an object; 0 without points.
double loose_share(const BoxTrack& track, const ClusterTrack& clusters,
                   std::span<const LoosePoints> loose) {
  constexpr double kGround_m = 0.3;
  double loose_points = 0, firm_points = 0;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const LoosePoints& scan = loose[clusters[k].scan];
    const TimedBox& box = track.boxes[k];
    for (const std::uint32_t i : clusters[k].points)
      loose_points += box.contains(scan.points[i], 0, kGround_m) ? 1 : 0;
    for (const Vec3f& point : scan.firm)
      firm_points += box.contains(scan.sensor + vec_cast<double>(point), 0, kGround_m) ? 1 : 0;
  }
  firm_points *= LoosePoints::kFirmEvery;
  return loose_points > 0 ? loose_points / (loose_points + firm_points) : 0;
}

/// Whether a box has the height of a person or of a vehicle.
bool has_usual_height(const BoxTrack& track) {
  const double height_m = 2 * track.boxes.front().half_size.z;
  return height_m <= (track.label == "truck" ? 4.5 : 2.6);
}

/// The motion at the first or last boxes of a track, m/s.
Vec3d velocity_at_end(const BoxTrack& track, bool first) {
  constexpr std::size_t kBoxes = 4;
  const std::size_t count = std::min(kBoxes, track.boxes.size());
  const TimedBox& a = track.boxes[first ? 0 : track.boxes.size() - count];
  const TimedBox& b = track.boxes[first ? count - 1 : track.boxes.size() - 1];
  return (1 / (b.time_s - a.time_s)) * (b.middle - a.middle);
}

/// The box of a track at a time, beyond its ends in uniform motion.
TimedBox extrapolated(const BoxTrack& track, double time_s) {
  TimedBox box = track.at(time_s);
  const double before_s = track.boxes.front().time_s - time_s;
  const double behind_s = time_s - track.boxes.back().time_s;
  if (before_s > 0) box.middle = box.middle - before_s * velocity_at_end(track, true);
  if (behind_s > 0) box.middle = box.middle + behind_s * velocity_at_end(track, false);
  return box;
}

/// Whether a track goes on with another one, or both are parts of one object: where the second one
/// begins or ends, it is in the first one's box and moves like it.
bool is_same_object(const BoxTrack& a, const BoxTrack& b, const ClusterTrack& clusters_of_b,
                    double margin_m) {
  constexpr double kGap_s = 1.5, kDrift_mps = 0.8, kSlower_mps = 3;
  for (const bool first : {true, false}) {
    const Cluster& cluster = first ? clusters_of_b.front() : clusters_of_b.back();
    const double gap_s = std::max(
        {0.0, a.boxes.front().time_s - cluster.time_s, cluster.time_s - a.boxes.back().time_s});
    if (gap_s > kGap_s) continue;
    const bool at_first = cluster.time_s < 0.5 * (a.boxes.front().time_s + a.boxes.back().time_s);
    if (length(velocity_at_end(a, at_first) - velocity_at_end(b, first)) < kSlower_mps &&
        extrapolated(a, cluster.time_s).contains(cluster.middle, margin_m + kDrift_mps * gap_s))
      return true;
  }
  return false;
}

/// Which track every cluster belongs to.
class Owners {
 public:
  Owners(std::span<const LoosePoints> loose, std::vector<std::vector<Cluster>> clusters,
         std::size_t tracks)
      : loose_(loose), clusters_(std::move(clusters)), members_(tracks) {
    for (const std::vector<Cluster>& of_scan : clusters_) {
      owners_.emplace_back(of_scan.size(), kNobody);
      TimeSpan& span = spans_.emplace_back();
      for (const Cluster& cluster : of_scan) {
        span.begin_s = std::min(span.begin_s, cluster.time_s);
        span.end_s = std::max(span.end_s, cluster.time_s);
      }
    }
  }

  /// The clusters that begin with the same point as those of the track.
  void set(const ClusterTrack& track, std::size_t owner) {
    for (const Cluster& cluster : track)
      for (std::size_t k = 0; k < clusters_[cluster.scan].size(); ++k)
        if (clusters_[cluster.scan][k].points.front() == cluster.points.front())
          give({cluster.scan, k}, owner);
  }

  /// Changes from now on can be undone.
  void begin_changes() { changes_.clear(); }
  void undo_changes() {
    while (!changes_.empty()) {
      const auto [place, before] = changes_.back();
      changes_.pop_back();
      move(place, before);
    }
  }

  /// Gives all clusters of one track to another.
  void join(std::size_t from, std::size_t to) {
    const std::set<Place> places = members_[from];
    for (const Place& place : places) give(place, to);
  }

  /// Gives an object all clusters in its boxes that are nobody's or of one with a larger number.
  void absorb(const BoxTrack& boxes, std::size_t owner, double margin_m) {
    constexpr double kReach_s = 0.01;
    const double begin_s = boxes.boxes.front().time_s - kReach_s;
    const double end_s = boxes.boxes.back().time_s + kReach_s;
    for (std::size_t scan = 0; scan < clusters_.size(); ++scan) {
      if (spans_[scan].end_s < begin_s || spans_[scan].begin_s > end_s) continue;
      for (std::size_t k = 0; k < clusters_[scan].size(); ++k) {
        const Cluster& cluster = clusters_[scan][k];
        if (owners_[scan][k] <= owner || cluster.time_s < begin_s || cluster.time_s > end_s)
          continue;
        if (boxes.at(cluster.time_s).contains(cluster.middle, margin_m)) give({scan, k}, owner);
      }
    }
  }

  /// The clusters of an object, one per scan.
  ClusterTrack track_of(std::size_t owner) const {
    ClusterTrack track;
    const std::set<Place>& places = members_[owner];
    for (auto place = places.begin(); place != places.end();) {
      const std::size_t scan = place->first;
      std::vector<std::uint32_t> points;
      for (; place != places.end() && place->first == scan; ++place) {
        const std::vector<std::uint32_t>& of_cluster = clusters_[scan][place->second].points;
        points.insert(points.end(), of_cluster.begin(), of_cluster.end());
      }
      std::ranges::sort(points);
      track.push_back(cluster_of(loose_[scan], scan, std::move(points)));
    }
    return track;
  }

 private:
  using Place = std::pair<std::size_t, std::size_t>;  ///< scan, number in it
  struct TimeSpan {
    double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
  };

  void give(Place place, std::size_t owner) {
    changes_.emplace_back(place, owners_[place.first][place.second]);
    move(place, owner);
  }
  void move(Place place, std::size_t owner) {
    std::size_t& now = owners_[place.first][place.second];
    if (now != kNobody) members_[now].erase(place);
    if (owner != kNobody) members_[owner].insert(place);
    now = owner;
  }

  std::span<const LoosePoints> loose_;
  std::vector<std::vector<Cluster>> clusters_;
  std::vector<TimeSpan> spans_;  ///< of the clusters of scans
  std::vector<std::vector<std::size_t>> owners_;
  std::vector<std::set<Place>> members_;                ///< of tracks
  std::vector<std::pair<Place, std::size_t>> changes_;  ///< and their owners before
};

}  // namespace

std::vector<BoxTrack> find_boxes(std::span<const LoosePoints> loose,
                                 FunctionRef<double(Vec3d)> height_below,
                                 const FindBoxesOptions& options, const Executor& executor) {
  std::vector<std::vector<Cluster>> clusters(loose.size());
  executor.for_chunks(loose.size(), 1, [&](std::size_t k, std::size_t) {
    clusters[k] = clusters_of(loose[k], k, options.clusters, executor);
  });
  std::vector<ClusterTrack> tracks = track_clusters(clusters, options.tracks);
  std::ranges::stable_sort(tracks, std::ranges::greater{}, points_of);
  Owners owners(loose, std::move(clusters), tracks.size());
  for (std::size_t t = 0; t < tracks.size(); ++t) owners.set(tracks[t], t);
  const auto fit = [&](std::size_t t) -> std::optional<BoxTrack> {
    const ClusterTrack track = owners.track_of(t);
    if (track.size() < options.tracks.min_scans) return std::nullopt;
    return fit_boxes(track, loose, height_below, options.boxes);
  };
  std::vector<std::optional<BoxTrack>> fits;
  for (std::size_t t = 0; t < tracks.size(); ++t) fits.push_back(fit(t));
  std::vector<BoxTrack> found;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    executor.check_interruption();
    if (fits[t]) fits[t] = fit(t);  // others may have got clusters of it
    for (std::size_t other = t + 1; fits[t] && other < tracks.size(); ++other) {
      if (!fits[other] || !is_same_object(*fits[t], *fits[other], tracks[other], options.margin_m))
        continue;
      owners.begin_changes();
      owners.join(other, t);
      std::optional<BoxTrack> joined = fit(t);
      if (!joined) {
        owners.undo_changes();
        continue;
      }
      fits[t] = std::move(joined);
      fits[other].reset();
      other = t;  // the longer track may go on with others
    }
    if (!fits[t]) continue;
    owners.begin_changes();
    owners.absorb(*fits[t], t, options.margin_m);
    std::optional<BoxTrack> boxes = fit(t);
    if (!boxes || !has_usual_height(*boxes) ||
        loose_share(*boxes, owners.track_of(t), loose) < options.min_loose) {
      owners.undo_changes();
      continue;
    }
    boxes->id = found.size() + 1;
    found.push_back(std::move(*boxes));
  }
  return found;
}

}  // namespace adasplats
