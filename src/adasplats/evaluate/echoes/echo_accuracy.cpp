// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/echoes/echo_accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"
#include "adasplats/evaluate/echoes/beam_grid.h"
#include "adasplats/evaluate/intensity_agreement.h"
#include "adasplats/evaluate/share.h"

namespace adasplats {
namespace {

/// Pairs of intensities of one scan.
struct IntensityPairs {
  std::vector<float> predicted;
  std::vector<float> measured;
};

void add_pairs(IntensityPairs& pairs, const EchoScene& scene, const KittiSequence& sequence,
               std::size_t index, const Executor& executor) {
  const KittiScan scan = read_kitti_scan(sequence, index);
  RigidTransform scene_from_sensor = sequence.trajectory[index].world_from_sensor;
  scene_from_sensor.translation = scene_from_sensor.translation - scene.origin;
  std::vector<Ray> rays(scan.positions.size());
  std::vector<Hit> hits(rays.size());
  executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const MeasuredBeam beam = sequence.beams.beam_of(index, vec_cast<double>(scan.positions[i]));
      rays[i].origin = vec_cast<float>(scene_from_sensor * beam.origin);
      rays[i].direction =
          vec_cast<float>(scene_from_sensor.rotation * normalized(beam.end - beam.origin));
    }
  });
  scene.tracer.nearest(rays, hits, executor);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].valid() || !std::isfinite(scan.intensities[i])) continue;
    const float expected = expected_intensity(scene.attributes, rays[i], hits[i]);
    if (!std::isfinite(expected)) continue;
    pairs.predicted.push_back(expected);
    pairs.measured.push_back(scan.intensities[i]);
  }
}

BeamGrid grid_of(const KittiSequence& sequence, std::size_t index, const LidarModel& sensor) {
  const KittiScan scan = read_kitti_scan(sequence, index);
  try {
    return find_beam_grid(scan, sensor);
  } catch (const Error& error) {
    throw Error(error.kind(), sequence.scans[index].string() + ": " + error.what());
  }
}

void add_beams(BeamEchoes& beams, const EchoScene& scene, const BeamGrid& grid, std::uint32_t place,
               const LidarModel& sensor, const ScanMotion& motion, const Executor& executor) {
  const std::vector<Ray> rays = scan_rays(sensor, grid.beams, motion, scene.origin, executor);
  std::vector<Hit> hits(rays.size());
  scene.tracer.nearest(rays, hits, executor);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = hits[i].valid();
    EchoConditions echo = hit ? echo_of(scene, rays[i], hits[i]) : EchoConditions{};
    echo.direction = grid.beams[i].direction;
    beams.echoes.push_back(echo);
    beams.hit.push_back(hit ? 1 : 0);
    beams.lost.push_back(grid.returned(i) ? 0 : 1);
    beams.places.push_back(place);
  }
}

/// The beams for whose index `keep` is true.
template <class Keep>
BeamEchoes kept(const BeamEchoes& beams, const Keep& keep) {
  BeamEchoes result;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (!keep(i)) continue;
    result.echoes.push_back(beams.echoes[i]);
    result.hit.push_back(beams.hit[i]);
    result.lost.push_back(beams.lost[i]);
    result.places.push_back(beams.places[i]);
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> standpoints_of(const KittiSequence& sequence,
                                          std::span<const std::size_t> indices) {
  constexpr double kApart_m = 2;
  std::vector<std::uint32_t> places;
  Vec3d begin;
  for (const std::size_t index : indices) {
    const Vec3d here = sequence.trajectory[index].world_from_sensor.translation;
    const bool is_first = places.empty();
    const bool is_new = is_first || length(here - begin) >= kApart_m;
    if (is_new) begin = here;
    places.push_back(is_first ? 0 : places.back() + (is_new ? 1 : 0));
  }
  return places;
}

EchoConditions echo_of(const EchoScene& scene, const Ray& ray, const Hit& hit) {
  const auto& intensities = scene.attributes.intensities;
  EchoConditions echo;
  echo.range_m = hit.t;
  echo.cos_incidence = cos_incidence(scene.attributes.view, ray.direction, hit.primitive);
  echo.reflectance = hit.primitive < intensities.size() ? intensities[hit.primitive]
                                                        : std::numeric_limits<float>::quiet_NaN();
  const auto& log_odds = scene.attributes.drop_log_odds;
  if (hit.primitive < log_odds.size()) echo.drop_log_odds = log_odds[hit.primitive];
  return echo;
}

IntensityAccuracy intensity_accuracy(const EchoScene& scene, const KittiSequence& sequence,
                                     std::span<const std::size_t> indices, const Executor& executor,
                                     ProgressSink& progress) {
  if (scene.attributes.intensities.empty()) {
    throw Error(ErrorKind::data,
                "the model has no intensities; make it from points with intensities");
  }
  IntensityPairs pairs;
  progress.begin_step("compare intensities", indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    add_pairs(pairs, scene, sequence, indices[k], executor);
    progress.advance(k + 1);
  }
  progress.end_step();
  if (pairs.measured.empty()) {
    throw Error(ErrorKind::data,
                sequence.folder.string() + ": no beam with an intensity hits the model");
  }
  IntensityAccuracy accuracy;
  accuracy.rays = pairs.measured.size();
  accuracy.rank_correlation = rank_correlation(pairs.predicted, pairs.measured);
  for (std::size_t i = 0; i < accuracy.rays; ++i) {
    accuracy.mae +=
        std::fabs(static_cast<double>(pairs.predicted[i]) - static_cast<double>(pairs.measured[i]));
  }
  accuracy.mae /= static_cast<double>(accuracy.rays);
  return accuracy;
}

BeamEchoes collect_beam_echoes(const EchoScene& scene, const KittiSequence& sequence,
                               std::span<const std::size_t> indices, const LidarModel& sensor,
                               std::span<const ScanMotion> motions, const Executor& executor,
                               ProgressSink& progress) {
  BeamEchoes beams;
  const std::vector<std::uint32_t> places = standpoints_of(sequence, indices);
  progress.begin_step("cast all beams", indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const BeamGrid grid = grid_of(sequence, indices[k], sensor);
    add_beams(beams, scene, grid, places[k], sensor, motions[indices[k]], executor);
    progress.advance(k + 1);
  }
  progress.end_step();
  return beams;
}

RayDropModel fit_ray_drop(const BeamEchoes& beams) {
  const BeamEchoes hits = kept(beams, [&](std::size_t i) { return beams.hit[i] != 0; });
  RayDropModel blocked;
  blocked.blocked = find_blocked_sectors(hits.echoes, hits.lost, hits.places);
  const BeamEchoes free =
      kept(hits, [&](std::size_t i) { return !blocked.blocks(hits.echoes[i].direction); });
  RayDropModel model = fit_ray_drop(free.echoes, free.lost);
  model.blocked = std::move(blocked.blocked);
  return model;
}

double DropAccuracy::precision() const { return share_of(right, predicted); }
double DropAccuracy::recall() const { return share_of(right, empty); }
double DropAccuracy::f1() const { return share_of(2 * right, predicted + empty); }

DropAccuracy drop_accuracy(const BeamEchoes& beams, const RayDropModel* model, bool with_blocked) {
  DropAccuracy accuracy;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const EchoConditions& echo = beams.echoes[i];
    if (!with_blocked && model != nullptr && model->blocks(echo.direction)) continue;
    const bool lost = beams.lost[i] != 0;
    const bool predicted =
        beams.hit[i] == 0 || (model != nullptr && drop_probability(*model, echo) > 0.5);
    ++accuracy.beams;
    accuracy.empty += lost ? 1 : 0;
    accuracy.predicted += predicted ? 1 : 0;
    accuracy.right += lost && predicted ? 1 : 0;
  }
  return accuracy;
}

}  // namespace adasplats
