// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/street_parts.h"
#include "adasplats/synth/street_scan.h"
#include "adasplats/synth/world/world_plan.h"

// Private to synth/: builders that turn the parts of a world plan into triangles, and shapes that
// several of them use.

namespace adasplats {

/// First keys of WorldPlan::random, one per use.
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
/// Parked vehicles, bicycles and standing people; ids start at 1. Returns the first unused one.
std::uint16_t add_world_objects(const WorldPlan& plan, MeshBuilder& builder);
/// Movers; instance ids start at `first_instance`.
std::vector<MovingObject> make_world_traffic(const WorldPlan& plan, std::uint16_t first_instance);

/// Reflectances of panes, which often lose returns.
inline constexpr float kDarkPane = 0.09F, kCarPane = 0.1F;

/// Draws the positions of objects along a side from their density, at least `room` apart.
std::vector<double> positions_along(const WorldPlan& plan, double in_100_m, double room,
                                    Random& random);

/// A hedge of leaves around a core from `from` to `to`, both on the ground.
void add_leafy_hedge(MeshBuilder& builder, Vec3d from, Vec3d to, double height, double thickness,
                     Random& random);
/// At the origin of the builder's frame.
void add_leafy_bush(MeshBuilder& builder, double radius, double height, Random& random);

/// Buildings along the cross streets at both ends of a road, behind its outermost plots.
void add_corner_rows(const WorldPlan& plan, MeshBuilder& builder);

/// A tree with a crown high enough to walk under.
void plant_park_tree(const WorldPlan& plan, MeshBuilder& builder, double s, int side,
                     double from_axis, Random& random);

/// In the builder's frame; -y is towards the road. A lantern if the arm is 0 m long.
void add_street_lamp(MeshBuilder& builder, double height, double arm, double radius,
                     const Material& material);
/// In the builder's frame, along x, facing -y.
void add_world_bench(MeshBuilder& builder, const Material& material);

/// A mover in its own frame: x forward, z up, origin on the ground at its center.
enum class VehicleKind : std::uint8_t { car, truck, bus, trailer, cyclist, motorcyclist, walker };
/// Length of a vehicle, m.
double vehicle_length(VehicleKind kind);
void add_vehicle(MeshBuilder& builder, VehicleKind kind, const RigidTransform& world_from_vehicle,
                 const Material& material, Random& random);
/// A bicycle or motorcycle without its rider, in the builder's frame.
void add_bicycle(MeshBuilder& builder, const Material& material);
void add_motorcycle(MeshBuilder& builder, const Material& material);

/// Reflectance of paint; most paint is specular.
float draw_paint(Random& random);

/// Pose of the sensor on its vehicle: at KITTI's height, with realistic errors of mounting and
/// load.
RigidTransform draw_world_mount(std::uint64_t seed);

/// Scan number `number`: drops returns that the vehicle blocks and lost ones, and adds random
/// outliers. Draws by (seed, number, ray).
Scan world_scan_of(std::span<const Firing> firings, std::span<const StreetEcho> echoes,
                   const TimedPose& pose, std::uint64_t seed, std::uint64_t number);

}  // namespace adasplats
