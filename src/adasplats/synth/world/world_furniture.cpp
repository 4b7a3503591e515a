// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr Vec3d kInGround = {0, 0, -0.4};

Material pole_material(Random& random) {
  return {label::kPole, static_cast<float>(random.uniform(0.15, 0.5))};
}

void add_road_sign(MeshBuilder& builder, double height, Random& random) {
  const double radius = random.uniform(0.025, 0.045);
  builder.tube(kInGround, {0, 0, height}, radius, radius, 8, pole_material(random));
  // Facing oncoming traffic; some face the other way.
  const double yaw = (random.uniform() < 0.8 ? 0 : 3.14159) + 0.2 * random.normal();
  const Vec3d normal = {std::cos(yaw), std::sin(yaw), 0};
  const auto shape = static_cast<SignShape>(static_cast<int>(random.uniform(0, 3.99)));
  add_sign(builder, {}, radius, height - 0.35, normal, shape);
  if (random.uniform() < 0.4)
    add_sign(builder, {}, radius, height - 0.95, normal, SignShape::panel);
}

/// A direction sign on two posts.
void add_sign_board(MeshBuilder& builder, double width, double low, double high, Random& random) {
  const Material steel = pole_material(random);
  for (const double y : {-0.35 * width, 0.35 * width})
    builder.tube({0.05, y, -0.5}, {0.05, y, high}, 0.06, 0.06, 8, steel);
  builder.box({0.1, -0.5 * width, low}, {0.14, 0.5 * width, high}, {label::kTrafficSign, 0.9F});
}

void add_power_pole(MeshBuilder& builder, double height, const Material& wood) {
  builder.tube({0, 0, -0.5}, {0, 0, height}, 0.15, 0.1, 10, wood);
  builder.beam({0, -0.9, height - 0.5}, {0, 0.9, height - 0.5}, 0.06, 0.06, wood);
  for (const double y : {-0.8, 0.0, 0.8})
    builder.tube({0, y, height - 0.45}, {0, y, height - 0.2}, 0.04, 0.04, 6, wood);
}

void add_small_bollard(MeshBuilder& builder, double height, double radius, Random& random) {
  builder.tube(kInGround, {0, 0, height}, radius, 0.9 * radius, 8, pole_material(random));
}

/// Street objects of class other-object: bin, cabinet, letter box, bench, planter.
void add_street_box(MeshBuilder& builder, Random& random) {
  const Material material = {label::kOtherObject, static_cast<float>(random.uniform(0.15, 0.6))};
  const double draw = random.uniform();
  if (draw < 0.4) {  // bins on wheels
    const int bins = 1 + static_cast<int>(random.uniform(0, 2.99));
    for (int k = 0; k < bins; ++k)
      builder.box({0.65 * k, -0.33, 0.05}, {0.65 * k + 0.55, 0.33, random.uniform(0.9, 1.15)},
                  material);
  } else if (draw < 0.65) {
    builder.box({-0.5, -0.18, -0.2}, {0.5, 0.18, random.uniform(0.8, 1.5)}, material);
  } else if (draw < 0.8) {
    add_world_bench(builder, material);
  } else {
    builder.box({-0.6, -0.3, -0.1}, {0.6, 0.3, 0.5}, material);
  }
}

/// A glass shelter with a bench.
void add_shelter(MeshBuilder& builder) {
  constexpr Material kFrame = {label::kOtherStructure, 0.4F};
  constexpr Material kPane = {label::kOtherStructure, kDarkPane};
  builder.box({-2, -0.8, 2.4}, {2, 0.8, 2.5}, kFrame);
  for (const double x : {-1.9, 1.9})
    builder.beam({x, 0.6, -0.2}, {x, 0.6, 2.4}, 0.04, 0.04, kFrame);
  builder.box({-1.9, 0.6, 0.2}, {1.9, 0.61, 2.3}, kPane);
  builder.box({1.89, -0.5, 0.2}, {1.9, 0.6, 2.3}, kPane);
  builder.box({-1.2, 0.2, 0.42}, {1.2, 0.5, 0.47}, kFrame);
}

/// Adds objects along one side, where no driveway or street crosses.
class Furnisher {
 public:
  Furnisher(const WorldPlan& plan, MeshBuilder& builder, int side)
      : plan_(plan),
        builder_(builder),
        side_(side),
        random_(random_of(plan, WorldPurpose::furniture, side > 0 ? 1 : 0)) {}

  template <class Add>
  void along(double in_100_m, double room, double from_axis, Add add) {
    for (const double s : positions_along(plan_, in_100_m, room, random_)) {
      if (plan_.is_open(side_, s - 0.4, s + 0.4)) continue;
      builder_.set_frame(plan_.pose_at(s, side_, from_axis));
      add(builder_, random_);
    }
    builder_.reset_frame();
  }
  Random& random() { return random_; }

 private:
  const WorldPlan& plan_;
  MeshBuilder& builder_;
  int side_;
  Random random_;
};

void furnish_sidewalk(const WorldPlan& plan, MeshBuilder& builder, int side) {
  const SideStyle& own = plan.side(side);
  Furnisher furnish(plan, builder, side);
  Random& random = furnish.random();
  const double kerb = plan.road_end(side) + (own.kerb > 0 ? 0.35 : 0.9);
  const double back = plan.property_line(side) + (own.sidewalk > 0 ? -0.25 : 0.6);
  const double lamp_line = random.uniform() < 0.6 ? kerb : back;
  const double height = random.uniform(3.5, 9);
  const double arm = random.uniform() < 0.6 ? random.uniform(0.4, 1.8) : 0;
  const double radius = random.uniform(0.04, 0.09);
  const Material steel = pole_material(random);
  furnish.along(own.lamps, 8, lamp_line,
                [&](MeshBuilder& b, Random&) { add_street_lamp(b, height, arm, radius, steel); });
  furnish.along(own.signs, 3, kerb + 0.05, [](MeshBuilder& b, Random& draw) {
    add_road_sign(b, draw.uniform(1.9, 3.1), draw);
  });
  const double post = random.uniform(0.5, 1.1);
  const double thick = random.uniform(0.035, 0.09);
  furnish.along(own.bollards, 1.3, kerb - 0.05,
                [&](MeshBuilder& b, Random& draw) { add_small_bollard(b, post, thick, draw); });
  furnish.along(own.boxes, 2, back, [](MeshBuilder& b, Random& draw) { add_street_box(b, draw); });
  if (own.power_line) {
    const double tall = random.uniform(6.5, 9);
    const Material wood = {label::kPole, 0.35F};
    furnish.along(random.uniform(2, 4), 18, back + 0.5,
                  [&](MeshBuilder& b, Random&) { add_power_pole(b, tall, wood); });
  }
  furnish.along(plan.style.tram, 15, kerb, [&](MeshBuilder& b, Random& draw) {
    b.tube(kInGround, {0, 0, 7.5}, 0.14, 0.09, 10, steel);
    b.beam({0, 0, 6.2}, {0, -draw.uniform(3, 6), 6.5}, 0.03, 0.03, steel);
  });
  if (own.sidewalk > 2 && plan.style.buses > 0)
    furnish.along(0.5, 40, back - 0.4, [](MeshBuilder& b, Random&) { add_shelter(b); });
}

/// Traffic lights before a joining street: on a post, some also on an arm over the road.
void add_lights(const WorldPlan& plan, MeshBuilder& builder) {
  Random random = random_of(plan, WorldPurpose::signs, 1);
  const bool over_road = random.uniform() < 0.5;
  const Material steel = pole_material(random);
  constexpr Material kHead = {label::kOtherObject, 0.25F};
  for (const Patch& patch : plan.patches) {
    if (patch.ground != Ground::road || !patch.crosses_sidewalk) continue;
    for (const double s : {patch.s0 - 1.2, patch.s1 + 1.2}) {
      builder.set_frame(plan.pose_at(s, patch.side, patch.d0 + 0.5));
      const double tall = over_road ? 5.8 : 3.4;
      builder.tube(kInGround, {0, 0, tall}, 0.07, 0.06, 10, steel);
      builder.box({0.1, -0.15, 2.3}, {0.32, 0.15, 3.2}, kHead);
      if (!over_road) continue;
      builder.tube({0, 0, tall - 0.2}, {0, -3, tall}, 0.05, 0.04, 8, steel);
      builder.box({0.05, -3, tall - 0.9}, {0.27, -2.7, tall}, kHead);
    }
  }
  builder.reset_frame();
}

void furnish_motorway(const WorldPlan& plan, MeshBuilder& builder) {
  for (const int side : {1, -1}) {
    Furnisher furnish(plan, builder, side);
    furnish.along(1.2, 30, plan.road_end(side) + 2, [](MeshBuilder& b, Random& draw) {
      const double low = draw.uniform(1.5, 2.5);
      add_sign_board(b, draw.uniform(1.5, 4), low, low + draw.uniform(0.8, 2.5), draw);
    });
  }
  Random random = random_of(plan, WorldPurpose::signs, 0);
  for (const double s : positions_along(plan, plan.style.gantries, 40, random)) {
    const Material steel = {label::kPole, 0.4F};
    for (const int side : {1, -1}) {
      const double reach = plan.road_end(side) + 1.2;
      builder.set_frame(plan.pose_at(s, side, reach));
      builder.box({-0.2, -0.2, -0.5}, {0.2, 0.2, 6.5}, steel);
      builder.beam({0, 0, 6.2}, {0, -reach, 6.2}, 0.2, 0.3, steel);
      for (int lane = 0; lane < plan.style.lanes; ++lane) {
        const double y = plan.lane_center(lane) - reach;
        builder.box({0.25, y - 1.5, 5.4}, {0.32, y + 1.5, 7.2}, {label::kTrafficSign, 0.9F});
      }
    }
  }
  builder.reset_frame();
}

}  // namespace

void add_world_bench(MeshBuilder& builder, const Material& material) {
  builder.box({-0.85, -0.2, 0.42}, {0.85, 0.2, 0.48}, material);
  builder.box({-0.85, 0.2, 0.5}, {0.85, 0.25, 0.9}, material);
  for (const double x : {-0.7, 0.7})
    builder.box({x - 0.04, -0.2, -0.2}, {x + 0.04, 0.2, 0.42}, material);
}

void add_street_lamp(MeshBuilder& builder, double height, double arm, double radius,
                     const Material& material) {
  const Vec3d top = {0, 0, height};
  builder.tube(kInGround, {0, 0, 1}, 1.5 * radius, 1.4 * radius, 10, material);
  builder.tube({0, 0, 1}, top, radius, 0.6 * radius, 10, material);
  if (arm <= 0) {  // a lantern
    builder.tube(top, top + Vec3d{0, 0, 0.5}, 0.12, 0.22, 8, material);
    return;
  }
  const Vec3d end = top + Vec3d{0, -arm, 0.3};
  builder.tube(top, end, 0.035, 0.03, 8, material);
  builder.ellipsoid(end - Vec3d{0, 0.25, 0}, {0.13, 0.38, 0.08}, 5, 10, material);
}

void add_world_furniture(const WorldPlan& plan, MeshBuilder& builder) {
  for (const int side : {1, -1}) furnish_sidewalk(plan, builder, side);
  if (plan.style.lights) add_lights(plan, builder);
  if (plan.options.kind == WorldKind::motorway) furnish_motorway(plan, builder);
}

}  // namespace adasplats
