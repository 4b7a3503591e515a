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

// Inside synth/city/: the pieces that are in memory.

namespace adasplats {

/// A piece as it stands: depends on the seed and its id alone.
struct CityPiece {
  CityPiece(const CityGrid& grid, const CityPieceId& id, const MoverModels& models);

  CityPieceId id;
  CityRect rect;
  WorldPlan plan;
  BuiltMesh built;
  std::vector<Walker> walkers;
  Vec3f low, high;                 ///< city_bounds()
  std::unique_ptr<Tracer> tracer;  ///< views `built`; none until CityPieces has it
};

/// Ids of the pieces that a ray of `range_m` from a place of the grid may meet, in their order.
std::set<CityPieceId> pieces_around(const CityGrid& grid, Vec3d grid_place, double range_m);

/// The pieces around the sensor, made and dropped as it goes.
class CityPieces {
 public:
  /// Drops pieces that are not in `wanted`.
  void keep(const std::set<CityPieceId>& wanted);
  /// Takes a piece and builds its tree: not within a loop of the executor.
  void add(std::unique_ptr<CityPiece> piece, const Executor& executor);
  bool holds(const CityPieceId& id) const { return pieces_.count(id) > 0; }
  const CityPiece& piece(const CityPieceId& id) const { return *pieces_.at(id); }
  std::size_t size() const { return pieces_.size(); }

 private:
  std::map<CityPieceId, std::unique_ptr<CityPiece>> pieces_;
};

}  // namespace adasplats
