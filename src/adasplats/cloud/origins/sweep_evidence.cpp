// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/sweep_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "adasplats/cloud/origins/origin_check.h"
#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr double kCell_rad = 0.5 * std::numbers::pi / 180;
constexpr double kMinLogRange_m = 0.1;  // the logarithm of a point at its sensor is infinite
constexpr double kSteep = 0.5;          // sine of the angle below the horizon

/// Cell of a direction on the faces of a cube, where poles are nothing special.
std::uint64_t cell_of(Vec3d direction) {
  int face = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::fabs(direction[axis]) > std::fabs(direction[face])) face = axis;
  const double depth = std::fabs(direction[face]);
  if (!(depth > 0)) return 0;
  const auto cell = [&](int axis) {
    return static_cast<std::uint64_t>((std::atan(direction[axis] / depth) + 1) / kCell_rad);
  };
  const std::uint64_t side = 2U * static_cast<unsigned>(face) + (direction[face] > 0 ? 1U : 0U);
  return side << 40 | cell((face + 1) % 3) << 20 | cell((face + 2) % 3);
}

double entropy_of(std::vector<std::uint64_t>& keys, const Executor& executor) {
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  const auto n = static_cast<double>(keys.size());
  double sum = 0;
  for (std::size_t begin = 0, i = 1; i <= keys.size(); ++i) {
    if (i < keys.size() && keys[i] == keys[begin]) continue;
    const auto count = static_cast<double>(i - begin);
    sum += count * std::log(count);
    begin = i;
  }
  return std::log(n) - sum / n;
}

/// StationView::share_behind in the mean of the sweeps that have points enough.
void add_sweeps(const SweepSample& sample, const ClockPair& clock, const Trajectory& trajectory,
                const Executor& executor, SweepView& view) {
  double behind = 0;
  int sweeps = 0;
  std::size_t points_of_sweeps = 0;
  for (const std::vector<TimedPoint>& sweep : sample.sweeps) {
    if (sweep.size() < kMinOfSweep) continue;
    std::vector<Vec3f> points;
    points.reserve(sweep.size());
    for (const TimedPoint& point : sweep) {
      const RigidTransform pose = interpolate(trajectory, clock.in_trajectory(point.time));
      points.push_back(
          vec_cast<float>(pose.rotation.transposed() * (point.world - pose.translation)));
    }
    behind += view_from_station(points, executor).share_behind;
    points_of_sweeps += points.size();
    ++sweeps;
  }
  if (sweeps == 0) return;
  view.share_behind = behind / sweeps;
  view.sweep_points = points_of_sweeps / static_cast<std::size_t>(sweeps);
}

}  // namespace

double SweepView::max_behind() const {
  if (sweep_points == 0) return 1;
  return sweep_points < kManyOfSweep ? kMaxHiddenOfFew : kMaxHidden;
}

SweepView view_along(const SweepSample& sample, const ClockPair& clock,
                     const Trajectory& trajectory, const Executor& executor) {
  SweepView view;
  view.points = sample.points.size();
  if (view.points == 0) return view;
  std::vector<std::uint64_t> keys(view.points);
  std::vector<double> ranges_m(view.points);
  std::array<std::vector<double>, 3> ways_m;
  for (std::vector<double>& way_m : ways_m) way_m.resize(view.points);
  std::vector<std::uint8_t> far(view.points);
  executor.for_chunks(view.points, kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const TimedPoint& point = sample.points[i];
      const RigidTransform pose = interpolate(trajectory, clock.in_trajectory(point.time));
      const Vec3d way = point.world - pose.translation;
      keys[i] = cell_of(pose.rotation.transposed() * way);
      ranges_m[i] = length(way);
      for (int axis = 0; axis < 3; ++axis) ways_m[static_cast<std::size_t>(axis)][i] = way[axis];
      far[i] = ranges_m[i] > kFarInStreets_m && -way.z < kSteep * ranges_m[i] ? 1 : 0;
    }
  });
  const auto n = static_cast<double>(view.points);
  double logarithms = 0;
  for (const double range_m : ranges_m) logarithms += std::log(std::max(range_m, kMinLogRange_m));
  view.scatter = entropy_of(keys, executor) + 3 * logarithms / n;
  view.share_far = static_cast<double>(std::ranges::count(far, std::uint8_t{1})) / n;
  view.median_range_m = upper_median_of(ranges_m);
  view.median_way_m = {upper_median_of(ways_m[0]), upper_median_of(ways_m[1]),
                       upper_median_of(ways_m[2])};
  add_sweeps(sample, clock, trajectory, executor, view);
  return view;
}

}  // namespace adasplats
