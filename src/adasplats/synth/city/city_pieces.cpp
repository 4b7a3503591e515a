// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_pieces.h"

#include <tuple>
#include <utility>

#include "adasplats/synth/city/city_parts.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kIdsOfPiece = (kFirstMover - 1) / kPieceGroups;

BuiltMesh build_piece(const CityGrid& grid, const CityPieceId& id, const WorldPlan& plan) {
  MeshBuilder builder;
  add_world_ground(plan, builder);
  add_world_buildings(plan, builder);
  if (id.axis == CityAxis::east) add_corner_rows(plan, builder);
  add_world_edges(plan, builder);
  add_world_plants(plan, builder);
  add_world_furniture(plan, builder);
  add_crossing_furniture(grid, id, plan, builder);
  add_open_places(grid, id, plan, add_world_standing(plan, builder), builder);
  BuiltMesh built = builder.take();
  // Ids within a section start at 1; a section with very many objects reuses some.
  const auto first = static_cast<std::uint16_t>(1 + piece_group(id) * kIdsOfPiece);
  for (std::uint16_t& instance : built.instances)
    if (instance > 0) instance = static_cast<std::uint16_t>(first + (instance - 1) % kIdsOfPiece);
  return built;
}

}  // namespace

CityPiece::CityPiece(const CityGrid& grid, const CityPieceId& of, const MoverModels& models)
    : id(of),
      rect(grid.rect(of)),
      plan(grid.plan(of)),
      built(build_piece(grid, of, plan)),
      walkers(draw_walkers(grid, of, plan, models)) {
  std::tie(low, high) = city_bounds(built.mesh);
}

std::set<CityPieceId> pieces_around(const CityGrid& grid, Vec3d grid_place, double range_m) {
  constexpr double kOverhang_m = 8;  // of crowns and roofs beyond a section's rectangle
  const double reach = range_m + kMaxBend_m + kOverhang_m;
  const int west = grid.block_at(CityAxis::east, grid_place.x - reach) - 1;
  const int east = grid.block_at(CityAxis::east, grid_place.x + reach) + 1;
  const int south = grid.block_at(CityAxis::north, grid_place.y - reach) - 1;
  const int north = grid.block_at(CityAxis::north, grid_place.y + reach) + 1;
  std::set<CityPieceId> around;
  const auto add = [&](const CityPieceId& id) {
    if (grid.rect(id).distance(grid_place.x, grid_place.y) <= reach) around.insert(id);
  };
  for (int i = west; i <= east; ++i) {
    for (int j = south; j <= north; ++j) {
      add({CityAxis::east, j, i});
      add({CityAxis::north, i, j});
    }
  }
  return around;
}

void CityPieces::keep(const std::set<CityPieceId>& wanted) {
  std::erase_if(pieces_, [&](const auto& entry) { return wanted.count(entry.first) == 0; });
}

void CityPieces::add(std::unique_ptr<CityPiece> piece, const Executor& executor) {
  piece->tracer = make_cpu_tracer(SceneView{{}, &piece->built.mesh}, executor);
  const CityPieceId id = piece->id;
  pieces_[id] = std::move(piece);
}

}  // namespace adasplats
