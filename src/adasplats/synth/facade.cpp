// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr Material kGlass = {label::kBuilding, 0.09F};
constexpr Material kFrame = {label::kBuilding, 0.62F};
constexpr Material kDoor = {label::kBuilding, 0.22F};
constexpr Material kShutter = {label::kBuilding, 0.48F};
constexpr Material kIron = {label::kBuilding, 0.14F};
constexpr double kReveal = 0.24;

void wall_quad(MeshBuilder& builder, const WallFrame& wall, const WallRect& rect, double out,
               const Material& material) {
  builder.quad(wall(rect.a0, out, rect.z0), wall(rect.a1, out, rect.z0),
               wall(rect.a1, out, rect.z1), wall(rect.a0, out, rect.z1), material);
}

void add_reveal(MeshBuilder& builder, const WallFrame& wall, const WallRect& hole,
                const Material& material) {
  const auto side = [&](double a0, double z0, double a1, double z1) {
    builder.quad(wall(a0, 0, z0), wall(a1, 0, z1), wall(a1, -kReveal, z1), wall(a0, -kReveal, z0),
                 material);
  };
  side(hole.a0, hole.z0, hole.a1, hole.z0);
  side(hole.a1, hole.z0, hole.a1, hole.z1);
  side(hole.a1, hole.z1, hole.a0, hole.z1);
  side(hole.a0, hole.z1, hole.a0, hole.z0);
}

/// Window frame in front of the pane: border, `mullions` vertical bars and one transom.
void add_frame(MeshBuilder& builder, const WallFrame& wall, const WallRect& hole, int mullions,
               double transom) {
  constexpr double kBar = 0.06;
  const double in = -kReveal + 0.05;
  const auto bar = [&](const WallRect& rect) {
    add_wall_box(builder, wall, rect, -kReveal, in, kFrame);
  };
  bar({hole.a0, hole.a0 + kBar, hole.z0, hole.z1});
  bar({hole.a1 - kBar, hole.a1, hole.z0, hole.z1});
  bar({hole.a0 + kBar, hole.a1 - kBar, hole.z0, hole.z0 + kBar});
  bar({hole.a0 + kBar, hole.a1 - kBar, hole.z1 - kBar, hole.z1});
  for (int k = 1; k <= mullions; ++k) {
    const double a = hole.a0 + (hole.a1 - hole.a0) * k / (mullions + 1);
    bar({a - 0.5 * kBar, a + 0.5 * kBar, hole.z0 + kBar, hole.z1 - kBar});
  }
  const double z = hole.z0 + transom * (hole.z1 - hole.z0);
  bar({hole.a0 + kBar, hole.a1 - kBar, z - 0.5 * kBar, z + 0.5 * kBar});
}

void add_shutters(MeshBuilder& builder, const WallFrame& wall, const WallRect& hole) {
  const double width = 0.5 * (hole.a1 - hole.a0);
  add_wall_box(builder, wall, {hole.a0 - width, hole.a0 - 0.02, hole.z0, hole.z1}, 0.02, 0.06,
               kShutter);
  add_wall_box(builder, wall, {hole.a1 + 0.02, hole.a1 + width, hole.z0, hole.z1}, 0.02, 0.06,
               kShutter);
}

/// A sloping awning above a shop.
void add_awning(MeshBuilder& builder, const WallFrame& wall, const WallRect& hole) {
  constexpr Material kCloth = {label::kBuilding, 0.4F};
  const double z = hole.z1 + 0.1;
  builder.quad(wall(hole.a0 - 0.1, 0.03, z), wall(hole.a1 + 0.1, 0.03, z),
               wall(hole.a1 + 0.1, 1.1, z - 0.45), wall(hole.a0 - 0.1, 1.1, z - 0.45), kCloth);
  builder.quad(wall(hole.a0 - 0.1, 1.1, z - 0.45), wall(hole.a1 + 0.1, 1.1, z - 0.45),
               wall(hole.a1 + 0.1, 1.1, z - 0.65), wall(hole.a0 - 0.1, 1.1, z - 0.65), kCloth);
}

}  // namespace

void add_wall_box(MeshBuilder& builder, const WallFrame& wall, const WallRect& rect, double out0,
                  double out1, const Material& material) {
  builder.box(wall(0.5 * (rect.a0 + rect.a1), 0.5 * (out0 + out1), 0.5 * (rect.z0 + rect.z1)),
              wall.along * (0.5 * (rect.a1 - rect.a0)), wall.out * (0.5 * (out1 - out0)),
              Vec3d{0, 0, 0.5 * (rect.z1 - rect.z0)}, material);
}

void add_wall_with_opening(MeshBuilder& builder, const WallFrame& wall, const WallRect& panel,
                           const WallRect& hole, OpeningKind kind, float wall_reflectance) {
  const Material stone = {label::kBuilding, wall_reflectance};
  wall_quad(builder, wall, {panel.a0, hole.a0, panel.z0, panel.z1}, 0, stone);
  wall_quad(builder, wall, {hole.a1, panel.a1, panel.z0, panel.z1}, 0, stone);
  wall_quad(builder, wall, {hole.a0, hole.a1, panel.z0, hole.z0}, 0, stone);
  wall_quad(builder, wall, {hole.a0, hole.a1, hole.z1, panel.z1}, 0, stone);
  add_reveal(builder, wall, hole, stone);
  wall_quad(builder, wall, hole, -kReveal, kind == OpeningKind::door ? kDoor : kGlass);
  switch (kind) {
    case OpeningKind::door: break;
    case OpeningKind::shop:
      add_frame(builder, wall, hole, 2, 0.82);
      add_awning(builder, wall, hole);
      break;
    case OpeningKind::shutters: add_shutters(builder, wall, hole); [[fallthrough]];
    case OpeningKind::window:
      add_wall_box(builder, wall, {hole.a0 - 0.06, hole.a1 + 0.06, hole.z0 - 0.07, hole.z0}, 0,
                   0.09, stone);
      [[fallthrough]];
    case OpeningKind::french_window: add_frame(builder, wall, hole, 1, 0.72); break;
  }
}

void add_balcony(MeshBuilder& builder, const WallFrame& wall, double a0, double a1, double z,
                 double depth) {
  constexpr Material kSlab = {label::kBuilding, 0.45F};
  add_wall_box(builder, wall, {a0, a1, z - 0.16, z}, 0, depth, kSlab);
  for (const double a : {a0 + 0.25, a1 - 0.25})  // brackets
    add_wall_box(builder, wall, {a - 0.09, a + 0.09, z - 0.5, z - 0.16}, 0, 0.55 * depth, kSlab);
  const BarFence railing = {.height = 1.0,
                            .bar_spacing = 0.11,
                            .bar = 0.016,
                            .rail = 0.04,
                            .post_spacing = 0,
                            .bottom = 0.08};
  const double out = depth - 0.05;
  add_bar_fence(builder, wall(a0 + 0.04, out, z), wall(a1 - 0.04, out, z), railing, kIron);
  add_bar_fence(builder, wall(a0 + 0.04, 0.0, z), wall(a0 + 0.04, out, z), railing, kIron);
  add_bar_fence(builder, wall(a1 - 0.04, 0.0, z), wall(a1 - 0.04, out, z), railing, kIron);
}

}  // namespace adasplats
