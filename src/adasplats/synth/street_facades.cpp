// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr double kFloorHeight = 3.05;
constexpr double kGroundFloorHeight = 3.7;
constexpr double kBelowGround = 0.5;  // walls extend below the uneven ground

enum class Roof : std::uint8_t { flat, mansard };

/// Appearance of one apartment building.
struct Building {
  double width = 12;
  double depth = kBuildingDepth;
  int upper_floors = 4;
  int bays = 4;
  float reflectance = 0.5F;
  OpeningKind windows = OpeningKind::window;
  bool shops = false;
  int balcony_floor = 2;          ///< floor with one long balcony; 0: none
  bool single_balconies = false;  ///< at every second bay of the other floors
  Roof roof = Roof::mansard;

  double floor_z(int floor) const {  ///< floor 1 is the first above the ground floor
    return kGroundFloorHeight + (floor - 1) * kFloorHeight;
  }
  double wall_height() const { return floor_z(upper_floors + 1); }
  double bay_width() const { return width / bays; }
};

Building draw_building(double width, Random& random) {
  Building building;
  building.width = width;
  building.upper_floors = 2 + static_cast<int>(random.uniform(0, 3.99));
  building.bays = std::max(2, static_cast<int>(std::lround(width / random.uniform(2.6, 3.3))));
  building.reflectance = static_cast<float>(random.uniform(0.35, 0.62));
  building.windows = random.uniform() < 0.4 ? OpeningKind::shutters : OpeningKind::window;
  building.shops = random.uniform() < 0.5;
  building.balcony_floor = random.uniform() < 0.7 ? 2 : 0;
  building.single_balconies = random.uniform() < 0.45;
  building.roof = random.uniform() < 0.65 ? Roof::mansard : Roof::flat;
  return building;
}

void add_ground_floor(MeshBuilder& builder, const WallFrame& wall, const Building& building,
                      double ground_z) {
  const double bay = building.bay_width();
  const int door_bay = building.bays / 2;
  for (int b = 0; b < building.bays; ++b) {
    const WallRect panel = {b * bay, (b + 1) * bay, -kBelowGround, kGroundFloorHeight};
    const double middle = (b + 0.5) * bay;
    if (b == door_bay) {
      add_wall_with_opening(builder, wall, panel,
                            {middle - 0.65, middle + 0.65, ground_z + 0.1, ground_z + 2.6},
                            OpeningKind::door, building.reflectance);
    } else if (building.shops) {
      add_wall_with_opening(builder, wall, panel,
                            {panel.a0 + 0.3, panel.a1 - 0.3, ground_z + 0.4, ground_z + 2.9},
                            OpeningKind::shop, building.reflectance);
    } else {
      add_wall_with_opening(builder, wall, panel,
                            {middle - 0.55, middle + 0.55, ground_z + 1.1, ground_z + 2.8},
                            OpeningKind::window, building.reflectance);
    }
  }
}

void add_upper_floor(MeshBuilder& builder, const WallFrame& wall, const Building& building,
                     int floor) {
  const double bay = building.bay_width();
  const double z = building.floor_z(floor);
  const bool long_balcony = floor == building.balcony_floor;
  if (long_balcony) add_balcony(builder, wall, 0.3, building.width - 0.3, z, 0.8);
  for (int b = 0; b < building.bays; ++b) {
    const WallRect panel = {b * bay, (b + 1) * bay, z, z + kFloorHeight};
    const double middle = (b + 0.5) * bay;
    const bool own_balcony = !long_balcony && building.single_balconies && b % 2 == floor % 2;
    const bool french = long_balcony || own_balcony;
    const WallRect hole = {middle - 0.58, middle + 0.58, z + (french ? 0.05 : 0.85), z + 2.45};
    add_wall_with_opening(builder, wall, panel, hole,
                          french ? OpeningKind::french_window : building.windows,
                          building.reflectance);
    if (own_balcony) add_balcony(builder, wall, middle - 1.0, middle + 1.0, z, 0.7);
  }
  if (!long_balcony)  // string course
    add_wall_box(builder, wall, {0, building.width, z - 0.09, z}, 0, 0.07,
                 {label::kBuilding, building.reflectance * 1.1F});
}

void add_dormers(MeshBuilder& builder, const WallFrame& wall, const Building& building,
                 const Material& slate) {
  const double top = building.wall_height();
  for (int b = 0; b < building.bays; ++b) {
    const double middle = (b + 0.5) * building.bay_width();
    add_wall_box(builder, wall, {middle - 0.6, middle + 0.6, top + 0.4, top + 2.0}, -1.3, -0.15,
                 slate);
    add_wall_box(builder, wall, {middle - 0.42, middle + 0.42, top + 0.6, top + 1.8}, -0.15, -0.12,
                 {label::kBuilding, 0.09F});
  }
}

/// Roof, side walls and back wall.
void add_shell(MeshBuilder& builder, const WallFrame& wall, const Building& building) {
  const Material stone = {label::kBuilding, building.reflectance * 0.85F};
  const Material slate = {label::kBuilding, 0.18F};
  const double top = building.wall_height();
  const bool mansard = building.roof == Roof::mansard;
  const double ridge = mansard ? top + 2.5 : top;
  const double step = mansard ? 1.3 : 0;  // from the foot of the roof to its flat top
  const double back = -building.depth;
  for (const double a : {0.0, building.width}) {
    builder.quad(wall(a, 0, -kBelowGround), wall(a, back, -kBelowGround), wall(a, back, top),
                 wall(a, 0, top), stone);
    if (mansard)
      builder.quad(wall(a, 0, top), wall(a, back, top), wall(a, back, ridge), wall(a, -step, ridge),
                   stone);
  }
  builder.quad(wall(0, back, -kBelowGround), wall(building.width, back, -kBelowGround),
               wall(building.width, back, ridge), wall(0, back, ridge), stone);
  builder.quad(wall(0, -step, ridge), wall(building.width, -step, ridge),
               wall(building.width, back, ridge), wall(0, back, ridge), slate);
  add_wall_box(builder, wall, {0, building.width, top - 0.22, top}, 0, 0.32, stone);  // cornice
  if (mansard) {
    builder.quad(wall(0, 0, top), wall(building.width, 0, top), wall(building.width, -step, ridge),
                 wall(0, -step, ridge), slate);
    add_dormers(builder, wall, building, slate);
  } else {
    add_wall_box(builder, wall, {0, building.width, top, top + 0.7}, -0.2, 0, stone);  // parapet
  }
  for (const double share : {0.15, 0.8}) {  // chimneys
    const double a = share * building.width;
    add_wall_box(builder, wall, {a - 0.35, a + 0.35, ridge, ridge + 1.4}, -4.6, -3.6, stone);
  }
}

void add_downpipe(MeshBuilder& builder, const WallFrame& wall, const Building& building) {
  builder.tube(wall(0.12, 0.09, -kBelowGround), wall(0.12, 0.09, building.wall_height() - 0.22),
               0.05, 0.05, 8, {label::kBuilding, 0.5F});
}

void add_building(MeshBuilder& builder, const WallFrame& wall, const Building& building,
                  double ground_z) {
  add_ground_floor(builder, wall, building, ground_z);
  for (int floor = 1; floor <= building.upper_floors; ++floor)
    add_upper_floor(builder, wall, building, floor);
  add_shell(builder, wall, building);
  add_downpipe(builder, wall, building);
}

void add_row(const StreetPlan& plan, MeshBuilder& builder, const WallFrame& wall, double length,
             std::uint64_t number) {
  Random random = random_of(plan, Purpose::facade, number);
  add_facade_row(builder, wall, length, kKerbHeight, random);
}

}  // namespace

void add_facade_row(MeshBuilder& builder, WallFrame wall, double length, double ground_z,
                    Random& random) {
  const int count = std::max(1, static_cast<int>(std::lround(length / 13)));
  for (int k = 0; k < count; ++k) {
    add_building(builder, wall, draw_building(length / count, random), ground_z);
    wall.origin = wall.origin + wall.along * (length / count);
  }
}

void add_facades(const StreetPlan& plan, MeshBuilder& builder) {
  for (const Plot& plot : plan.plots) {
    const double side = plot.side;
    if (plot.kind == PlotKind::apartment) {
      Random random = random_of(plan, Purpose::facade, plot.number);
      const double front = kSidewalkEdge + random.uniform(0, 0.45);
      const WallFrame wall = {{plot.x0, side * front, 0}, {1, 0, 0}, {0, -side, 0}};
      Building building = draw_building(plot.width(), random);
      building.depth = kSidewalkEdge + kBuildingDepth - front;
      add_building(builder, wall, building, sidewalk_height(plot.center(), front));
    } else if (plot.kind == PlotKind::side_street) {
      // A row of buildings closes the view; walls line the side street behind the corner buildings.
      const WallFrame end = {{plot.x0 - 6, side * kSideStreetEnd, 0}, {1, 0, 0}, {0, -side, 0}};
      add_row(plan, builder, end, plot.width() + 12, 5000 + plot.number);
      for (const double x : {plot.x0, plot.x1}) {
        const double y0 = kSidewalkEdge + kBuildingDepth;
        builder.box({x - 0.12, std::min(side * y0, side * kSideStreetEnd), -kBelowGround},
                    {x + 0.12, std::max(side * y0, side * kSideStreetEnd), 2.6},
                    {label::kOtherStructure, 0.35F});
      }
    }
  }
  const double half = kCrossHalfLength;
  add_row(plan, builder, {{-kCrossEnd, -half, 0}, {0, 1, 0}, {1, 0, 0}}, 2 * half, 9001);
  add_row(plan, builder, {{plan.length + kCrossEnd, -half, 0}, {0, 1, 0}, {-1, 0, 0}}, 2 * half,
          9002);
}

}  // namespace adasplats
