// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numbers>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

Material with_reflectance(Material material, float reflectance) {
  material.reflectance = reflectance;
  return material;
}

void add_wheel_pairs(MeshBuilder& builder, std::initializer_list<double> axles, double out,
                     double radius, const Material& material) {
  for (const double x : axles)
    for (const double side : {-1.0, 1.0})
      builder.tube({x, side * (out - 0.3), radius}, {x, side * out, radius}, radius, 0.96 * radius,
                   14, with_reflectance(material, 0.07F));
}

/// A truck with a box or a flat bed, optionally with a trailer.
void add_truck(MeshBuilder& builder, const Material& paint, Random& random) {
  const double box = random.uniform(3.2, 4) - 1;
  const bool flat = random.uniform() < 0.2;
  builder.box({2.6, -1.15, 0.5}, {4.4, 1.15, 1.5}, paint);
  builder.box({2.7, -1.15, 1.5}, {4.3, 1.15, random.uniform(2.3, 3)}, paint);
  builder.quad({4.32, -1, 1.5}, {4.32, 1, 1.5}, {4.31, 1, 2.2}, {4.31, -1, 2.2},
               with_reflectance(paint, kCarPane));
  builder.box({-4.4, -0.45, 0.6}, {2.6, 0.45, 0.9}, with_reflectance(paint, 0.12F));
  const Material cargo = with_reflectance(paint, static_cast<float>(random.uniform(0.2, 0.8)));
  if (flat) {
    builder.box({-4.4, -1.22, 0.95}, {2.4, 1.22, 1.1}, cargo);
    builder.box({-3.8, -1.1, 1.1}, {random.uniform(-2, 2), 1.1, random.uniform(1.4, 2.6)}, cargo);
  } else {
    builder.box({-4.4, -1.24, 0.95}, {2.4, 1.24, 0.95 + box}, cargo);
  }
  add_wheel_pairs(builder, {3.3, -2.2, -3.4}, 1.18, 0.48, paint);
  if (random.uniform() < 0.5) return;
  builder.box({-11.4, -1.24, 0.95}, {-5, 1.24, 0.95 + box}, cargo);
  builder.beam({-5.2, 0, 0.8}, {-4.3, 0, 0.8}, 0.06, 0.06, cargo);
  add_wheel_pairs(builder, {-6.2, -9, -10.2}, 1.18, 0.48, paint);
}

void add_bus(MeshBuilder& builder, const Material& paint) {
  const Material glass = with_reflectance(paint, kCarPane);
  const auto ring = [](double x, double half, double low, double high) {
    return std::vector<Vec3d>{{x, half, low},          {x, half, high - 0.25},
                              {x, half - 0.2, high},   {x, -half + 0.2, high},
                              {x, -half, high - 0.25}, {x, -half, low}};
  };
  const std::array<std::vector<Vec3d>, 4> body = {
      ring(-5.9, 1.15, 0.45, 2.9), ring(-5.7, 1.25, 0.32, 3.05), ring(5.6, 1.25, 0.32, 3.05),
      ring(5.95, 1.12, 0.4, 2.85)};
  builder.loft(body, paint);
  for (const double side : {-1.26, 1.26})
    for (double x = -5.3; x < 5.2; x += 1.5)
      builder.quad({x, side, 1.3}, {x + 1.35, side, 1.3}, {x + 1.35, side, 2.5}, {x, side, 2.5},
                   glass);
  builder.quad({6, -1.05, 1.1}, {6, 1.05, 1.1}, {5.98, 1.05, 2.5}, {5.98, -1.05, 2.5}, glass);
  add_wheel_pairs(builder, {3.3, -3.2}, 1.27, 0.48, paint);
}

/// A trailer without its towing vehicle: a box or a caravan.
void add_trailer(MeshBuilder& builder, const Material& paint, Random& random) {
  const bool caravan = random.uniform() < 0.5;
  const double half = caravan ? 2.3 : random.uniform(0.9, 1.6);
  const double top = caravan ? 2.55 : random.uniform(0.9, 1.7);
  builder.box({-half, -1, 0.42}, {half, 1, top}, paint);
  if (caravan)
    for (const double side : {-1.01, 1.01})
      builder.quad({-1.2, side, 1.3}, {1, side, 1.3}, {1, side, 2}, {-1.2, side, 2},
                   with_reflectance(paint, kCarPane));
  builder.beam({half, 0, 0.45}, {half + 1.2, 0, 0.45}, 0.05, 0.05, paint);
  builder.tube({half + 0.9, 0, 0}, {half + 0.9, 0, 0.5}, 0.05, 0.05, 6, paint);
  add_wheel_pairs(builder, {0}, 1.05, 0.32, paint);
}

/// A wheel in side view: a ring of tubes with a few spokes.
void add_spoked_wheel(MeshBuilder& builder, double x, double radius, double tyre,
                      const Material& material) {
  constexpr int kPieces = 14;
  const auto at = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / kPieces;
    return Vec3d{x + radius * std::cos(angle), 0, radius + tyre + radius * std::sin(angle)};
  };
  for (int k = 0; k < kPieces; ++k) builder.tube(at(k), at(k + 1), tyre, tyre, 5, material);
  for (int k = 0; k < kPieces; k += 2)
    builder.beam({x, 0, radius + tyre}, at(k), 0.004, 0.004, material);
}

/// A seated rider: legs bent, body leaning towards the handlebars.
void add_rider(MeshBuilder& builder, double saddle_x, double saddle_z, double lean,
               const Material& cloth) {
  const Vec3d seat = {saddle_x, 0, saddle_z};
  const Vec3d neck = seat + Vec3d{lean, 0, 0.52};
  builder.tube(seat, neck, 0.16, 0.19, 10, cloth);
  builder.ellipsoid(neck, {0.16, 0.21, 0.12}, 6, 10, cloth);
  builder.ellipsoid(neck + Vec3d{0.06, 0, 0.26}, {0.12, 0.11, 0.14}, 6, 10, cloth);
  for (const double side : {-1.0, 1.0}) {
    const Vec3d knee = seat + Vec3d{0.36, 0.15 * side, -0.12 - 0.1 * side};
    builder.tube(seat + Vec3d{0, 0.1 * side, 0}, knee, 0.085, 0.065, 8, cloth);
    builder.tube(knee, knee + Vec3d{-0.15, 0, -0.4}, 0.06, 0.05, 8, cloth);
    builder.tube(neck + Vec3d{0, 0.19 * side, -0.05},
                 {saddle_x + 0.62, 0.25 * side, saddle_z + 0.1}, 0.055, 0.04, 8, cloth);
  }
}

void add_stretched_car(MeshBuilder& builder, const RigidTransform& world_from_vehicle,
                       const Material& paint, Random& random) {
  const double body = random.uniform();
  const int shape = body < 0.55   ? 0  // hatchbacks, the longer ones as estates
                    : body < 0.77 ? 1
                    : body < 0.92 ? 2
                                  : 3;
  const bool estate = shape == 0 && random.uniform() < 0.45;
  builder.set_frame(world_from_vehicle, {(estate ? 1.16 : 1.0) * random.uniform(0.92, 1.08),
                                         random.uniform(0.94, 1.04), random.uniform(0.93, 1.03)});
  add_car(builder, shape, paint, RigidTransform{});
}

}  // namespace

float draw_paint(Random& random) {
  if (random.uniform() < 0.65) return static_cast<float>(random.uniform(0.002, 0.02));
  return static_cast<float>(random.uniform(0.12, 0.75));
}

double vehicle_length(VehicleKind kind) {
  switch (kind) {
    case VehicleKind::car: return 4.4;
    case VehicleKind::truck: return 16;
    case VehicleKind::bus: return 12;
    case VehicleKind::trailer: return 6;
    case VehicleKind::cyclist: return 1.8;
    case VehicleKind::motorcyclist: return 2.2;
    case VehicleKind::walker: return 0.6;
  }
  return 0;
}

void add_bicycle(MeshBuilder& builder, const Material& material) {
  for (const double x : {-0.52, 0.52}) add_spoked_wheel(builder, x, 0.32, 0.02, material);
  const Vec3d crank = {-0.05, 0, 0.3};
  const Vec3d saddle = {-0.2, 0, 0.95};
  const Vec3d head = {0.36, 0, 0.9};
  const Vec3d rear = {-0.52, 0, 0.34};
  const auto bar = [&](Vec3d a, Vec3d b) { builder.tube(a, b, 0.018, 0.018, 6, material); };
  bar(crank, saddle);
  bar(crank, head);
  bar(saddle - Vec3d{-0.03, 0, 0.15}, head);
  bar(crank, rear);
  bar(saddle - Vec3d{-0.03, 0, 0.15}, rear);
  bar({0.52, 0, 0.34}, head);
  bar(head, head + Vec3d{-0.03, 0, 0.15});
  bar(head + Vec3d{-0.03, -0.28, 0.15}, head + Vec3d{-0.03, 0.28, 0.15});
  builder.box(saddle, {0.13, 0, 0}, {0, 0.07, 0}, {0, 0, 0.03}, material);
}

void add_motorcycle(MeshBuilder& builder, const Material& material) {
  for (const double x : {-0.68, 0.68})
    builder.tube({x, -0.07, 0.31}, {x, 0.07, 0.31}, 0.31, 0.31, 14, material);
  builder.ellipsoid({0.15, 0, 0.8}, {0.32, 0.16, 0.17}, 6, 10, material);  // tank
  builder.box({-0.1, 0, 0.48}, {0.32, 0, 0}, {0, 0.17, 0}, {0, 0, 0.2}, material);
  builder.box({-0.45, 0, 0.78}, {0.38, 0, 0}, {0, 0.13, 0}, {0, 0, 0.06}, material);
  builder.tube({0.68, 0, 0.31}, {0.42, 0, 1}, 0.05, 0.05, 8, material);
  builder.beam({0.4, -0.38, 1.03}, {0.4, 0.38, 1.03}, 0.02, 0.02, material);
  builder.box({0.52, 0, 0.88}, {0.06, 0, 0}, {0, 0.12, 0}, {0, 0, 0.12}, material);
}

void add_vehicle(MeshBuilder& builder, VehicleKind kind, const RigidTransform& world_from_vehicle,
                 const Material& material, Random& random) {
  const double scale = random.uniform(0.93, 1.07);
  builder.set_frame(world_from_vehicle, {scale, scale, scale});
  switch (kind) {
    case VehicleKind::car: add_stretched_car(builder, world_from_vehicle, material, random); break;
    case VehicleKind::truck: add_truck(builder, material, random); break;
    case VehicleKind::bus: add_bus(builder, material); break;
    case VehicleKind::trailer: add_trailer(builder, material, random); break;
    case VehicleKind::cyclist:
      add_bicycle(builder, material);
      add_rider(builder, -0.2, 0.98, random.uniform(0.1, 0.35), material);
      break;
    case VehicleKind::motorcyclist:
      add_motorcycle(builder, material);
      add_rider(builder, -0.3, 0.86, random.uniform(0.1, 0.25), material);
      break;
    case VehicleKind::walker: add_person(builder, random.uniform(1.15, 1.95), material); break;
  }
  builder.reset_frame();
}

}  // namespace adasplats
