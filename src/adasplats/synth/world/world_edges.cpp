// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr double kPiece_m = 2.5;

/// Boards or pickets next to each other.
void add_board_fence(MeshBuilder& builder, Vec3d from, Vec3d to, double height, double board,
                     double gap, float reflectance, Random& random) {
  const Material wood = {label::kFence, reflectance};
  const double length_m = length(to - from);
  const int boards = std::max(1, static_cast<int>(length_m / (board + gap)));
  const Vec3d step = (to - from) / static_cast<double>(boards);
  const Vec3d half = step * (0.5 * board / (board + gap));
  for (int k = 0; k < boards; ++k) {
    const Vec3d foot = from + (k + 0.5) * step + Vec3d{0, 0, 0.06};
    const Vec3d up = {0, 0, height - 0.06 + 0.02 * random.normal()};
    builder.quad(foot - half, foot + half, foot + half + up, foot - half + up, wood);
  }
  for (const double z : {0.25 * height, 0.8 * height})
    builder.beam(from + Vec3d{0, 0, z}, to + Vec3d{0, 0, z}, 0.02, 0.04, wood);
  builder.beam(from - Vec3d{0, 0, 0.2}, from + Vec3d{0, 0, height}, 0.045, 0.045, wood);
}

/// Wires between posts, each a thin band, so that beams may pass.
void add_mesh_fence(MeshBuilder& builder, Vec3d from, Vec3d to, double height, float reflectance) {
  const Material wire = {label::kFence, reflectance};
  constexpr double kHalfWire = 0.004;
  const double length_m = length(to - from);
  const int uprights = std::max(1, static_cast<int>(length_m / 0.12));
  const Vec3d step = (to - from) / static_cast<double>(uprights);
  const Vec3d half = normalized(step) * kHalfWire;
  for (int k = 0; k < uprights; ++k) {
    const Vec3d foot = from + static_cast<double>(k) * step;
    const Vec3d up = {0, 0, height};
    builder.quad(foot - half, foot + half, foot + half + up, foot - half + up, wire);
  }
  for (double z = 0.08; z < height; z += 0.16) {
    const Vec3d low = {0, 0, z - kHalfWire};
    const Vec3d high = {0, 0, z + kHalfWire};
    builder.quad(from + low, to + low, to + high, from + high, wire);
  }
  builder.tube(from - Vec3d{0, 0, 0.2}, from + Vec3d{0, 0, height + 0.05}, 0.03, 0.03, 6, wire);
}

void add_wall_piece(MeshBuilder& builder, Vec3d from, Vec3d to, double height, double thickness,
                    const Material& stone) {
  const Vec3d along = to - from;
  const Vec3d across = normalized(Vec3d{-along.y, along.x, 0}) * (0.5 * thickness);
  const Vec3d middle = 0.5 * (from + to);
  builder.box(middle + Vec3d{0, 0, 0.5 * height - 0.2}, 0.5 * along, across,
              {0, 0, 0.5 * height + 0.2}, stone);
}

struct EdgeLook {
  EdgeKind kind = EdgeKind::none;
  double height = 1;
  double detail = 0.1;  ///< width of a board, gap or wall
  float reflectance = 0.4F;
};

EdgeLook draw_look(EdgeKind kind, double height, Random& random) {
  EdgeLook look = {kind, height, random.uniform(0.07, 0.14), 0.4F};
  look.reflectance = static_cast<float>(random.uniform(0.35, 0.75));
  if (kind == EdgeKind::hedge) look.height = std::max(0.8, height);
  if (kind == EdgeKind::picket) look.height = std::min(1.2, height);
  if (kind == EdgeKind::boards) look.height = std::max(1.3, height);
  return look;
}

void add_edge_piece(MeshBuilder& builder, Vec3d from, Vec3d to, const EdgeLook& look,
                    Random& random) {
  switch (look.kind) {
    case EdgeKind::none: break;
    case EdgeKind::hedge:
      add_leafy_hedge(builder, from, to, look.height * random.uniform(0.93, 1.07),
                      6 * look.detail + 0.1, random);
      break;
    case EdgeKind::picket:
      add_board_fence(builder, from, to, look.height, look.detail, 0.6 * look.detail,
                      look.reflectance, random);
      break;
    case EdgeKind::boards:
      add_board_fence(builder, from, to, look.height, 0.14, 0.006, look.reflectance, random);
      break;
    case EdgeKind::bars:
      add_bar_fence(builder, from, to,
                    {.height = look.height, .bar_spacing = 1.3 * look.detail, .bar = 0.022},
                    {label::kFence, look.reflectance});
      break;
    case EdgeKind::mesh: add_mesh_fence(builder, from, to, look.height, look.reflectance); break;
    case EdgeKind::wall:
      add_wall_piece(builder, from, to, look.height, 2 * look.detail + 0.05,
                     {label::kFence, look.reflectance});
      break;
  }
}

/// Along the road from s0 to s1, open where something crosses the sidewalk.
void add_edge_along(const WorldPlan& plan, MeshBuilder& builder, int side, double from_axis,
                    double s0, double s1, const EdgeLook& look, Random& random) {
  const int pieces = std::max(1, static_cast<int>(std::lround((s1 - s0) / kPiece_m)));
  for (int k = 0; k < pieces; ++k) {
    const double a = s0 + (s1 - s0) * k / pieces;
    const double b = s0 + (s1 - s0) * (k + 1) / pieces;
    if (plan.is_open(side, a, b)) continue;
    add_edge_piece(builder, plan.ground_at(a, side * from_axis),
                   plan.ground_at(b, side * from_axis), look, random);
  }
}

void add_edge_across(const WorldPlan& plan, MeshBuilder& builder, int side, double s, double d0,
                     double d1, const EdgeLook& look, Random& random) {
  const int pieces = std::max(1, static_cast<int>(std::lround((d1 - d0) / kPiece_m)));
  for (int k = 0; k < pieces; ++k) {
    const auto at = [&](int n) { return plan.ground_at(s, side * (d0 + (d1 - d0) * n / pieces)); };
    add_edge_piece(builder, at(k), at(k + 1), look, random);
  }
}

void add_plot_edges(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  if (plot.use == Frontage::facades || plot.use == Frontage::wood || plot.use == Frontage::park ||
      plot.use == Frontage::square)
    return;
  Random random = random_of(plan, WorldPurpose::edge, plot.number);
  const double line = plan.property_line(plot.side) + 0.5;
  if (plot.use == Frontage::open || plot.use == Frontage::hall) {  // a field
    const bool fenced = plot.front != EdgeKind::none && random.uniform() < 0.6;
    const EdgeKind kind = plot.front == EdgeKind::hedge ? EdgeKind::hedge : EdgeKind::mesh;
    if (fenced)
      add_edge_along(plan, builder, plot.side, line + random.uniform(1, 5), plot.s0, plot.s1,
                     draw_look(kind, plot.edge_height, random), random);
    return;
  }
  if (plot.use == Frontage::car_park) {
    const EdgeLook low = draw_look(plot.front, 0.6 * plot.edge_height, random);
    add_edge_along(plan, builder, plot.side, line - 0.2, plot.s0 + 5, plot.s1 - 0.5, low, random);
    add_edge_along(plan, builder, plot.side, line + kCarPark_m, plot.s0, plot.s1,
                   draw_look(plot.between, plot.edge_height, random), random);
    return;
  }
  const EdgeLook front = draw_look(plot.front, plot.edge_height, random);
  if (plot.setback > 1) {
    const double path = random.uniform(plot.s0 + 4, std::max(plot.s0 + 4.1, plot.s1 - 2));
    add_edge_along(plan, builder, plot.side, line, plot.s0 + 0.4, path - 0.6, front, random);
    add_edge_along(plan, builder, plot.side, line, path + 0.6, plot.s1 - 0.4, front, random);
  }
  const EdgeLook between = draw_look(plot.between, plot.edge_height + 0.3, random);
  add_edge_across(plan, builder, plot.side, plot.s1, line, line + plot.setback + 14, between,
                  random);
}

/// A steel band on posts.
void add_guard_rail(const WorldPlan& plan, MeshBuilder& builder, int side, double from_axis,
                    double s0, double s1) {
  constexpr Material kRail = {label::kFence, 0.5F};
  for (double s = s0; s < s1; s += 2) {
    const Vec3d a = plan.ground_at(s, side * from_axis);
    const Vec3d b = plan.ground_at(std::min(s + 2, s1), side * from_axis);
    const auto band = [&](double z0, double z1, double out) {
      const Vec3d off =
          normalized(Vec3d{a.y - b.y, b.x - a.x, 0}) * (-static_cast<double>(side) * out);
      builder.quad(a + off + Vec3d{0, 0, z0}, b + off + Vec3d{0, 0, z0}, b + Vec3d{0, 0, z1},
                   a + Vec3d{0, 0, z1}, kRail);
    };
    band(0.44, 0.53, 0.08);  // a W-beam profile
    band(0.60, 0.53, 0.08);
    band(0.62, 0.69, 0.08);
    band(0.76, 0.69, 0.08);
    builder.beam(a - Vec3d{0, 0, 0.3}, a + Vec3d{0, 0, 0.7}, 0.05, 0.03, kRail);
  }
}

void add_barriers(const WorldPlan& plan, MeshBuilder& builder, int side) {
  Random random = random_of(plan, WorldPurpose::walls, side > 0 ? 1 : 0);
  const SideStyle& own = plan.side(side);
  const double end = plan.options.length_m;
  if (own.guard_rail) {
    const double s0 = random.uniform() < 0.5 ? 0 : random.uniform(0, 0.7) * end;
    const double s1 = random.uniform() < 0.5 ? end : random.uniform(s0, end);
    add_guard_rail(plan, builder, side, plan.road_end(side) + 0.6, s0, s1);
  }
  if (plan.options.kind == WorldKind::motorway && plan.style.median > 0)
    add_guard_rail(plan, builder, side, 0.35, 0, end);
  if (own.noise_wall > 0) {
    const double line = plan.property_line(side) + random.uniform(0.5, 4);
    const Material panel = {label::kFence, static_cast<float>(random.uniform(0.3, 0.65))};
    for (double s = random.uniform(0, 60); s < end; s += 4) {
      const Vec3d a = plan.ground_at(s, side * line);
      const Vec3d b = plan.ground_at(s + 4, side * line);
      add_wall_piece(builder, a, b, own.noise_wall, 0.14, panel);
      builder.beam(a - Vec3d{0, 0, 0.5}, a + Vec3d{0, 0, own.noise_wall + 0.1}, 0.1, 0.12, panel);
    }
  }
}

}  // namespace

void add_world_edges(const WorldPlan& plan, MeshBuilder& builder) {
  for (const WorldPlot& plot : plan.plots) add_plot_edges(plan, builder, plot);
  for (const int side : {1, -1}) add_barriers(plan, builder, side);
}

}  // namespace adasplats
