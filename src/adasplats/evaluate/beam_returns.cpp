// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/beam_returns.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

void add_scan(const KittiSequence& sequence, std::size_t index, PointCloud& cloud) {
  const KittiScan scan = read_all_returns(sequence, index);
  RigidTransform local = sequence.trajectory[index].world_from_sensor;
  local.translation = local.translation - cloud.origin;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    if (!is_finite(vec_cast<double>(scan.positions[i]))) continue;
    const MeasuredBeam beam = beam_of(sequence, index, scan, i);
    cloud.positions.push_back(vec_cast<float>(local * beam.end));
    cloud.sensor_positions.push_back(vec_cast<float>(local * beam.origin));
    cloud.lasers.push_back(beam.laser);
    cloud.scan_indices.push_back(static_cast<std::uint32_t>(index));
  }
}

std::size_t count_of(double share, std::size_t all) {
  return all == 0 ? 0 : static_cast<std::size_t>(std::llround(share * static_cast<double>(all)));
}

}  // namespace

PointCloud cloud_of_scans(const KittiSequence& sequence, Vec3d origin, const Executor& executor) {
  PointCloud cloud;
  cloud.origin = origin;
  cloud.scan_poses = sequence.trajectory;
  for (std::size_t index = 0; index < sequence.scans.size(); ++index) {
    executor.check_interruption();
    add_scan(sequence, index, cloud);
  }
  const auto unknown = [](std::uint16_t laser) { return laser == kNoLaser; };
  if (std::ranges::all_of(cloud.lasers, unknown)) cloud.lasers.clear();
  return cloud;
}

EmptyBeamHits cast_empty_beams(const Tracer& tracer, Vec3d scene_origin,
                               const KittiSequence& sequence, const Executor& executor) {
  EmptyBeamHits result;
  result.ghosts = share_of(0, 0);
  const PointCloud cloud = cloud_of_scans(sequence, scene_origin, executor);
  const std::vector<EmptyBeam> empty = find_empty_beams(cloud, {}, executor);
  const float reach_m = empty_reach_m(cloud);
  std::vector<Ray> rays;
  rays.reserve(empty.size());
  for (const EmptyBeam& beam : empty) rays.push_back({beam.origin, 0, beam.direction, reach_m});
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits, executor);
  const auto hit = [](const Hit& found) { return found.valid(); };
  result.beams = empty.size();
  result.ghosts =
      share_of(static_cast<std::size_t>(std::ranges::count_if(hits, hit)), empty.size());
  result.reach_m = static_cast<double>(reach_m);
  return result;
}

BeamReturns beam_returns(const BeamAccuracy& returned, const EmptyBeamHits& empty) {
  const std::size_t missed = count_of(returned.no_hit, returned.rays);
  const std::size_t hit = returned.rays - missed;
  const std::size_t ghosts = count_of(empty.ghosts, empty.beams);
  BeamReturns result;
  result.returned = returned.rays;
  result.holes = share_of(missed, returned.rays);
  result.empty = empty.beams;
  result.ghosts = share_of(ghosts, empty.beams);
  const bool has_both = empty.beams > 0;
  result.precision = has_both ? share_of(hit, hit + ghosts) : kNaN;
  result.recall = has_both ? share_of(hit, returned.rays) : kNaN;
  result.f1 = has_both ? share_of(2 * hit, 2 * hit + ghosts + missed) : kNaN;
  return result;
}

}  // namespace adasplats
