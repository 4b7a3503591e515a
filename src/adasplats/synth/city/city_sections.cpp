// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_sections.h"

#include <tuple>
#include <utility>

#include "adasplats/synth/city/city_grid.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kIdsPerSection = (kFirstMover - 1) / kSectionGroups;

BuiltMesh build_section(const CityGrid& grid, const CitySectionId& id, const WorldPlan& plan) {
  MeshBuilder builder;
  add_world_ground(plan, builder);
  add_world_buildings(plan, builder);
  if (id.axis == CityAxis::east) add_corner_rows(plan, builder);
  add_world_edges(plan, builder);
  add_world_plants(plan, builder);
  add_world_furniture(plan, builder);
  add_crossing_furniture(grid, id, plan, builder);
  add_open_spaces(grid, id, plan, add_world_objects(plan, builder), builder);
  BuiltMesh built = builder.take();
  // Ids within a section start at 1; a section with very many objects reuses some.
  const auto first = static_cast<std::uint16_t>(1 + section_group(id) * kIdsPerSection);
  for (std::uint16_t& instance : built.instances)
    if (instance > 0)
      instance = static_cast<std::uint16_t>(first + (instance - 1) % kIdsPerSection);
  return built;
}

}  // namespace

CitySection::CitySection(const CityGrid& grid, const CitySectionId& of, const MoverModels& models)
    : id(of),
      rect(grid.rect(of)),
      plan(grid.plan(of)),
      built(build_section(grid, of, plan)),
      walkers(draw_walkers(grid, of, plan, models)) {
  std::tie(low, high) = city_bounds(built.mesh);
}

std::set<CitySectionId> sections_around(const CityGrid& grid, Vec3d grid_position, double range_m) {
  constexpr double kOverhang_m = 8;  // of crowns and roofs beyond a section's rectangle
  const double reach = range_m + kMaxBend_m + kOverhang_m;
  const int west = grid.block_at(CityAxis::east, grid_position.x - reach) - 1;
  const int east = grid.block_at(CityAxis::east, grid_position.x + reach) + 1;
  const int south = grid.block_at(CityAxis::north, grid_position.y - reach) - 1;
  const int north = grid.block_at(CityAxis::north, grid_position.y + reach) + 1;
  std::set<CitySectionId> around;
  const auto add = [&](const CitySectionId& id) {
    if (grid.rect(id).distance(grid_position.x, grid_position.y) <= reach) around.insert(id);
  };
  for (int i = west; i <= east; ++i) {
    for (int j = south; j <= north; ++j) {
      add({CityAxis::east, j, i});
      add({CityAxis::north, i, j});
    }
  }
  return around;
}

void CitySections::keep(const std::set<CitySectionId>& wanted) {
  std::erase_if(sections_, [&](const auto& entry) { return wanted.count(entry.first) == 0; });
}

void CitySections::add(std::unique_ptr<CitySection> section, const Executor& executor) {
  section->tracer = make_cpu_tracer(SceneView{{}, &section->built.mesh}, executor);
  const CitySectionId id = section->id;
  sections_[id] = std::move(section);
}

}  // namespace adasplats
