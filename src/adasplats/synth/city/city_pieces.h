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
struct CityPiece {
  CityPiece(const CityGrid& grid, const CityPieceId& id, const MoverModels& models);

  CityPieceId id;
  CityRect rect;
  WorldPlan plan;
  BuiltMesh built;
  std::vector<Walker> walkers;
  Vec3f low, high;                 ///< city_bounds()
  std::unique_ptr<Tracer> tracer;  ///< views `built`; set by CityPieces::add()
};

/// Ids of the sections that a ray of `range_m` from a grid position may hit, ascending.
std::set<CityPieceId> pieces_around(const CityGrid& grid, Vec3d grid_place, double range_m);

/// The sections around the sensor, built and dropped as it moves.
class CityPieces {
 public:
  /// Drops sections that are not in `wanted`.
  void keep(const std::set<CityPieceId>& wanted);
  /// Adds a section and builds its tree. Must not run within a loop of the executor.
  void add(std::unique_ptr<CityPiece> piece, const Executor& executor);
  bool holds(const CityPieceId& id) const { return pieces_.count(id) > 0; }
  const CityPiece& piece(const CityPieceId& id) const { return *pieces_.at(id); }
  std::size_t size() const { return pieces_.size(); }

 private:
  std::map<CityPieceId, std::unique_ptr<CityPiece>> pieces_;
};

}  // namespace adasplats
