// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_parts.h"
#include "adasplats/synth/world/world_plan.h"

// Inside synth/world/: the builders of the parts of a world, each of which turns its share of the
// plan into triangles, and the shapes that several of them use.

namespace adasplats {

/// First words of WorldPlan::random, one for each thing that draws.
enum class WorldPurpose : std::uint64_t {
  ground = 20,
  house,
  edge,
  garden,
  trees,
  furniture,
  signs,
  parked,
  standing,
  traffic,
  walls,
  edges_plants,
  grass,
  behind,
  islands,
};

inline Random random_of(const WorldPlan& plan, WorldPurpose purpose, std::uint64_t number) {
  return plan.random(static_cast<std::uint64_t>(purpose), number);
}

void add_world_ground(const WorldPlan& plan, MeshBuilder& builder);
/// Houses with garages and sheds, rows of facades.
void add_world_buildings(const WorldPlan& plan, MeshBuilder& builder);
/// Fences, garden walls and hedges, guard rails, noise walls.
void add_world_edges(const WorldPlan& plan, MeshBuilder& builder);
/// Trees, bushes, woods, tall grass.
void add_world_plants(const WorldPlan& plan, MeshBuilder& builder);
/// Lamps, signs, power and tram poles, bollards, boxes, gantries.
void add_world_furniture(const WorldPlan& plan, MeshBuilder& builder);
/// Parked vehicles, bicycles, people that stand; ids from 1. Returns the first that is free.
std::uint16_t add_world_standing(const WorldPlan& plan, MeshBuilder& builder);
/// What moves, ids from `first_instance`.
std::vector<MovingObject> make_world_traffic(const WorldPlan& plan, std::uint16_t first_instance);

/// Reflectances of panes: returns of them are often lost.
inline constexpr float kDarkPane = 0.09F, kCarPane = 0.1F;

/// A random number of things in 100 m becomes their places along a side, at least `room` apart.
std::vector<double> places_along(const WorldPlan& plan, double in_100_m, double room,
                                 Random& random);

/// A hedge from `from` to `to`, both on the ground, of leaves about a core.
void add_leafy_hedge(MeshBuilder& builder, Vec3d from, Vec3d to, double height, double thickness,
                     Random& random);
/// About the origin of the builder's frame.
void add_leafy_bush(MeshBuilder& builder, double radius, double height, Random& random);

/// Buildings along the streets that cross at both ends of a road, behind its outermost plots.
void add_corner_rows(const WorldPlan& plan, MeshBuilder& builder);

/// A tree high enough to walk under.
void plant_park_tree(const WorldPlan& plan, MeshBuilder& builder, double s, int side,
                     double from_axis, Random& random);

/// In the builder's frame; -y is towards the road. Without an arm (0 m) it is a lantern.
void add_street_lamp(MeshBuilder& builder, double height, double arm, double radius,
                     const Material& material);
/// In the builder's frame, along x; who sits on it looks to -y.
void add_world_bench(MeshBuilder& builder, const Material& material);

/// What drives, about its own frame: x forward, z up, origin on the ground in the middle.
enum class VehicleKind : std::uint8_t { car, truck, bus, trailer, cyclist, motorcyclist, walker };
/// How long one is, m.
double vehicle_length(VehicleKind kind);
void add_vehicle(MeshBuilder& builder, VehicleKind kind, const RigidTransform& world_from_vehicle,
                 const Material& material, Random& random);
/// A bicycle or motorcycle without its rider, in the builder's frame.
void add_bicycle(MeshBuilder& builder, const Material& material);
void add_motorcycle(MeshBuilder& builder, const Material& material);

/// Reflectance of paint: most of it throws the beam away.
float draw_paint(Random& random);

}  // namespace adasplats
