// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_plan.h"

// Inside synth/: the builders of the parts of a street. Each turns its share of the plan into
// triangles.

namespace adasplats {

/// First words of StreetPlan::random, one for each thing that draws.
enum class Purpose : std::uint64_t {
  ground = 10,
  facade,
  house,
  wall,
  furniture,
  tree,
  hedge,
  bush,
  car,
  traffic,
  walkers,
};

inline Random random_of(const StreetPlan& plan, Purpose purpose, std::uint64_t number) {
  return plan.random(static_cast<std::uint64_t>(purpose), number);
}

/// Coordinates along a wall: `a` along it, `out` away from it towards the street, z up.
struct WallFrame {
  Vec3d origin;
  Vec3d along;
  Vec3d out;

  Vec3d operator()(double a, double outward, double z) const {
    return origin + a * along + outward * out + Vec3d{0, 0, z};
  }
};

/// Road, markings, kerbs, sidewalks, driveways, tree pits, gardens.
void add_ground(const StreetPlan& plan, MeshBuilder& builder);
/// Apartment buildings, the facades that close the view at both ends and up the side streets.
void add_facades(const StreetPlan& plan, MeshBuilder& builder);
/// Detached houses behind their gardens.
void add_houses(const StreetPlan& plan, MeshBuilder& builder);
/// Garden fences and walls, barriers at the kerb.
void add_fences(const StreetPlan& plan, MeshBuilder& builder);
/// Poles, signs, lamps, traffic lights, bollards, benches, bins, shelters.
void add_furniture(const StreetPlan& plan, MeshBuilder& builder);
/// Trees, hedges, bushes.
void add_vegetation(const StreetPlan& plan, MeshBuilder& builder);
/// Parked cars; returns the first instance id that is still free.
std::uint16_t add_parked_cars(const StreetPlan& plan, MeshBuilder& builder);
/// Cars and people on the move, ids from `first_instance`.
std::vector<MovingObject> make_traffic(const StreetPlan& plan, std::uint16_t first_instance);

/// How long make_traffic's movement lasts.
inline constexpr double kTrafficPeriod_s = 240;

/// A fence of upright bars between two rails. `bar` and `rail` are thicknesses.
struct BarFence {
  double height = 1.0;
  double bar_spacing = 0.12;
  double bar = 0.018;
  double rail = 0.04;
  double post_spacing = 2.4;  ///< 0: no posts
  double bottom = 0.12;       ///< of the lower rail above the ground
};

/// Builds a fence from `from` to `to`, both on the ground.
void add_bar_fence(MeshBuilder& builder, Vec3d from, Vec3d to, const BarFence& fence,
                   const Material& material);

/// A car about its own frame: x forward, z up, origin on the ground in the middle. `shape` picks
/// hatchback, saloon, off-roader, van.
void add_car(MeshBuilder& builder, int shape, const Material& paint,
             const RigidTransform& world_from_car);

/// One leaf: a rhombus folded along its middle, so it is two triangles.
void add_leaf(MeshBuilder& builder, Vec3d center, double length_m, Random& random);

/// A trunk or branch that bends: `points` joined by tapering tubes.
void add_limb(MeshBuilder& builder, const std::vector<Vec3d>& points, double radius_from,
              double radius_to, int sides, const Material& material);

/// What a person is, about the ground under the middle, facing +x: legs in stride, body, arms,
/// head.
void add_person(MeshBuilder& builder, double height, const Material& cloth);

enum class SignShape : std::uint8_t { disc, triangle, square, panel };

/// The plate of a traffic sign before a pole that stands at `foot`, looking along `normal`.
void add_sign(MeshBuilder& builder, Vec3d foot, double pole_radius, double center_height,
              Vec3d normal, SignShape shape);

/// Apartment buildings along `wall` until `length` is filled, their doors at `ground_z`.
void add_facade_row(MeshBuilder& builder, WallFrame wall, double length, double ground_z,
                    Random& random);

}  // namespace adasplats
