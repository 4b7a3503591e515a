// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/point_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"
#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"
#include "adasplats/evaluate/registration_sums.h"

namespace adasplats {
namespace {

constexpr int kFitSteps = 15;
constexpr double kFirstFitWidth_m = 0.5, kLastFitWidth_m = 0.03;
constexpr double kFitReach_m = 1;
/// A direction is constrained if at least this number and share of rays hit surfaces with normals
/// less than 60 degrees from it. Chosen so that the noise of normals of flat ground does not count.
constexpr std::size_t kMinConstraining = 30;
constexpr double kConstrainingShare = 0.005;
constexpr double kConstrainingCosine = 0.5;
/// Prior on unconstrained directions, in units of all rays; and a small prior on each step.
constexpr double kHold = 1e6, kPrior = 0.01;
/// Minimum rays of a part that is fitted alone.
constexpr std::size_t kPartRays = 200;

double fit_width_m(int step) {
  return kFirstFitWidth_m *
         std::pow(kLastFitWidth_m / kFirstFitWidth_m, static_cast<double>(step) / (kFitSteps - 1));
}

double median_or_zero(std::vector<double>& values) {
  return values.empty() ? 0 : upper_median_of(values);
}

/// Only the end of the ray: from a metre before to a metre behind.
Ray end_of_ray(Vec3d sensor, Vec3d end) {
  Ray ray;
  const double range_m = length(end - sensor);
  if (!(range_m > 0)) return ray;  // without a direction, it hits nothing
  const Vec3d direction = (1 / range_m) * (end - sensor);
  const double back_m = std::min(range_m, kFitReach_m);
  ray.origin = vec_cast<float>(end - back_m * direction);
  ray.direction = vec_cast<float>(direction);
  ray.t_max = static_cast<float>(back_m + kFitReach_m);
  return ray;
}

/// Calls take(measured end, normal of the hit, distance along it) for the rays that, after the
/// motion, hit a splat near their end.
template <class Take>
void for_fit_hits(const FitScene& scene, const FitRays& given, const RigidTransform& motion,
                  const Executor& executor, const Take& take) {
  std::vector<Ray> rays(given.ends.size());
  std::vector<Hit> hits(rays.size());
  for (std::size_t k = 0; k < rays.size(); ++k)
    rays[k] = end_of_ray(motion * vec_cast<double>(given.sensors[k]),
                         motion * vec_cast<double>(given.ends[k]));
  scene.tracer().nearest(rays, hits, executor);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (!hits[k].valid()) continue;
    const Vec3d hit = vec_cast<double>(rays[k].origin) +
                      static_cast<double>(hits[k].t) * vec_cast<double>(rays[k].direction);
    const Vec3d measured = motion * vec_cast<double>(given.ends[k]);
    const Vec3d normal = vec_cast<double>(scene.view().unit_normal(hits[k].primitive));
    take(measured, normal, dot(normal, hit - measured));
  }
}

RegistrationSums sums_of(const FitScene& scene, const FitRays& rays, const RigidTransform& motion,
                         Vec3d pivot, double width_m, const Executor& executor) {
  RegistrationSums sums;
  for_fit_hits(scene, rays, motion, executor, [&](Vec3d measured, Vec3d normal, double distance_m) {
    sums.add(measured - pivot, normal, distance_m, width_m);
  });
  return sums;
}

/// The shifts and rotations that the normals of the hits do not constrain.
class Unconstrained {
 public:
  void add(Vec3d normal) { normals_.push_back(normal); }

  void find() {
    SymmetricMat3d sums;
    for (const Vec3d n : normals_) {
      sums.xx += n.x * n.x;
      sums.xy += n.x * n.y;
      sums.xz += n.x * n.z;
      sums.yy += n.y * n.y;
      sums.yz += n.y * n.z;
      sums.zz += n.z * n.z;
    }
    const SymmetricEigen eigen = symmetric_eigen(sums);
    std::vector<Vec3d> constrained;
    for (const Vec3d axis : eigen.vectors) {
      const auto constraining = static_cast<std::size_t>(std::ranges::count_if(
          normals_, [&](Vec3d n) { return std::fabs(dot(n, axis)) > kConstrainingCosine; }));
      const double share = static_cast<double>(constraining) / static_cast<double>(normals_.size());
      (constraining >= kMinConstraining && share >= kConstrainingShare ? constrained : shifts_)
          .push_back(axis);
    }
    // Parallel planes do not constrain rotations about their normal.
    if (constrained.size() == 1) turns_ = constrained;
    if (constrained.empty()) turns_ = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  }

  /// Adds the prior to the matrix of a step; `first`: index of the three unknowns of shifts.
  template <std::size_t N>
  void hold_shifts(std::array<double, N * N>& matrix, std::size_t first, double weight) const {
    hold<N>(shifts_, matrix, first, weight);
  }
  void hold_turns(std::array<double, 36>& matrix, double weight) const {
    hold<6>(turns_, matrix, 0, weight);
  }

 private:
  template <std::size_t N>
  static void hold(const std::vector<Vec3d>& axes, std::array<double, N * N>& matrix,
                   std::size_t first, double weight) {
    for (const Vec3d axis : axes)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          matrix[(first + a) * N + first + b] +=
              kHold * weight * axis[static_cast<int>(a)] * axis[static_cast<int>(b)];
  }

  std::vector<Vec3d> normals_;
  std::vector<Vec3d> shifts_, turns_;
};

void add_normals(const FitScene& scene, const FitRays& rays, const Executor& executor,
                 Unconstrained& unconstrained) {
  for_fit_hits(scene, rays, {}, executor,
               [&](Vec3d, Vec3d normal, double) { unconstrained.add(normal); });
}

double weight_of(const RegistrationSums& sums) { return static_cast<double>(sums.beams) + 1e-3; }

/// The common shift of all parts.
Vec3d common_shift(std::span<const FitPart> parts, const Executor& executor) {
  Unconstrained unconstrained;
  for (const FitPart& part : parts) add_normals(part.scene, part.rays, executor, unconstrained);
  unconstrained.find();
  RigidTransform motion;
  for (int step = 0; step < kFitSteps; ++step) {
    RegistrationSums sums;
    for (const FitPart& part : parts)
      sums += sums_of(part.scene, part.rays, motion, {}, fit_width_m(step), executor);
    std::array<double, 9> matrix{};
    std::array<double, 3> right{};
    for (std::size_t a = 0; a < 3; ++a) {
      right[a] = sums.right[a + 3];
      for (std::size_t b = 0; b < 3; ++b) matrix[a * 3 + b] = sums.matrix[(a + 3) * 6 + b + 3];
      matrix[a * 4] += kPrior * weight_of(sums);
    }
    unconstrained.hold_shifts<3>(matrix, 0, weight_of(sums));
    factor<3>(matrix);
    const std::array<double, 3> x = solved<3>(matrix, right);
    motion.translation = motion.translation + Vec3d{x[0], x[1], x[2]};
  }
  return motion.translation;
}

void add_distances(const FitPart& part, const RigidTransform& motion, const Executor& executor,
                   std::vector<double>& distances) {
  for_fit_hits(part.scene, part.rays, motion, executor, [&](Vec3d, Vec3d, double distance_m) {
    distances.push_back(std::fabs(distance_m));
  });
}

}  // namespace

FitScene::FitScene(std::vector<Disk> disks, const Executor& executor)
    : disks_(std::move(disks)), tracer_(make_cpu_tracer(view(), executor)) {}

Vec3d FitRays::middle() const {
  Vec3d sum;
  for (const Vec3f end : ends) sum = sum + vec_cast<double>(end);
  return ends.empty() ? sum : (1.0 / static_cast<double>(ends.size())) * sum;
}

FitMotion fit_motion(const FitScene& scene, const FitRays& rays, Vec3d pivot,
                     const Executor& executor) {
  Unconstrained unconstrained;
  add_normals(scene, rays, executor, unconstrained);
  unconstrained.find();
  FitMotion fit;
  for (int step = 0; step < kFitSteps; ++step) {
    const Vec3d at = fit.motion * pivot;
    RegistrationSums sums = sums_of(scene, rays, fit.motion, at, fit_width_m(step), executor);
    for (std::size_t a = 0; a < 6; ++a) sums.matrix[a * 7] += kPrior * weight_of(sums);
    unconstrained.hold_turns(sums.matrix, weight_of(sums));
    unconstrained.hold_shifts<6>(sums.matrix, 3, weight_of(sums));
    factor<6>(sums.matrix);
    const std::array<double, 6> x = solved<6>(sums.matrix, sums.right);
    fit.motion = moved_about(at, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}) * fit.motion;
    fit.hits = sums.beams;
  }
  return fit;
}

PointFit fit_of_points(std::span<const FitPart> parts, const Executor& executor) {
  PointFit fit;
  std::vector<double> before, shifted, part_shifts;
  fit.shift_m = common_shift(parts, executor);
  for (const FitPart& part : parts) {
    const std::size_t begin = before.size();
    add_distances(part, {}, executor, before);
    add_distances(part, {Mat3d{}, fit.shift_m}, executor, shifted);
    if (before.size() - begin < kPartRays) continue;
    const Vec3d middle = part.rays.middle();
    const FitMotion own = fit_motion(part.scene, part.rays, middle, executor);
    part_shifts.push_back(length(own.motion * middle - middle));
  }
  fit.rays = before.size();
  fit.parts = part_shifts.size();
  fit.part_shift_m = median_or_zero(part_shifts);
  fit.distance_m = median_or_zero(before);
  fit.distance_shifted_m = median_or_zero(shifted);
  return fit;
}

}  // namespace adasplats
