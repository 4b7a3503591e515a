// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/synth/city/city_grid.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/synth/world/world_parts.h"
#include "adasplats/trace/tracer.h"

// Inside synth/city/: what moves. Vehicles go along the lanes of whole streets on rails, by a
// timetable: every block takes the same time, and those of streets to the east pass crossings in
// one part of it, those of streets to the north in another, so that nobody meets. People walk up
// and down the sidewalks. Where all of them are depends on the seed and the time alone.

namespace adasplats {

/// The box of a mesh that is not empty, with a margin of a centimetre.
std::pair<Vec3f, Vec3f> city_bounds(const TriangleMesh& mesh);

/// A shape that movers share, in its own frame: x forward, z up, origin on the ground.
struct MoverModel {
  BuiltMesh built;
  Vec3f low, high;
  std::unique_ptr<Tracer> tracer;  ///< views `built`
};

/// The shapes of a city.
class MoverModels {
 public:
  MoverModels(const CityGrid& grid, const Executor& executor);

  const MoverModel& model(std::size_t i) const { return *models_[i]; }
  std::size_t size() const { return models_.size(); }
  /// One of a kind.
  std::size_t pick(VehicleKind kind, Random& random) const;

 private:
  std::vector<std::unique_ptr<MoverModel>> models_;
  std::vector<VehicleKind> kinds_;  ///< ascending
};

/// A mover at one time.
struct PlacedMover {
  std::size_t model = 0;
  std::uint16_t instance = 0;
  RigidTransform world_from_mover;
};

/// Somebody who walks up and down a sidewalk.
struct Walker {
  std::size_t model = 0;
  std::uint16_t instance = 0;
  int side = 1;
  double from_axis = 5, s0 = 0, s1 = 1;
  double speed_m_per_s = 1.3, phase_m = 0;
};

/// The walkers of a piece.
std::vector<Walker> draw_walkers(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan,
                                 const MoverModels& models);
PlacedMover place_walker(const Walker& walker, const WorldPlan& plan, double time_s);

/// The vehicles on the streets around a place of the grid at a time, out to `reach_m`.
std::vector<PlacedMover> vehicles_around(const CityGrid& grid, const MoverModels& models,
                                         Vec3d grid_place, double reach_m, double time_s);

/// Ids of what stands are below this one, those of movers from it on; in a city they are one
/// thing's alone within a kilometre, not all over it.
inline constexpr std::uint16_t kFirstMover = 38401;
/// The group of ids of a piece: pieces with the same one are far apart.
std::uint16_t piece_group(const CityPieceId& id);
inline constexpr std::uint16_t kPieceGroups = 128;

}  // namespace adasplats
