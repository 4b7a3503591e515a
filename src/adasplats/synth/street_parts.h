// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_plan.h"

// Private to synth/: builders that turn the parts of a street plan into triangles.

namespace adasplats {

/// First keys of StreetPlan::random, one per use.
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

/// Coordinates on a wall: `a` along it, `out` away from it towards the street, z up.
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
/// Apartment buildings, and the facades that close the view at both ends and in side streets.
void add_facades(const StreetPlan& plan, MeshBuilder& builder);
/// Detached houses behind gardens.
void add_houses(const StreetPlan& plan, MeshBuilder& builder);
/// Garden fences and walls, barriers at the kerb.
void add_fences(const StreetPlan& plan, MeshBuilder& builder);
/// Poles, signs, lamps, traffic lights, bollards, benches, bins, shelters.
void add_furniture(const StreetPlan& plan, MeshBuilder& builder);
/// Trees, hedges, bushes.
void add_vegetation(const StreetPlan& plan, MeshBuilder& builder);
/// Parked cars; returns the first unused instance id.
std::uint16_t add_parked_cars(const StreetPlan& plan, MeshBuilder& builder);
/// Moving cars and people; instance ids start at `first_instance`.
std::vector<MovingObject> make_traffic(const StreetPlan& plan, std::uint16_t first_instance);

/// Duration of the movement of make_traffic().
inline constexpr double kTrafficPeriod_s = 240;

/// A fence of vertical bars between two rails. `bar` and `rail` are thicknesses.
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

/// A car in its own frame: x forward, z up, origin on the ground at its center. `shape` selects
/// hatchback, saloon, off-roader or van.
void add_car(MeshBuilder& builder, int shape, const Material& paint,
             const RigidTransform& world_from_car);

/// One leaf: a rhombus folded along its middle, two triangles.
void add_leaf(MeshBuilder& builder, Vec3d center, double length_m, Random& random);

/// A bent trunk or branch: `points` joined by tapering tubes.
void add_limb(MeshBuilder& builder, const std::vector<Vec3d>& points, double radius_from,
              double radius_to, int sides, const Material& material);

/// A person, origin on the ground below the center, facing +x: legs in stride, body, arms, head.
void add_person(MeshBuilder& builder, double height, const Material& cloth);

enum class SignShape : std::uint8_t { disc, triangle, square, panel };

/// The plate of a traffic sign in front of a pole at `foot`, with the given normal.
void add_sign(MeshBuilder& builder, Vec3d foot, double pole_radius, double center_height,
              Vec3d normal, SignShape shape);

/// Apartment buildings along `wall` over `length`, with doors at `ground_z`.
void add_facade_row(MeshBuilder& builder, WallFrame wall, double length, double ground_z,
                    Random& random);

/// A rectangle on a wall.
struct WallRect {
  double a0, a1, z0, z1;
};

/// Fills an opening in a wall.
enum class OpeningKind : std::uint8_t { window, shutters, shop, door, french_window };

/// The rectangle `panel` of a wall with the opening `hole`: wall, reveal, and at its back the pane
/// with its frame, or the door.
void add_wall_with_opening(MeshBuilder& builder, const WallFrame& wall, const WallRect& panel,
                           const WallRect& hole, OpeningKind kind, float wall_reflectance);

/// A balcony at floor height z over [a0, a1]: slab, brackets and a railing of single bars.
void add_balcony(MeshBuilder& builder, const WallFrame& wall, double a0, double a1, double z,
                 double depth);

/// A box in a wall's frame.
void add_wall_box(MeshBuilder& builder, const WallFrame& wall, const WallRect& rect, double out0,
                  double out1, const Material& material);

}  // namespace adasplats
