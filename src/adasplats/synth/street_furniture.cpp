// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr Material kGalvanised = {label::kPole, 0.45F};
constexpr Material kDarkPaint = {label::kPole, 0.2F};
constexpr Material kSignFace = {label::kTrafficSign, 0.92F};  // retroreflective sheeting
constexpr Material kWood = {label::kOtherObject, 0.35F};
constexpr Material kSteel = {label::kOtherObject, 0.28F};
constexpr double kFootDepth = 0.1;  // feet are below the ground

Vec3d foot_of(const Item& item, double line) {
  const double y = item.side * line;
  return {item.x, y, sidewalk_height(item.x, y)};
}

/// The normal of a sign that faces the drivers on this side.
Vec3d facing_traffic(int side, double yaw) {
  // On the right (y < 0) cars drive towards +x.
  const double x = side > 0 ? 1.0 : -1.0;
  return {x * std::cos(yaw), std::sin(yaw), 0};
}

/// A flat plate with `corners` corners, 1 cm thick, in front of its pole.
void add_plate(MeshBuilder& builder, Vec3d center, Vec3d normal, double half_width,
               double half_height, int corners, double first_angle) {
  const Vec3d across = {-normal.y, normal.x, 0};
  std::array<std::vector<Vec3d>, 2> faces;
  for (std::size_t f = 0; f < 2; ++f) {
    for (int k = 0; k < corners; ++k) {
      const double angle = first_angle + 2 * std::numbers::pi * k / corners;
      faces[f].push_back(center + across * (half_width * std::cos(angle)) +
                         Vec3d{0, 0, half_height * std::sin(angle)} +
                         normal * (f == 0 ? -0.005 : 0.005));
    }
  }
  builder.loft(faces, kSignFace);
}

}  // namespace

void add_sign(MeshBuilder& builder, Vec3d foot, double pole_radius, double center_height,
              Vec3d normal, SignShape shape) {
  constexpr double kUp = 0.5 * std::numbers::pi;
  constexpr double kDiagonal = 0.25 * std::numbers::pi;
  const Vec3d center = foot + Vec3d{0, 0, center_height} + normal * (pole_radius + 0.02);
  switch (shape) {
    case SignShape::disc: add_plate(builder, center, normal, 0.36, 0.36, 20, 0); break;
    case SignShape::triangle: add_plate(builder, center, normal, 0.42, 0.42, 3, kUp); break;
    case SignShape::square: add_plate(builder, center, normal, 0.45, 0.45, 4, kDiagonal); break;
    case SignShape::panel:  // half edges of a rectangle: its half diagonals over sqrt(2)
      add_plate(builder, center, normal, 0.42, 0.2, 4, kDiagonal);
      break;
  }
}

namespace {

void add_sign_pole(const StreetPlan& plan, MeshBuilder& builder, const Item& item) {
  Random random = random_of(plan, Purpose::furniture, item.number);
  const Vec3d foot = foot_of(item, kFurnitureLine);
  const double height = random.uniform(2.7, 3.2);
  const double radius = random.uniform(0.03, 0.042);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, height}, radius, radius, 12,
               kGalvanised);
  const Vec3d normal = facing_traffic(item.side, random.uniform(-0.15, 0.15));
  const auto shape = static_cast<SignShape>(static_cast<int>(random.uniform(0, 2.99)));
  add_sign(builder, foot, radius, height - 0.4, normal, shape);
  if (random.uniform() < 0.7)
    add_sign(builder, foot, radius, height - 1.05, normal, SignShape::panel);
}

void add_crossing_sign(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 2.9}, 0.038, 0.038, 12,
               kGalvanised);
  add_sign(builder, foot, 0.038, 2.45, facing_traffic(item.side, 0), SignShape::square);
}

void add_pole(const StreetPlan& plan, MeshBuilder& builder, const Item& item) {
  Random random = random_of(plan, Purpose::furniture, item.number);
  const Vec3d foot = foot_of(item, kFurnitureLine);
  const double height = random.uniform(5.5, 7.5);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, height}, 0.1, 0.06, 12,
               kGalvanised);
  builder.box(foot + Vec3d{0, 0, 3.2}, {0.12, 0, 0}, {0, 0.1, 0}, {0, 0, 0.22}, kGalvanised);
}

void add_lamp(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine);
  const double to_road = -item.side;
  const double height = 7.2;
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 1.2}, 0.11, 0.1, 12, kDarkPaint);
  builder.tube(foot + Vec3d{0, 0, 1.2}, foot + Vec3d{0, 0, height}, 0.075, 0.05, 12, kDarkPaint);
  // The arm: a quarter arc, then a straight part.
  Vec3d from = foot + Vec3d{0, 0, height};
  for (int k = 1; k <= 4; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / 4;
    const Vec3d to =
        foot + Vec3d{0, to_road * 0.7 * (1 - std::cos(angle)), height + 0.7 * std::sin(angle)};
    builder.tube(from, to, 0.045, 0.045, 10, kDarkPaint);
    from = to;
  }
  const Vec3d head = from + Vec3d{0, to_road * 0.9, 0};
  builder.tube(from, head, 0.04, 0.035, 10, kDarkPaint);
  builder.ellipsoid(head + Vec3d{0, to_road * 0.25, -0.03}, {0.14, 0.38, 0.09}, 6, 12, kDarkPaint);
}

void add_traffic_light(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine);
  const Vec3d normal = facing_traffic(item.side, 0);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 3.3}, 0.06, 0.055, 12,
               kDarkPaint);
  const Vec3d head = foot + Vec3d{0, 0, 2.8} + normal * 0.2;
  builder.box(head, {0.1, 0, 0}, {0, 0.15, 0}, {0, 0, 0.45}, kSteel);
  for (int k = -1; k <= 1; ++k) {  // hoods over the lamps
    const Vec3d lamp = head + normal * 0.1 + Vec3d{0, 0, 0.28 * k};
    builder.tube(lamp, lamp + normal * 0.14, 0.1, 0.1, 10, kSteel);
  }
  builder.box(foot + Vec3d{0, -0.12 * item.side, 1.1}, {0.06, 0, 0}, {0, 0.06, 0}, {0, 0, 0.12},
              kSteel);  // the pedestrians' button
}

void add_bench(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine + 0.15);
  const double away = item.side;
  for (int k = 0; k < 4; ++k)
    builder.box(foot + Vec3d{0, -0.15 + 0.12 * k, 0.45}, {0.85, 0, 0}, {0, 0.045, 0}, {0, 0, 0.02},
                kWood);
  for (int k = 0; k < 3; ++k)
    builder.box(foot + Vec3d{0, -away * 0.24, 0.58 + 0.13 * k}, {0.85, 0, 0}, {0, 0.015, 0},
                {0, 0, 0.045}, kWood);
  for (const double x : {-0.7, 0.7}) {
    builder.box(foot + Vec3d{x, 0, 0.2}, {0.03, 0, 0}, {0, 0.2, 0}, {0, 0, 0.22}, kSteel);
    builder.box(foot + Vec3d{x, -away * 0.22, 0.6}, {0.03, 0, 0}, {0, 0.02, 0}, {0, 0, 0.3},
                kSteel);
  }
}

void add_bin(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 1.05}, 0.03, 0.03, 8, kSteel);
  const Vec3d bag = foot + Vec3d{0, item.side * 0.25, 0};
  builder.tube(bag + Vec3d{0, 0, 0.25}, bag + Vec3d{0, 0, 0.95}, 0.19, 0.23, 14, kSteel);
}

void add_advertising_column(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kTreeLine);
  constexpr Material kPoster = {label::kOtherObject, 0.5F};
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 0.35}, 0.72, 0.72, 24, kSteel);
  builder.tube(foot + Vec3d{0, 0, 0.35}, foot + Vec3d{0, 0, 3.0}, 0.62, 0.62, 24, kPoster);
  builder.tube(foot + Vec3d{0, 0, 3.0}, foot + Vec3d{0, 0, 3.15}, 0.8, 0.75, 24, kSteel);
  builder.ellipsoid(foot + Vec3d{0, 0, 3.1}, {0.65, 0.65, 0.6}, 8, 24, kSteel);
}

/// Roof on four posts, glass at the back and at one end, a bench inside.
void add_bus_shelter(MeshBuilder& builder, const Item& item) {
  constexpr Material kShelter = {label::kOtherStructure, 0.4F};
  constexpr Material kPane = {label::kOtherStructure, 0.12F};
  const double x1 = item.x + item.length;
  const double front = item.side * (kRoadHalfWidth + 0.9);
  const double back = item.side * (kRoadHalfWidth + 1.9);
  const double low = std::min(front, back);
  const double high = std::max(front, back);
  const double z = sidewalk_height(item.x, back);
  builder.box({item.x - 0.2, low - 0.2, z + 2.45}, {x1 + 0.2, high + 0.2, z + 2.57}, kShelter);
  for (const double x : {item.x, x1})
    for (const double y : {front, back})
      builder.beam({x, y, z - kFootDepth}, {x, y, z + 2.45}, 0.04, 0.04, kShelter);
  builder.box({item.x + 0.05, back - 0.005, z + 0.2}, {x1 - 0.05, back + 0.005, z + 2.3}, kPane);
  builder.box({x1 - 0.005, low + 0.05, z + 0.2}, {x1 + 0.005, high - 0.05, z + 2.3}, kPane);
  const double seat = back - item.side * 0.35;
  builder.box({item.x + 0.5, seat - 0.18, z + 0.44}, {x1 - 0.5, seat + 0.18, z + 0.48}, kShelter);
}

void add_cabinet(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kFurnitureLine + 0.1);
  constexpr Material kPlastic = {label::kOtherObject, 0.45F};
  builder.box(foot + Vec3d{0, 0, 0.6}, {0.5, 0, 0}, {0, 0.17, 0}, {0, 0, 0.65}, kPlastic);
  builder.box(foot + Vec3d{0, 0, 1.27}, {0.53, 0, 0}, {0, 0.2, 0}, {0, 0, 0.02}, kPlastic);
}

void add_bollard(MeshBuilder& builder, const Item& item) {
  const Vec3d foot = foot_of(item, kRoadHalfWidth + 0.4);
  builder.tube(foot - Vec3d{0, 0, kFootDepth}, foot + Vec3d{0, 0, 0.95}, 0.055, 0.055, 12,
               kDarkPaint);
  builder.ellipsoid(foot + Vec3d{0, 0, 0.98}, {0.07, 0.07, 0.07}, 6, 12, kDarkPaint);
}

}  // namespace

void add_furniture(const StreetPlan& plan, MeshBuilder& builder) {
  for (const Item& item : plan.items) {
    switch (item.kind) {
      case ItemKind::pole: add_pole(plan, builder, item); break;
      case ItemKind::sign_pole: add_sign_pole(plan, builder, item); break;
      case ItemKind::crossing_sign: add_crossing_sign(builder, item); break;
      case ItemKind::traffic_light: add_traffic_light(builder, item); break;
      case ItemKind::lamp: add_lamp(builder, item); break;
      case ItemKind::bollard: add_bollard(builder, item); break;
      case ItemKind::bench: add_bench(builder, item); break;
      case ItemKind::bin: add_bin(builder, item); break;
      case ItemKind::advertising_column: add_advertising_column(builder, item); break;
      case ItemKind::bus_shelter: add_bus_shelter(builder, item); break;
      case ItemKind::cabinet: add_cabinet(builder, item); break;
      case ItemKind::tree:        // street_vegetation.cpp
      case ItemKind::barrier:     // street_fences.cpp
      case ItemKind::parked_car:  // street_vehicles.cpp
        break;
    }
  }
}

}  // namespace adasplats
