// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/loose_points.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace adasplats {
namespace {

/// What scans say about a point.
struct Votes {
  std::uint8_t free = 0, occupied = 0;

  void add(Seen seen) {
    if (seen == Seen::free) ++free;
    if (seen == Seen::occupied) ++occupied;
  }
  bool is_loose(std::size_t min_free) const { return free >= min_free && free >= occupied; }
  /// Whether `left` more votes cannot change is_loose() and, if `is_firm_asked` of a point that is
  /// not loose, whether any scan saw it occupied.
  bool are_clear(std::size_t left, std::size_t min_free, bool is_firm_asked) const {
    if (is_loose(min_free)) return free >= occupied + left;
    const bool is_never_loose = free + left < min_free || free + left < occupied;
    return is_never_loose && (!is_firm_asked || occupied > 0);
  }
};

struct AskedPoint {
  std::size_t number;
  Vec3d place;
};

/// Of points in range: neighbours in the image of the sensor get keys close to each other, so that
/// what other scans saw near them is in the cache.
std::uint64_t order_key(Vec3f point) {
  constexpr double kTurn = 2 * std::numbers::pi, kColumns = 1024, kRows = 4096;
  const Vec3d at = vec_cast<double>(point);
  const double turn = std::atan2(at.y, at.x) / kTurn + 0.5;
  const double up = 0.5 * at.z / length(at) + 0.5;
  return (static_cast<std::uint64_t>(turn * kColumns) << 32) |
         static_cast<std::uint64_t>(up * kRows);
}

/// Asks the scans one after the other, each about all points whose votes are not clear yet.
void count_votes(std::vector<AskedPoint> points, std::span<const SeenSpace* const> others,
                 std::size_t min_free, std::vector<Votes>& votes) {
  std::size_t left = others.size();
  for (const SeenSpace* other : others) {
    --left;
    std::erase_if(points, [&](const AskedPoint& point) {
      Votes& of_point = votes[point.number];
      of_point.add(other->at(point.place));
      return of_point.are_clear(left, min_free, point.number % LoosePoints::kFirmEvery == 0);
    });
  }
}

}  // namespace

LoosePoints loose_points(const KittiSequence& drive, std::size_t index, const KittiScan& scan,
                         std::span<const SeenSpace* const> others, const LooseOptions& options,
                         const Executor& executor) {
  const TimedPose& pose = drive.trajectory[index];
  LoosePoints loose;
  loose.scan = index;
  loose.time_s = pose.time_s;
  loose.sensor = pose.world_from_sensor.translation;
  std::vector<Votes> votes(scan.positions.size());
  const auto place_of = [&](std::size_t i) {
    return pose.world_from_sensor * beam_of(drive, index, scan, i).end;
  };
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> in_range, order;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    const double range_m = length(vec_cast<double>(scan.positions[i]));
    if (!(range_m >= options.min_range_m && range_m <= options.max_range_m)) continue;
    in_range.push_back(static_cast<std::uint32_t>(i));
    keys.push_back(order_key(scan.positions[i]));
  }
  executor.sort_keys(keys, order);
  executor.for_chunks(order.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<AskedPoint> points;
    for (std::size_t k = begin; k < end; ++k)
      points.push_back({in_range[order[k]], place_of(in_range[order[k]])});
    count_votes(std::move(points), others, options.min_free, votes);
  });
  for (std::size_t i = 0; i < votes.size(); ++i) {
    if (!votes[i].is_loose(options.min_free)) {
      if (votes[i].occupied > 0 && i % LoosePoints::kFirmEvery == 0)
        loose.firm.push_back(vec_cast<float>(place_of(i) - loose.sensor));
      continue;
    }
    loose.points.push_back(place_of(i));
    loose.times_s.push_back(time_of_point(scan, pose, i));
  }
  return loose;
}

}  // namespace adasplats
