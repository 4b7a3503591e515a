// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/quaternion_order.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

constexpr double kStep_m = 0.5;  // shorter ones are noise
constexpr std::size_t kMinSteps = 10;
constexpr double kBends = 0.9;    // below it the ways in the world point in several directions
constexpr double kOneWay = 0.95;  // from it on those in the frame of what drives are one
constexpr double kScattered = 0.9;

/// A step from a pose on.
struct PoseStep {
  Quaternion rotation;
  Vec3d way;  ///< of length 1, in the world
};

std::vector<PoseStep> steps_of(std::span<const PlacedQuaternion> poses) {
  std::vector<PoseStep> steps;
  std::size_t from = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const Vec3d way = poses[k].place - poses[from].place;
    const double way_m = length(way);
    if (!(way_m >= kStep_m)) continue;
    steps.push_back({poses[from].rotation, (1 / way_m) * way});
    from = k;
  }
  return steps;
}

/// The length of the mean of the steps' ways in frames that `read` makes of quaternions: 1 where
/// all are one, near 0 where they are scattered.
template <class Read>
double evenness(const std::vector<PoseStep>& steps, Read&& read) {
  Vec3d sum;
  for (const PoseStep& step : steps) sum = sum + read(step.rotation) * step.way;
  return length(sum) / static_cast<double>(steps.size());
}

Mat3d frame_from_world(double w, double x, double y, double z) {
  return rotation_from_quaternion(w, -x, -y, -z);
}

}  // namespace

std::string quaternion_order_problem(std::span<const PlacedQuaternion> poses) {
  const std::vector<PoseStep> steps = steps_of(poses);
  if (steps.size() < kMinSteps) return {};
  if (evenness(steps, [](const Quaternion&) { return Mat3d{}; }) > kBends) return {};
  const double as_named =
      evenness(steps, [](const Quaternion& q) { return frame_from_world(q.w, q.x, q.y, q.z); });
  if (as_named > kScattered) return {};
  // Named as if the scalar were last where it is first, and the other way round.
  const double scalar_first =
      evenness(steps, [](const Quaternion& q) { return frame_from_world(q.x, q.y, q.z, q.w); });
  const double scalar_last =
      evenness(steps, [](const Quaternion& q) { return frame_from_world(q.z, q.w, q.x, q.y); });
  const bool is_first = scalar_first >= scalar_last;
  const double other = is_first ? scalar_first : scalar_last;
  if (other < kOneWay) return {};
  std::array<char, 400> text{};
  std::snprintf(
      text.data(), text.size(),
      "the quaternions are not in the order that is named: with the scalar %s its poses "
      "go one way in their own frame (%.2f of 1), as named they go all ways (%.2f)",
      is_first ? "where qx is, and qx, qy, qz behind it" : "where qz is, and qx, qy, qz before it",
      other, as_named);
  return text.data();
}

}  // namespace adasplats
