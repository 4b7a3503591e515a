// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/synth/city/city_grid.h"
#include "adasplats/synth/city/city_traffic.h"
#include "adasplats/synth/mesh_builder.h"
#include "adasplats/trace/tracer.h"

// Private to synth/city/: the sections in memory.

namespace adasplats {

/// The static content of a section; depends only on the seed and its id.
struct CitySection {
  CitySection(const CityGrid& grid, const CitySectionId& id, const MoverModels& models);

  CitySectionId id;
  CityRect rect;
  WorldPlan plan;
  BuiltMesh built;
  std::vector<Walker> walkers;
  Vec3f low, high;                 ///< city_bounds()
  std::unique_ptr<Tracer> tracer;  ///< views `built`; set by CitySections::add()
};

/// Ids of the sections that a ray of `range_m` from a grid position may hit, ascending.
std::set<CitySectionId> sections_around(const CityGrid& grid, Vec3d grid_position, double range_m);

/// The sections around the sensor, built and dropped as it moves.
class CitySections {
 public:
  /// Drops sections that are not in `wanted`.
  void keep(const std::set<CitySectionId>& wanted);
  /// Adds a section and builds its tree. Must not run within a loop of the executor.
  void add(std::unique_ptr<CitySection> section, const Executor& executor);
  bool holds(const CitySectionId& id) const { return sections_.count(id) > 0; }
  const CitySection& section(const CitySectionId& id) const { return *sections_.at(id); }
  std::size_t size() const { return sections_.size(); }

 private:
  std::map<CitySectionId, std::unique_ptr<CitySection>> sections_;
};

}  // namespace adasplats
