// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

/// A cross-section of a body: position along the car, heights and half width.
struct Station {
  double x, bottom, top, half_width;
};

/// Side view of a car: stations of the body up to the windows, then the outline of the cabin.
struct CarShape {
  std::vector<Station> body;
  double cabin_rear_low, cabin_rear_high, cabin_front_high, cabin_front_low;  // x
  double belt, roof;                                                          // z
  double cabin_half_width;
  double front_axle, rear_axle, wheel_radius;
};

CarShape hatchback() {
  return {.body = {{-1.98, 0.42, 0.66, 0.66},
                   {-1.9, 0.3, 0.9, 0.78},
                   {-1.5, 0.24, 0.94, 0.85},
                   {-0.4, 0.22, 0.93, 0.87},
                   {0.7, 0.22, 0.92, 0.87},
                   {1.3, 0.24, 0.84, 0.84},
                   {1.85, 0.3, 0.7, 0.76},
                   {2.0, 0.4, 0.58, 0.64}},
          .cabin_rear_low = -1.88,
          .cabin_rear_high = -1.45,
          .cabin_front_high = 0.05,
          .cabin_front_low = 0.85,
          .belt = 0.92,
          .roof = 1.46,
          .cabin_half_width = 0.8,
          .front_axle = 1.25,
          .rear_axle = -1.25,
          .wheel_radius = 0.31};
}

CarShape saloon() {
  return {.body = {{-2.25, 0.45, 0.7, 0.68},
                   {-2.15, 0.3, 0.93, 0.8},
                   {-1.5, 0.24, 0.96, 0.87},
                   {-0.4, 0.22, 0.93, 0.89},
                   {0.8, 0.22, 0.91, 0.89},
                   {1.5, 0.24, 0.84, 0.86},
                   {2.1, 0.3, 0.68, 0.78},
                   {2.28, 0.4, 0.56, 0.66}},
          .cabin_rear_low = -1.65,
          .cabin_rear_high = -0.95,
          .cabin_front_high = 0.15,
          .cabin_front_low = 1.0,
          .belt = 0.93,
          .roof = 1.43,
          .cabin_half_width = 0.8,
          .front_axle = 1.4,
          .rear_axle = -1.38,
          .wheel_radius = 0.32};
}

CarShape off_roader() {
  return {.body = {{-2.15, 0.5, 0.85, 0.74},
                   {-2.08, 0.4, 1.06, 0.85},
                   {-1.5, 0.33, 1.08, 0.92},
                   {-0.4, 0.32, 1.07, 0.93},
                   {0.8, 0.32, 1.06, 0.93},
                   {1.5, 0.33, 1.0, 0.91},
                   {2.05, 0.4, 0.9, 0.84},
                   {2.18, 0.5, 0.74, 0.72}},
          .cabin_rear_low = -2.05,
          .cabin_rear_high = -1.75,
          .cabin_front_high = 0.2,
          .cabin_front_low = 0.9,
          .belt = 1.06,
          .roof = 1.7,
          .cabin_half_width = 0.85,
          .front_axle = 1.35,
          .rear_axle = -1.35,
          .wheel_radius = 0.36};
}

CarShape van() {
  return {.body = {{-2.35, 0.5, 1.0, 0.86},
                   {-2.3, 0.4, 1.18, 0.92},
                   {-1.5, 0.3, 1.2, 0.95},
                   {-0.4, 0.28, 1.2, 0.95},
                   {1.2, 0.28, 1.18, 0.95},
                   {1.8, 0.3, 1.05, 0.93},
                   {2.3, 0.36, 0.9, 0.86},
                   {2.42, 0.46, 0.74, 0.74}},
          .cabin_rear_low = -2.3,
          .cabin_rear_high = -2.2,
          .cabin_front_high = 1.0,
          .cabin_front_low = 1.75,
          .belt = 1.18,
          .roof = 1.95,
          .cabin_half_width = 0.91,
          .front_axle = 1.5,
          .rear_axle = -1.45,
          .wheel_radius = 0.33};
}

CarShape shape_of(int number) {
  switch (number % 4) {
    case 0: return hatchback();
    case 1: return saloon();
    case 2: return off_roader();
    default: return van();
  }
}

void add_body(MeshBuilder& builder, const CarShape& car, const Material& paint,
              const RigidTransform& world_from_car) {
  std::vector<std::vector<Vec3d>> rings;
  for (const Station& s : car.body) {
    const double shoulder = s.bottom + 0.62 * (s.top - s.bottom);
    const double sill = s.bottom + 0.18 * (s.top - s.bottom);
    const std::array<std::array<double, 2>, 5> half = {{{0.86 * s.half_width, s.bottom},
                                                        {0.98 * s.half_width, sill},
                                                        {s.half_width, shoulder},
                                                        {0.94 * s.half_width, s.top - 0.03},
                                                        {0.8 * s.half_width, s.top}}};
    std::vector<Vec3d> ring;
    ring.reserve(2 * half.size());
    for (const auto& [y, z] : half) ring.push_back(world_from_car * Vec3d{s.x, y, z});
    for (std::size_t k = half.size(); k-- > 0;)
      ring.push_back(world_from_car * Vec3d{s.x, -half[k][0], half[k][1]});
    rings.push_back(ring);
  }
  builder.loft(rings, paint);
}

/// Glass from the belt to the roof, and the roof, in three levels so that the sides curve inwards.
void add_cabin(MeshBuilder& builder, const CarShape& car, const Material& paint,
               const RigidTransform& world_from_car) {
  Material glass = paint;
  glass.reflectance = 0.1F;
  const auto ring = [&](double share, double z) {
    const double rear = car.cabin_rear_low + share * (car.cabin_rear_high - car.cabin_rear_low);
    const double front = car.cabin_front_low + share * (car.cabin_front_high - car.cabin_front_low);
    const double half = car.cabin_half_width * (1 - 0.2 * share);
    return std::vector<Vec3d>{
        world_from_car * Vec3d{rear, half, z},      world_from_car * Vec3d{front, half, z},
        world_from_car * Vec3d{front + 0.06, 0, z}, world_from_car * Vec3d{front, -half, z},
        world_from_car * Vec3d{rear, -half, z},     world_from_car * Vec3d{rear - 0.06, 0, z}};
  };
  const double glass_top = car.roof - 0.1;
  const std::array<std::vector<Vec3d>, 2> windows = {ring(0, car.belt - 0.04),
                                                     ring(0.85, glass_top)};
  builder.loft(windows, glass);
  const std::array<std::vector<Vec3d>, 3> roof = {ring(0.85, glass_top), ring(1.0, car.roof - 0.04),
                                                  ring(1.35, car.roof)};
  builder.loft(roof, paint);
}

void add_wheels(MeshBuilder& builder, const CarShape& car, const Material& paint,
                const RigidTransform& world_from_car) {
  Material tyre = paint;
  tyre.reflectance = 0.08F;
  const double out = car.body[3].half_width - 0.02;
  for (const double x : {car.front_axle, car.rear_axle}) {
    for (const double side : {-1.0, 1.0}) {
      const double z = car.wheel_radius;
      builder.tube(world_from_car * Vec3d{x, side * (out - 0.2), z},
                   world_from_car * Vec3d{x, side * out, z}, car.wheel_radius,
                   car.wheel_radius * 0.96, 18, tyre);
    }
  }
}

}  // namespace

void add_car(MeshBuilder& builder, int shape, const Material& paint,
             const RigidTransform& world_from_car) {
  const CarShape car = shape_of(shape);
  add_body(builder, car, paint, world_from_car);
  add_cabin(builder, car, paint, world_from_car);
  add_wheels(builder, car, paint, world_from_car);
  for (const double side : {-1.0, 1.0}) {  // mirrors
    const Vec3d middle = {car.cabin_front_low - 0.25, side * (car.cabin_half_width + 0.14),
                          car.belt + 0.06};
    const Mat3d& r = world_from_car.rotation;
    builder.box(world_from_car * middle, r * Vec3d{0.05, 0, 0}, r * Vec3d{0, 0.1, 0},
                r * Vec3d{0, 0, 0.07}, paint);
  }
}

std::uint16_t add_parked_cars(const StreetPlan& plan, MeshBuilder& builder) {
  std::uint16_t instance = 1;
  for (const Item& item : plan.items) {
    if (item.kind != ItemKind::parked_car) continue;
    Random random = random_of(plan, Purpose::car, item.number);
    const double y = item.side * (kParkingCenter + random.uniform(-0.1, 0.1));
    const bool backwards = random.uniform() < 0.1;
    const double yaw = (item.side > 0) != backwards ? std::numbers::pi : 0.0;
    const RigidTransform world_from_car = {
        rotation_from_yaw_pitch_roll(yaw + random.uniform(-0.02, 0.02), 0, 0),
        {item.x, y, road_height(item.x, y)}};
    const Material paint = {label::kCar, static_cast<float>(random.uniform(0.12, 0.7)), instance};
    add_car(builder, static_cast<int>(random.uniform(0, 3.99)), paint, world_from_car);
    ++instance;
  }
  return instance;
}

}  // namespace adasplats
