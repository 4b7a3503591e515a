// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr double kHouseBelowGround = 0.5;
constexpr double kSideMargin = 0.9;     // between a house and its neighbours
constexpr double kDrivewayWidth = 2.6;  // kept free at the side of the house
constexpr double kHouseDepth = 6.2;

/// Two floors of openings; the door in the middle of the ground floor.
void add_house_front(MeshBuilder& builder, const WallFrame& wall, double width, double eaves,
                     double ground_z, float reflectance) {
  constexpr int kBays = 3;
  const double bay = width / kBays;
  for (int floor = 0; floor < 2; ++floor) {
    for (int b = 0; b < kBays; ++b) {
      const double middle = (b + 0.5) * bay;
      const double z = floor == 0 ? ground_z : ground_z + 2.9;
      const WallRect panel = {b * bay, (b + 1) * bay, floor == 0 ? -kHouseBelowGround : z,
                              floor == 0 ? z + 2.9 : eaves};
      const bool door = floor == 0 && b == 1;
      const WallRect hole = door ? WallRect{middle - 0.5, middle + 0.5, z + 0.2, z + 2.3}
                                 : WallRect{middle - 0.5, middle + 0.5, z + 0.9, z + 2.2};
      add_wall_with_opening(builder, wall, panel, hole,
                            door ? OpeningKind::door : OpeningKind::shutters, reflectance);
      if (door) {
        add_wall_box(builder, wall, {middle - 0.8, middle + 0.8, z + 2.45, z + 2.55}, 0, 1.0,
                     {label::kBuilding, 0.3F});
        add_wall_box(builder, wall, {middle - 0.7, middle + 0.7, z - 0.1, z + 0.2}, 0, 0.6,
                     {label::kBuilding, 0.4F});
      }
    }
  }
}

/// Gable walls, back wall and a ridge roof along the street with overhanging eaves.
void add_house_shell(MeshBuilder& builder, const WallFrame& wall, double width, double eaves,
                     float reflectance) {
  const Material stone = {label::kBuilding, reflectance};
  const Material tiles = {label::kBuilding, 0.28F};
  const double ridge = eaves + 2.4;
  const double middle = -0.5 * kHouseDepth;
  for (const double a : {0.0, width}) {
    builder.quad(wall(a, 0, -kHouseBelowGround), wall(a, -kHouseDepth, -kHouseBelowGround),
                 wall(a, -kHouseDepth, eaves), wall(a, 0, eaves), stone);
    builder.triangle(wall(a, 0, eaves), wall(a, -kHouseDepth, eaves), wall(a, middle, ridge),
                     stone);
  }
  builder.quad(wall(0, -kHouseDepth, -kHouseBelowGround),
               wall(width, -kHouseDepth, -kHouseBelowGround), wall(width, -kHouseDepth, eaves),
               wall(0, -kHouseDepth, eaves), stone);
  const double slope = 2.4 / (0.5 * kHouseDepth);
  const double over = 0.45;
  for (const double out : {over, -kHouseDepth - over})
    builder.quad(wall(-0.3, out, eaves - over * slope + 0.1),
                 wall(width + 0.3, out, eaves - over * slope + 0.1),
                 wall(width + 0.3, middle, ridge + 0.1), wall(-0.3, middle, ridge + 0.1), tiles);
  builder.tube(wall(-0.3, over + 0.06, eaves - over * slope + 0.05),
               wall(width + 0.3, over + 0.06, eaves - over * slope + 0.05), 0.06, 0.06, 6,
               {label::kBuilding, 0.5F});  // gutter
  add_wall_box(builder, wall, {0.7 * width, 0.7 * width + 0.6, ridge - 0.8, ridge + 1.0},
               middle - 0.9, middle - 0.3, stone);
}

}  // namespace

void add_houses(const StreetPlan& plan, MeshBuilder& builder) {
  for (const Plot& plot : plan.plots) {
    if (plot.kind != PlotKind::house) continue;
    Random random = random_of(plan, Purpose::house, plot.number);
    const double front = kSidewalkEdge + kGardenDepth;
    const double side = plot.side;
    const double x0 = plot.x0 + kSideMargin + kDrivewayWidth;
    const double width = plot.x1 - kSideMargin - x0;
    const WallFrame wall = {{x0, side * front, 0}, {1, 0, 0}, {0, -side, 0}};
    const double ground_z = sidewalk_height(plot.center(), front);
    const double eaves = ground_z + random.uniform(5.4, 6.0);
    const auto reflectance = static_cast<float>(random.uniform(0.4, 0.65));
    add_house_front(builder, wall, width, eaves, ground_z, reflectance);
    add_house_shell(builder, wall, width, eaves, reflectance);
    // A garage at the end of the driveway.
    const WallFrame garage = {{plot.x0 + 0.3, side * (front + 3), 0}, {1, 0, 0}, {0, -side, 0}};
    const double back = kBuildingDepth - kGardenDepth - 3;
    add_wall_box(builder, garage, {0, kDrivewayWidth + 0.5, -kHouseBelowGround, ground_z + 2.5},
                 -back, 0, {label::kBuilding, reflectance * 0.9F});
  }
}

}  // namespace adasplats
