// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr std::uint16_t kGroundClasses[kGroundCount] = {label::kRoad,        label::kLaneMarking,
                                                        label::kParking,     label::kSidewalk,
                                                        label::kOtherGround, label::kTerrain};

/// The requested cuts and, between them, even ones at most step(position) apart. Requested cuts
/// within 3 cm of each other are merged.
template <class Step>
std::vector<double> even_cuts(std::vector<double> requested, double low, double high, Step step) {
  requested.insert(requested.end(), {low, high});
  std::erase_if(requested, [&](double cut) { return cut < low || cut > high; });
  std::ranges::sort(requested);
  std::vector<double> cuts = {requested.front()};
  for (const double cut : requested) {
    const double from = cuts.back();
    if (cut - from < 0.03) continue;
    const int steps = std::max(1, static_cast<int>(std::ceil((cut - from) / step(cut))));
    for (int k = 1; k <= steps; ++k) cuts.push_back(from + (cut - from) * k / steps);
  }
  return cuts;
}

std::vector<double> world_cuts_along(const WorldPlan& plan) {
  std::vector<double> requested;
  for (const Patch& patch : plan.patches) requested.insert(requested.end(), {patch.s0, patch.s1});
  return even_cuts(requested, 0, plan.options.length_m, [](double) { return 0.7; });
}

std::vector<double> world_cuts_across(const WorldPlan& plan) {
  std::vector<double> requested = {0};
  for (const int which : {1, -1}) {
    for (const Strip& strip : plan.strips_of(which)) requested.push_back(which * strip.to);
    for (const Patch& patch : plan.patches)
      if (patch.side == which)
        requested.insert(requested.end(), {which * patch.d0, which * patch.d1});
  }
  return even_cuts(requested, -plan.reach(-1), plan.reach(1), [](double d) {
    const double off = std::fabs(d);
    return off < 12 ? 0.5 : off < 25 ? 0.8 : 1.6;
  });
}

/// Heights of the land at cell corners; the roughness of soil is drawn by corner.
struct GroundGrid {
  const WorldPlan& plan;
  std::vector<double> s, d;
  std::vector<WorldPlan::Cell> cells;
  std::vector<Vec3d> corners;  ///< without steps
  std::vector<double> rough;   ///< of each corner

  explicit GroundGrid(const WorldPlan& of)
      : plan(of), s(world_cuts_along(of)), d(world_cuts_across(of)) {
    for (std::size_t i = 0; i + 1 < s.size(); ++i)
      for (std::size_t j = 0; j + 1 < d.size(); ++j)
        cells.push_back(plan.cell_at(0.5 * (s[i] + s[i + 1]), 0.5 * (d[j] + d[j + 1])));
    for (std::size_t i = 0; i < s.size(); ++i) {
      for (std::size_t j = 0; j < d.size(); ++j) {
        Vec3d corner = plan.route.at(s[i], d[j]);
        corner.z = plan.height(s[i], d[j]);
        corners.push_back(corner);
        Random random = random_of(plan, WorldPurpose::ground, i * d.size() + j);
        rough.push_back(plan.style.roughness * random.normal());
      }
    }
  }
  const WorldPlan::Cell& cell(std::size_t i, std::size_t j) const {
    return cells[i * (d.size() - 1) + j];
  }
  Vec3d corner(const WorldPlan::Cell& of, std::size_t i, std::size_t j) const {
    const std::size_t k = i * d.size() + j;
    Vec3d p = corners[k];
    p.z += of.step + (of.ground == Ground::terrain ? rough[k] : 0.0);
    return p;
  }
  Material material(const WorldPlan::Cell& of) const {
    const auto k = static_cast<std::size_t>(of.ground);
    return {kGroundClasses[k], plan.ground_reflectances[k]};
  }
};

/// The face between two cells along their common edge.
void add_ground_step(const GroundGrid& grid, MeshBuilder& builder, const WorldPlan::Cell& one,
                     const WorldPlan::Cell& other, std::size_t i0, std::size_t j0, std::size_t i1,
                     std::size_t j1) {
  const bool one_is_rough = one.ground == Ground::terrain;
  if (one.step == other.step && one_is_rough == (other.ground == Ground::terrain)) return;
  const Material face = grid.material(one.step > other.step ? one : other);
  builder.quad(grid.corner(one, i0, j0), grid.corner(one, i1, j1), grid.corner(other, i1, j1),
               grid.corner(other, i0, j0), face);
}

/// Vertical faces down from the edge of the land, so that no ray passes through small gaps between
/// the sections of a city.
void add_ground_rim(const GroundGrid& grid, MeshBuilder& builder) {
  constexpr Vec3d kDown = {0, 0, -0.6};
  const auto face = [&](const WorldPlan::Cell& cell, std::size_t i0, std::size_t j0, std::size_t i1,
                        std::size_t j1) {
    const Vec3d a = grid.corner(cell, i0, j0);
    const Vec3d b = grid.corner(cell, i1, j1);
    builder.quad(a, b, b + kDown, a + kDown, grid.material(cell));
  };
  const std::size_t rows = grid.s.size() - 1;
  const std::size_t columns = grid.d.size() - 1;
  for (std::size_t i = 0; i < rows; ++i) {
    face(grid.cell(i, 0), i, 0, i + 1, 0);
    face(grid.cell(i, columns - 1), i, columns, i + 1, columns);
  }
  for (std::size_t j = 0; j < columns; ++j) {
    face(grid.cell(0, j), 0, j, 0, j + 1);
    face(grid.cell(rows - 1, j), rows, j, rows, j + 1);
  }
}

}  // namespace

void add_world_ground(const WorldPlan& plan, MeshBuilder& builder) {
  const GroundGrid grid(plan);
  for (std::size_t i = 0; i + 1 < grid.s.size(); ++i) {
    for (std::size_t j = 0; j + 1 < grid.d.size(); ++j) {
      const WorldPlan::Cell& cell = grid.cell(i, j);
      builder.quad(grid.corner(cell, i, j), grid.corner(cell, i + 1, j),
                   grid.corner(cell, i + 1, j + 1), grid.corner(cell, i, j + 1),
                   grid.material(cell));
      if (i + 2 < grid.s.size())
        add_ground_step(grid, builder, cell, grid.cell(i + 1, j), i + 1, j, i + 1, j + 1);
      if (j + 2 < grid.d.size())
        add_ground_step(grid, builder, cell, grid.cell(i, j + 1), i, j + 1, i + 1, j + 1);
    }
  }
  if (plan.land_step) add_ground_rim(grid, builder);
}

}  // namespace adasplats
