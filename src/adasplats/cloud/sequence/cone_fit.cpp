// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/cone_fit.h"

#include <array>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {
namespace {

constexpr double kCap_rad = 0.5 * kDegree;  // of one point's residual: an outlier tells no more

/// Mean of min(|x|, cap) for x uniform within half a gap.
double chance_of(double gap_rad) {
  const double half = 0.5 * gap_rad;
  return half <= kCap_rad ? 0.5 * half : kCap_rad - 0.5 * kCap_rad * kCap_rad / half;
}

void add_lasers(const std::vector<std::size_t>& counts, ConeScore& score) {
  const auto has = [](std::size_t count) { return count > 0; };
  const auto first =
      static_cast<std::size_t>(std::find_if(counts.begin(), counts.end(), has) - counts.begin());
  const auto end =
      static_cast<std::size_t>(counts.rend() - std::find_if(counts.rbegin(), counts.rend(), has));
  double points = 0, filled = 0, empty = 0;
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t above = i == 0 ? 0 : counts[i - 1];
    const std::size_t below = i + 1 == counts.size() ? 0 : counts[i + 1];
    points += static_cast<double>(counts[i]);
    filled += counts[i] > 0 ? 1 : 0;
    // Under a tenth of what its neighbours have: noise brings as much over from them.
    empty += 20 * counts[i] <= above + below ? 1 : 0;
  }
  if (first >= end) return;
  score.largest = static_cast<double>(*std::max_element(counts.begin(), counts.end())) / points;
  score.filled = filled / static_cast<double>(counts.size());
  score.empty = empty / static_cast<double>(end - first);
}

/// The same axis without the turn about it.
RigidTransform without_yaw(const RigidTransform& mount) {
  const Vec3d up = axis_of(mount);
  return mount_of(mount.translation, std::asin(std::clamp(-up.y, -1.0, 1.0)),
                  std::atan2(up.x, up.z));
}

using Unknowns = std::array<double, 5>;  // x, y, z, roll, pitch; yaw does not show

/// How the elevation of a point (sensor's frame) over a cone's tip changes with the mount.
Unknowns gradient_of(Vec3d point, double tip_m, const Mat3d& rotation) {
  const Vec3d p = {point.x, point.y, point.z - tip_m};
  const double flat_m = std::max(std::sqrt(p.x * p.x + p.y * p.y), 1e-6);
  const double square = flat_m * flat_m + p.z * p.z;
  const Vec3d up = {-p.z * p.x / (flat_m * square), -p.z * p.y / (flat_m * square),
                    flat_m / square};
  const Vec3d shift = -(rotation * up);
  const Vec3d turn = -cross(point, up);
  return {shift.x, shift.y, shift.z, turn.x, turn.y};
}

/// One step of Gauss-Newton with the weights of Geman and McClure. Only points take part whose
/// gaps are wide for what `doubt` makes of their elevation: sparse lasers and far points lead, the
/// others follow as the doubt falls.
void gauss_newton_step(std::span<const Vec3d> points, const ConeTable& table,
                       const MountDoubt& doubt, RigidTransform& mount) {
  constexpr double kWide = 2.5;  // 79 of 100 doubts are within half of such a gap
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::array<double, 25> normal{};
  Unknowns right{};
  double used = 0;
  for (const Vec3d& point : points) {
    const Vec3d p = sensor_from_vehicle * point;
    const ConePlace place = table.place_of(p);
    const double width_rad = angle_of(doubt, p);
    if (place.outside || place.gap_rad < kWide * width_rad) continue;
    const Unknowns gradient = gradient_of(p, table[place.laser].height_m, mount.rotation);
    const double widths = place.residual_rad / width_rad;
    const double falls = 1 / (1 + widths * widths);
    const double weight = falls * falls / (width_rad * width_rad);
    for (std::size_t r = 0; r < 5; ++r) {
      for (std::size_t c = 0; c <= r; ++c) normal[r * 5 + c] += weight * gradient[r] * gradient[c];
      right[r] -= weight * gradient[r] * place.residual_rad;
    }
    used += 1;
  }
  if (used < 30) return;
  // What the points do not show stays: a step as long as the doubt costs a hundredth of them.
  const Unknowns doubts = {doubt.aside_m, doubt.aside_m, doubt.height_m, doubt.tilt_rad,
                           doubt.tilt_rad};
  for (std::size_t r = 0; r < 5; ++r) normal[r * 6] += 0.01 * used / (doubts[r] * doubts[r]);
  factor<5>(normal);
  const Unknowns change = solved<5>(normal, right);
  mount.translation = mount.translation + Vec3d{change[0], change[1], change[2]};
  mount.rotation = mount.rotation * rotation_by({change[3], change[4], 0});
}

}  // namespace

std::vector<Vec3d> sample_of(std::span<const Vec3d> points, std::size_t count) {
  if (points.size() <= count) return {points.begin(), points.end()};
  std::vector<Vec3d> sample(count);
  const double part = static_cast<double>(points.size()) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    Random random(0, 0, i);
    const auto at = static_cast<std::size_t>((static_cast<double>(i) + random.uniform()) * part);
    sample[i] = points[std::min(at, points.size() - 1)];
  }
  return sample;
}

ConeScore score_of(std::span<const Vec3d> points, const ConeTable& table,
                   const RigidTransform& mount) {
  const RigidTransform sensor_from_vehicle = mount.inverse();
  std::vector<std::size_t> counts(table.size());
  ConeScore score;
  const double one = 1 / static_cast<double>(points.size());
  for (const Vec3d& point : points) {
    const ConePlace place = table.place_of(sensor_from_vehicle * point);
    const double residual_rad = std::abs(place.residual_rad);
    score.residual_rad += one * (place.outside ? kCap_rad : std::min(residual_rad, kCap_rad));
    score.chance_rad += one * chance_of(place.gap_rad);
    score.share += residual_rad < 0.125 * place.gap_rad ? one : 0;
    score.outside += place.outside ? one : 0;
    if (!place.outside) ++counts[place.laser];
  }
  add_lasers(counts, score);
  return score;
}

RigidTransform mount_of(Vec3d origin, double roll_rad, double pitch_rad) {
  return {rotation_from_yaw_pitch_roll(0, pitch_rad, roll_rad), origin};
}

Vec3d axis_of(const RigidTransform& mount) { return mount.rotation.transposed().rows[2]; }

double slope_of(Vec3d p) { return std::abs(p.z) * std::sqrt(p.x * p.x + p.y * p.y) / dot(p, p); }

double angle_of(const MountDoubt& doubt, Vec3d p) {
  const double range_m = length(p);
  const double height_rad = doubt.height_m / range_m;
  const double aside_rad = slope_of(p) * doubt.aside_m / range_m;
  return std::sqrt(doubt.tilt_rad * doubt.tilt_rad + height_rad * height_rad +
                   aside_rad * aside_rad);
}

RigidTransform refined_mount(std::span<const Vec3d> points, const ConeTable& table,
                             MountDoubt doubt, int steps, RigidTransform mount) {
  constexpr MountDoubt kLast = {0.05 * kDegree, 0.005, 0.01};
  const auto fall = [&](double first, double last) {
    return std::pow(std::min(last / first, 1.0), 1.0 / (steps - 1));
  };
  const MountDoubt falls = {fall(doubt.tilt_rad, kLast.tilt_rad),
                            fall(doubt.height_m, kLast.height_m),
                            fall(doubt.aside_m, kLast.aside_m)};
  for (int i = 0; i < steps; ++i) {
    gauss_newton_step(points, table, doubt, mount);
    doubt = {doubt.tilt_rad * falls.tilt_rad, doubt.height_m * falls.height_m,
             doubt.aside_m * falls.aside_m};
  }
  return without_yaw(mount);
}

ConeFit fit_near(std::span<const Vec3d> points, const ConeTable& table,
                 const RigidTransform& mount) {
  const RigidTransform better =
      refined_mount(sample_of(points, kBetterPoints), table, kFound, 12, mount);
  const std::vector<Vec3d> all = sample_of(points, kFinalPoints);
  const RigidTransform best = refined_mount(all, table, kFound, 6, better);
  return {best, score_of(all, table, best)};
}

}  // namespace adasplats
