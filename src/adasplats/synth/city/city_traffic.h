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

// Private to synth/city/: moving objects. Vehicles follow the lanes of entire streets on a
// timetable: every block takes the same time, and vehicles on east and north streets pass crossings
// in different parts of the period, so they never collide. People walk up and down the sidewalks.
// All positions depend only on the seed and the time.

namespace adasplats {

/// The box of a non-empty mesh, with a margin of 1 cm.
std::pair<Vec3f, Vec3f> city_bounds(const TriangleMesh& mesh);

/// A shape shared by movers, in its own frame: x forward, z up, origin on the ground.
struct MoverModel {
  BuiltMesh built;
  Vec3f low, high;
  std::unique_ptr<Tracer> tracer;  ///< views `built`
};

/// The mover shapes of a city.
class MoverModels {
 public:
  MoverModels(const CityGrid& grid, const Executor& executor);

  const MoverModel& model(std::size_t i) const { return *models_[i]; }
  std::size_t size() const { return models_.size(); }
  /// A random model of a kind.
  std::size_t pick(VehicleKind kind, Random& random) const;

 private:
  std::vector<std::unique_ptr<MoverModel>> models_;
  std::vector<VehicleKind> kinds_;  ///< ascending
};

/// A mover at a given time.
struct PlacedMover {
  std::size_t model = 0;
  std::uint16_t instance = 0;
  RigidTransform world_from_mover;
};

/// A person who walks up and down a sidewalk.
struct Walker {
  std::size_t model = 0;
  std::uint16_t instance = 0;
  int side = 1;
  double from_axis = 5, s0 = 0, s1 = 1;
  double speed_m_per_s = 1.3, phase_m = 0;
};

/// The walkers of a section.
std::vector<Walker> draw_walkers(const CityGrid& grid, const CitySectionId& id,
                                 const WorldPlan& plan, const MoverModels& models);
PlacedMover place_walker(const Walker& walker, const WorldPlan& plan, double time_s);

/// The vehicles at a given time on all streets within `reach_m` of a grid position.
std::vector<PlacedMover> vehicles_around(const CityGrid& grid, const MoverModels& models,
                                         Vec3d grid_position, double reach_m, double time_s);

/// Instance ids below this one belong to static objects, the others to movers. Ids are unique
/// within about a kilometre, not in the entire city.
inline constexpr std::uint16_t kFirstMover = 38401;
/// Group of instance ids of a section; sections that share a group are far apart.
std::uint16_t section_group(const CitySectionId& id);
inline constexpr std::uint16_t kSectionGroups = 128;

}  // namespace adasplats
