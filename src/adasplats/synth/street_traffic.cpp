// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr double kCarEvery_s = 13;    // per lane
constexpr double kPersonEvery_m = 9;  // per sidewalk
constexpr double kWaypointEvery_m = 4;

}  // namespace

void add_person(MeshBuilder& builder, double height, const Material& cloth) {
  const double s = height / 1.75;
  const Material skin = {cloth.class_id, 0.5F, cloth.instance};
  for (const double side : {-1.0, 1.0}) {
    const Vec3d hip = {0, side * 0.09 * s, 0.88 * s};
    const Vec3d knee = {side * 0.12 * s, side * 0.1 * s, 0.48 * s};
    const Vec3d ankle = {side * 0.2 * s, side * 0.1 * s, 0.06 * s};
    builder.tube(hip, knee, 0.085 * s, 0.065 * s, 10, cloth);
    builder.tube(knee, ankle, 0.065 * s, 0.05 * s, 10, cloth);
    builder.box(ankle + Vec3d{0.06 * s, 0, -0.02}, {0.13 * s, 0, 0}, {0, 0.05 * s, 0},
                {0, 0, 0.035}, cloth);
    const Vec3d shoulder = {0, side * 0.2 * s, 1.4 * s};
    const Vec3d hand = {-side * 0.18 * s, side * 0.26 * s, 0.85 * s};
    builder.tube(shoulder, hand, 0.055 * s, 0.04 * s, 8, cloth);
  }
  builder.tube({0, 0, 0.85 * s}, {0, 0, 1.38 * s}, 0.16 * s, 0.19 * s, 14, cloth);
  builder.ellipsoid({0, 0, 1.38 * s}, {0.15 * s, 0.22 * s, 0.12 * s}, 8, 14, cloth);
  builder.tube({0, 0, 1.45 * s}, {0, 0, 1.56 * s}, 0.06 * s, 0.06 * s, 10, skin);
  builder.ellipsoid({0.01, 0, 1.64 * s}, {0.095 * s, 0.08 * s, 0.115 * s}, 8, 12, skin);
}

namespace {

MovingObject finished(MeshBuilder& builder, std::uint16_t instance, Trajectory trajectory) {
  BuiltMesh built = builder.take();
  return {std::move(built.mesh), std::move(built.reflectances), instance, std::move(trajectory)};
}

RigidTransform pose_at(Vec3d position, double yaw) {
  return {rotation_from_yaw_pitch_roll(yaw, 0, 0), position};
}

/// Straight from one end of the street to the other.
Trajectory drive_through(const StreetPlan& plan, int direction, double start_s, double speed) {
  Trajectory trajectory;
  const double y = -direction * kLaneCenter;
  const double from = -3;
  const double way_m = plan.length + 6;
  const int steps = static_cast<int>(std::ceil(way_m / kWaypointEvery_m));
  const double yaw = direction > 0 ? 0 : std::numbers::pi;
  for (int k = 0; k <= steps; ++k) {
    const double travelled = way_m * k / steps;
    const double x = direction > 0 ? from + travelled : from + way_m - travelled;
    const double time_s = start_s + travelled / speed;
    trajectory.push_back({time_s, pose_at({x, y, road_height(x, y)}, yaw)});
  }
  return trajectory;
}

/// Up and down a stretch of sidewalk for the entire period.
Trajectory walk(const StreetPlan& plan, int side, double x0, double x1, double speed,
                double first_share) {
  Trajectory trajectory;
  const double way_m = x1 - x0;
  for (double time_s = 0; time_s <= kTrafficPeriod_s; time_s += 1.0) {
    const double phase = std::fmod(first_share + speed * time_s / (2 * way_m), 1.0);
    const bool forth = phase < 0.5;
    const double x = x0 + way_m * (forth ? 2 * phase : 2 - 2 * phase);
    const double y = side * (kWalkLine + (forth ? 0.3 : -0.3));
    trajectory.push_back(
        {time_s, pose_at({std::min(std::max(x, 0.5), plan.length - 0.5), y, sidewalk_height(x, y)},
                         forth ? 0 : std::numbers::pi)});
  }
  return trajectory;
}

/// Over the zebra crossing, once.
Trajectory cross_road(const StreetPlan& plan, double start_s, int direction) {
  Trajectory trajectory;
  const double yaw = direction * 0.5 * std::numbers::pi;
  for (int k = 0; k <= 28; ++k) {
    const double y = direction * (-7.0 + 0.5 * k);
    const double z = std::fabs(y) < kRoadHalfWidth ? road_height(plan.crossing, y)
                                                   : sidewalk_height(plan.crossing, y);
    trajectory.push_back({start_s + 0.5 * k / 1.3, pose_at({plan.crossing, y, z}, yaw)});
  }
  return trajectory;
}

/// The stretches of a sidewalk between side streets.
std::vector<std::pair<double, double>> stretches(const StreetPlan& plan, int side) {
  std::vector<std::pair<double, double>> result;
  double from = 1;
  for (const Plot& plot : plan.plots) {
    if (plot.side != side || plot.kind != PlotKind::side_street) continue;
    result.emplace_back(from, plot.x0 - 0.5);
    from = plot.x1 + 0.5;
  }
  result.emplace_back(from, plan.length - 1);
  return result;
}

}  // namespace

std::vector<MovingObject> make_traffic(const StreetPlan& plan, std::uint16_t first_instance) {
  std::vector<MovingObject> traffic;
  std::uint16_t instance = first_instance;
  const auto add = [&](MeshBuilder& builder, Trajectory trajectory) {
    traffic.push_back(finished(builder, instance, std::move(trajectory)));
    ++instance;
  };
  const auto add_walker = [&](Trajectory trajectory) {
    Random random = random_of(plan, Purpose::walkers, instance);
    MeshBuilder builder;
    const auto clothing = static_cast<float>(random.uniform(0.1, 0.6));
    add_person(builder, random.uniform(1.55, 1.9), {label::kMovingPerson, clothing});
    add(builder, std::move(trajectory));
  };

  for (const int direction : {1, -1}) {
    Random random = random_of(plan, Purpose::traffic, direction > 0 ? 1 : 0);
    // One speed per lane, so that cars do not collide.
    const double speed = random.uniform(8.5, 10.5);
    const double crossing_s = (plan.length + 6) / speed;
    for (double start = -crossing_s; start < kTrafficPeriod_s; start += kCarEvery_s) {
      MeshBuilder builder;
      const Material paint = {label::kMovingCar, static_cast<float>(random.uniform(0.12, 0.7))};
      add_car(builder, static_cast<int>(random.uniform(0, 3.99)), paint, RigidTransform{});
      add(builder, drive_through(plan, direction, start + random.uniform(0, 4), speed));
    }
  }
  for (const int side : {1, -1}) {
    Random random = random_of(plan, Purpose::walkers, side > 0 ? 100'001 : 100'000);
    for (const auto& [x0, x1] : stretches(plan, side)) {
      if (x1 - x0 < 4) continue;
      const int people = std::max(1, static_cast<int>((x1 - x0) / kPersonEvery_m));
      for (int k = 0; k < people; ++k)
        add_walker(walk(plan, side, x0, x1, random.uniform(0.9, 1.5), random.uniform()));
    }
  }
  int direction = 1;
  for (double start = 4; start < kTrafficPeriod_s; start += 17, direction = -direction)
    add_walker(cross_road(plan, start, direction));
  return traffic;
}

}  // namespace adasplats
