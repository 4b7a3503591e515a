// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr Material kBlackIron = {label::kFence, 0.22F};
constexpr Material kPaintedSteel = {label::kFence, 0.42F};
constexpr double kGardenFenceLine = kSidewalkEdge + 0.12;

Vec3d on_sidewalk(double x, double y) { return {x, y, sidewalk_height(x, y)}; }

/// The front of a garden from x0 to x1.
void add_garden_edge(MeshBuilder& builder, const Plot& plot, double x0, double x1) {
  if (x1 - x0 < 0.4) return;
  const double y = plot.side * kGardenFenceLine;
  const Vec3d from = on_sidewalk(x0, y);
  const Vec3d to = on_sidewalk(x1, y);
  if (plot.edge == GardenEdge::fence) {
    add_bar_fence(builder, from, to, {.height = 1.5, .bar_spacing = 0.11, .bar = 0.022},
                  kBlackIron);
  } else if (plot.edge == GardenEdge::wall_with_fence) {
    const Vec3d middle = 0.5 * (from + to);
    builder.box(middle + Vec3d{0, 0, 0.2}, 0.5 * (to - from), {0, 0.11, 0}, {0, 0, 0.4},
                {label::kOtherStructure, 0.4F});
    add_bar_fence(builder, from + Vec3d{0, 0, 0.6}, to + Vec3d{0, 0, 0.6},
                  {.height = 0.95, .bar_spacing = 0.11}, kBlackIron);
  }
}

/// Fence or low wall in front of the garden, open at the driveway and the path; a gate across the
/// path.
void add_garden(MeshBuilder& builder, const Plot& plot) {
  const double gate0 = plot.center() - 0.6;
  const double gate1 = plot.center() + 0.6;
  add_garden_edge(builder, plot, plot.x0 + 0.15, plot.x0 + 0.5);
  add_garden_edge(builder, plot, plot.x0 + 3.5, gate0 - 0.05);
  add_garden_edge(builder, plot, gate1 + 0.05, plot.x1 - 0.15);
  const double y = plot.side * kGardenFenceLine;
  add_bar_fence(builder, on_sidewalk(gate0, y), on_sidewalk(gate1, y),
                {.height = 1.25, .bar_spacing = 0.1, .post_spacing = 0}, kBlackIron);
  // Mesh fences between neighbours, back to the houses.
  for (const double x : {plot.x0 + 0.05, plot.x1 - 0.05}) {
    const double back = plot.side * (kSidewalkEdge + kBuildingDepth - 0.2);
    add_bar_fence(builder, on_sidewalk(x, y), on_sidewalk(x, back),
                  {.height = 1.3, .bar_spacing = 0.16, .bar = 0.014}, kBlackIron);
  }
}

void add_boundary_wall(const StreetPlan& plan, MeshBuilder& builder, const Plot& plot) {
  Random random = random_of(plan, Purpose::wall, plot.number);
  const double height = random.uniform(2.0, 2.6);
  const double y = plot.side * (kSidewalkEdge + 0.2);
  const Vec3d from = on_sidewalk(plot.x0, y);
  const Vec3d to = on_sidewalk(plot.x1, y);
  const Material stone = {label::kOtherStructure, 0.38F};
  builder.box(0.5 * (from + to) + Vec3d{0, 0, 0.5 * height - 0.2}, 0.5 * (to - from), {0, 0.15, 0},
              {0, 0, 0.5 * height + 0.2}, stone);
  builder.box(0.5 * (from + to) + Vec3d{0, 0, height + 0.04}, 0.5 * (to - from), {0, 0.2, 0},
              {0, 0, 0.04}, stone);  // coping
}

/// A pedestrian barrier at the kerb: tube frames with bars.
void add_barrier(MeshBuilder& builder, const Item& item) {
  const double y = item.side * (kRoadHalfWidth + 0.35);
  const int frames = std::max(1, static_cast<int>(std::lround(item.length / 1.5)));
  const double width = item.length / frames;
  for (int k = 0; k < frames; ++k) {
    const double x = item.x + k * width;
    add_bar_fence(builder, on_sidewalk(x + 0.08, y), on_sidewalk(x + width - 0.08, y),
                  {.height = 1.0,
                   .bar_spacing = 0.12,
                   .bar = 0.022,
                   .rail = 0.05,
                   .post_spacing = width,
                   .bottom = 0.18},
                  kPaintedSteel);
  }
}

}  // namespace

void add_bar_fence(MeshBuilder& builder, Vec3d from, Vec3d to, const BarFence& fence,
                   const Material& material) {
  const double length_m = length(to - from);
  const auto at = [&](double share, double z) {
    return from + share * (to - from) + Vec3d{0, 0, z};
  };
  for (const double z : {fence.bottom, fence.height - 0.5 * fence.rail})
    builder.beam(at(0, z), at(1, z), 0.5 * fence.rail, 0.5 * fence.rail, material);
  const int gaps = std::max(1, static_cast<int>(std::lround(length_m / fence.bar_spacing)));
  for (int k = 0; k <= gaps; ++k) {
    const double share = static_cast<double>(k) / gaps;
    builder.beam(at(share, fence.bottom), at(share, fence.height - fence.rail), 0.5 * fence.bar,
                 0.5 * fence.bar, material);
  }
  if (fence.post_spacing <= 0) return;
  const int spans = std::max(1, static_cast<int>(std::lround(length_m / fence.post_spacing)));
  for (int k = 0; k <= spans; ++k) {
    const double share = static_cast<double>(k) / spans;
    builder.tube(at(share, -0.1), at(share, fence.height + 0.03), 0.03, 0.03, 8, material);
  }
}

void add_fences(const StreetPlan& plan, MeshBuilder& builder) {
  for (const Plot& plot : plan.plots) {
    if (plot.kind == PlotKind::house) add_garden(builder, plot);
    if (plot.kind == PlotKind::wall) add_boundary_wall(plan, builder, plot);
  }
  for (const Item& item : plan.items)
    if (item.kind == ItemKind::barrier) add_barrier(builder, item);
}

}  // namespace adasplats
