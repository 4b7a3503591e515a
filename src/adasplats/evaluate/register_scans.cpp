// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"
#include "adasplats/evaluate/registration_sums.h"
#include "adasplats/evaluate/resimulate.h"

namespace adasplats {
namespace {

constexpr std::size_t kBeamEvery = 8;  // uses every 8th beam
constexpr int kRegistrationSteps = 12;
constexpr double kFirstWidth_m = 0.15, kLastWidth_m = 0.03;
/// Prior on a step, in squared metres of residual: a scan without hits does not move.
constexpr double kMatrixPrior = 1e-3;

Vec3d normal_at(const SceneView& scene, std::uint32_t primitive) {
  return vec_cast<double>(scene.unit_normal(primitive));
}

/// The beams of a scan that are used, in its frame.
std::vector<MeasuredBeam> some_beams(const KittiSequence& sequence, std::size_t index,
                                     const LabelScheme& labels, const ResimulateOptions& options) {
  const KittiScan scan = read_kitti_scan(sequence, index);
  std::vector<MeasuredBeam> beams;
  for (std::size_t i = 0; i < scan.positions.size(); i += kBeamEvery) {
    const Vec3d point = vec_cast<double>(scan.positions[i]);
    const double range_m = length(point);
    if (!(range_m >= options.min_range_m && range_m <= options.max_range_m)) continue;
    const SemanticClass* found = scan.classes.empty() ? nullptr : labels.find(scan.classes[i]);
    if (found && !is_counted(found->mobility, options.drop_moving, options.drop_movable)) continue;
    beams.push_back(beam_of(sequence, index, scan, i));
  }
  return beams;
}

RigidTransform improved(const Tracer& tracer, const SceneView& scene, RigidTransform pose,
                        const std::vector<MeasuredBeam>& beams, double width_m,
                        const Executor& executor) {
  std::vector<Ray> rays(beams.size());
  std::vector<Hit> hits(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const Vec3d way = beams[k].end - beams[k].origin;
    rays[k].origin = vec_cast<float>(pose * beams[k].origin);
    rays[k].direction = vec_cast<float>(pose.rotation * (way / length(way)));
  }
  tracer.nearest(rays, hits, executor);
  RegistrationSums sums = executor.sum_chunks(
      beams.size(), kFineGrain, RegistrationSums{}, [&](std::size_t begin, std::size_t end) {
        RegistrationSums part;
        for (std::size_t k = begin; k < end; ++k) {
          if (!hits[k].valid()) continue;
          const Vec3d hit = vec_cast<double>(rays[k].origin) +
                            static_cast<double>(hits[k].t) * vec_cast<double>(rays[k].direction);
          const Vec3d measured = pose * beams[k].end;
          const Vec3d normal = normal_at(scene, hits[k].primitive);
          part.add(measured - pose.translation, normal, dot(normal, hit - measured), width_m);
        }
        return part;
      });
  for (std::size_t a = 0; a < 6; ++a) sums.matrix[a * 7] += kMatrixPrior;
  factor<6>(sums.matrix);
  const std::array<double, 6> x = solved<6>(sums.matrix, sums.right);
  return moved_about(pose.translation, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}) * pose;
}

}  // namespace

void register_scans(const Tracer& tracer, const SceneView& scene, Vec3d scene_origin,
                    KittiSequence& sequence, const LabelScheme& labels,
                    const ResimulateOptions& options, const Executor& executor,
                    ProgressSink& progress) {
  progress.begin_step("register scans", sequence.scans.size());
  for (std::size_t index = 0; index < sequence.scans.size(); ++index) {
    const std::vector<MeasuredBeam> beams = some_beams(sequence, index, labels, options);
    RigidTransform& world_from_sensor = sequence.trajectory[index].world_from_sensor;
    RigidTransform pose = world_from_sensor;
    pose.translation = pose.translation - scene_origin;
    for (int step = 0; step < kRegistrationSteps; ++step) {
      const double width_m =
          kFirstWidth_m * std::pow(kLastWidth_m / kFirstWidth_m,
                                   static_cast<double>(step) / (kRegistrationSteps - 1));
      pose = improved(tracer, scene, pose, beams, width_m, executor);
    }
    pose.translation = pose.translation + scene_origin;
    world_from_sensor = pose;
    progress.advance(index + 1);
  }
  progress.end_step();
}

}  // namespace adasplats
