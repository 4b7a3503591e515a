// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/loose_points.h"

#include <cstdint>

namespace adasplats {
namespace {

struct Votes {
  std::uint8_t free = 0, occupied = 0;
};

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
  executor.for_chunks(votes.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double range_m = length(vec_cast<double>(scan.positions[i]));
      if (!(range_m >= options.min_range_m && range_m <= options.max_range_m)) continue;
      const Vec3d place = place_of(i);
      for (const SeenSpace* other : others) {
        const Seen seen = other->at(place);
        if (seen == Seen::free) ++votes[i].free;
        if (seen == Seen::occupied) ++votes[i].occupied;
      }
    }
  });
  for (std::size_t i = 0; i < votes.size(); ++i) {
    if (votes[i].free < options.min_free || votes[i].free < votes[i].occupied) {
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
