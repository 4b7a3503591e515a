// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world_plan.h"

namespace adasplats {
namespace {

/// Shorthands for the draws of one style.
class Draw {
 public:
  explicit Draw(Random random) : random_(random) {}
  double in(double low, double high) { return random_.uniform(low, high); }
  bool chance(double share) { return random_.uniform() < share; }
  /// Mostly small, sometimes near the maximum, like the variety of real streets.
  double few(double max) { return max * in(0, 1) * in(0.2, 1); }

 private:
  Random random_;
};

void draw_residential(WorldStyle& style, Draw& draw) {
  style.lane_width = draw.in(2.4, 3.5);
  style.marked = draw.chance(0.3);
  style.side_streets = draw.in(0.5, 1.6);
  style.plot_low = draw.in(8, 12);
  style.plot_high = style.plot_low + draw.in(3, 12);
  style.setback_low = draw.in(0.5, 4);
  style.setback_high = style.setback_low + draw.in(0.5, 5);
  style.garden_trees = draw.in(0.5, 4);
  style.garden_bushes = draw.in(3, 18);
  style.leafiness = draw.in(0.7, 1.7);
  style.edge_bushes = draw.few(1);
  style.car_parks = draw.in(0, 0.1);
  style.halls = draw.in(0, 0.08);
  style.cars = draw.few(1.5);
  style.cyclists = draw.few(0.8);
  style.motorcyclists = draw.few(0.6);
  style.walkers = draw.few(3);
  for (SideStyle& side : style.sides) {
    side.parking_width = draw.chance(0.7) ? draw.in(1.9, 2.4) : 0;
    side.parking_marked = draw.chance(0.4);
    side.parked_share = draw.in(0.15, 0.85);
    side.kerb = draw.in(0.05, 0.15);
    side.verge = draw.chance(0.3) ? draw.in(0.8, 2.2) : 0;
    side.sidewalk = draw.in(1.3, 3);
    side.trees = draw.chance(0.6) ? draw.in(1, 7) : 0;
    side.lamps = draw.in(1.5, 4);
    side.signs = draw.in(0.5, 4);
    side.people = draw.few(3);
    side.bicycles = draw.few(6);
    side.motorcycles = draw.few(1.5);
    side.boxes = draw.in(0, 4);
    side.bollards = draw.chance(0.2) ? draw.in(3, 12) : 0;
    side.tilt = draw.in(-0.04, 0.05);
  }
}

void draw_suburban(WorldStyle& style, Draw& draw) {
  draw_residential(style, draw);
  style.lane_width = draw.in(3, 4.3);
  style.plot_low = draw.in(15, 22);
  style.plot_high = style.plot_low + draw.in(4, 16);
  style.setback_low = draw.in(4, 8);
  style.setback_high = style.setback_low + draw.in(2, 8);
  style.garden_trees = draw.in(3, 9);
  style.garden_bushes = draw.in(8, 34);
  style.edge_bushes = draw.in(0.2, 1.2);
  style.undulation = draw.in(0.15, 0.5);
  style.roughness = draw.in(0.03, 0.06);
  for (SideStyle& side : style.sides) {
    side.frontage = draw.chance(0.15) ? Frontage::wood : Frontage::houses;
    side.parking_width = draw.chance(0.25) ? 2.2 : 0;
    side.parked_share = draw.in(0, 0.35);
    side.verge = draw.chance(0.6) ? draw.in(1, 4) : 0;
    side.sidewalk = draw.chance(0.75) ? draw.in(1.3, 2.4) : 0;
    side.kerb = side.sidewalk > 0 ? draw.in(0.04, 0.14) : 0;
    side.power_line = draw.chance(0.3);
    side.bank = draw.in(-0.6, 1.2);
    side.tilt = draw.in(-0.06, 0.09);
  }
}

void draw_rural(WorldStyle& style, Draw& draw) {
  style.lane_width = draw.in(2.8, 4.2);
  style.marked = draw.chance(0.6);
  style.undulation = draw.in(0.2, 1.2);
  style.roughness = draw.in(0.02, 0.06);
  style.side_streets = draw.in(0, 0.5);
  style.plot_low = 25;
  style.plot_high = 70;
  style.setback_low = 5;
  style.setback_high = 20;
  style.garden_trees = draw.in(2, 8);
  style.garden_bushes = draw.in(4, 20);
  style.edge_bushes = draw.in(0, 1.2);
  style.leafiness = draw.in(0.7, 1.6);
  style.cars = draw.few(1.5);
  style.trucks = draw.few(0.5);
  style.motorcyclists = draw.few(0.6);
  style.cyclists = draw.few(0.6);
  style.walkers = draw.few(0.4);
  style.speed_m_per_s = draw.in(14, 24);
  style.car_parks = draw.in(0, 0.06);
  style.halls = draw.in(0, 0.12);
  for (SideStyle& side : style.sides) {
    side.frontage = draw.chance(0.45) ? Frontage::wood : Frontage::open;
    side.shoulder = draw.in(0.2, 1);
    side.kerb = 0;
    side.sidewalk = draw.chance(0.25) ? draw.in(1.2, 2) : 0;
    side.verge = draw.in(0.6, 3.5);
    side.trees = draw.chance(0.5) ? draw.in(2, 12) : draw.few(2);
    side.bushes = draw.in(2, 60);
    side.grass = draw.few(120);
    side.lamps = draw.chance(0.15) ? draw.in(1, 3) : 0;
    side.signs = draw.in(0.3, 2);
    side.bollards = draw.in(1, 5);
    side.boxes = 0;
    side.people = side.bicycles = side.motorcycles = draw.few(0.6);
    side.power_line = draw.chance(0.4);
    side.guard_rail = draw.chance(0.15);
    side.ditch = draw.chance(0.6) ? draw.in(0.3, 1) : 0;
    side.bank = draw.in(-1.5, 2.5);
    side.tilt = draw.in(-0.1, 0.12);
  }
}

void draw_motorway(WorldStyle& style, Draw& draw) {
  style.lanes = draw.chance(0.4) ? 3 : 2;
  style.lane_width = draw.in(3.5, 3.8);
  style.median = draw.in(1, 3);
  style.undulation = draw.in(0.2, 0.8);
  style.roughness = draw.in(0.04, 0.09);
  style.side_streets = 0;
  style.leafiness = draw.in(0.7, 1.5);
  style.cars = draw.in(1, 5);
  style.trucks = draw.in(0.3, 2);
  style.buses = draw.few(0.4);
  style.motorcyclists = draw.few(0.6);
  style.cyclists = style.walkers = 0;
  style.speed_m_per_s = draw.in(22, 32);
  style.halls = draw.in(0, 0.2);
  style.gantries = draw.in(0, 1.2);
  for (SideStyle& side : style.sides) {
    side.frontage = draw.chance(0.5) ? Frontage::wood : Frontage::open;
    side.shoulder = draw.in(1.5, 3);
    side.kerb = 0;
    side.sidewalk = 0;
    side.verge = draw.in(1.5, 5);
    side.trees = draw.few(5);
    side.bushes = draw.in(0, 30);
    side.grass = draw.few(80);
    side.lamps = draw.chance(0.3) ? draw.in(1.5, 3) : 0;
    side.signs = draw.in(0.5, 2);
    side.bollards = draw.in(1, 4);
    side.boxes = draw.few(0.5);
    side.people = side.bicycles = side.motorcycles = 0;
    side.guard_rail = draw.chance(0.7);
    side.noise_wall = draw.chance(0.35) ? draw.in(2, 4.5) : 0;
    side.ditch = draw.chance(0.4) ? draw.in(0.3, 0.8) : 0;
    side.bank = draw.in(-3, 4);
    side.tilt = draw.in(-0.06, 0.08);
  }
}

void draw_city(WorldStyle& style, Draw& draw) {
  style.lanes = draw.chance(0.35) ? 2 : 1;
  style.lane_width = draw.in(2.8, 3.4);
  style.median = draw.chance(0.2) ? draw.in(0.6, 2) : 0;
  style.side_streets = draw.in(0.6, 1.5);
  style.plot_low = 18;
  style.plot_high = 45;
  style.leafiness = draw.in(0.6, 1.2);
  style.undulation = 0.05;
  style.cars = draw.in(0.5, 3);
  style.trucks = draw.few(0.8);
  style.buses = draw.few(0.8);
  style.cyclists = draw.in(0.3, 3);
  style.motorcyclists = draw.few(1);
  style.walkers = draw.in(2, 10);
  style.car_parks = draw.in(0, 0.12);
  style.lights = draw.chance(0.6);
  style.tram = draw.chance(0.5) ? draw.in(2, 4) : 0;
  for (SideStyle& side : style.sides) {
    side.frontage = draw.chance(0.85) ? Frontage::facades : Frontage::houses;
    side.parking_width = draw.chance(0.55) ? draw.in(2, 2.4) : 0;
    side.parking_marked = draw.chance(0.6);
    side.parked_share = draw.in(0.2, 0.8);
    side.kerb = draw.in(0.08, 0.16);
    side.verge = draw.chance(0.15) ? draw.in(1.5, 3) : 0;
    side.sidewalk = draw.in(2, 6);
    side.trees = draw.chance(0.75) ? draw.in(2, 13) : 0;
    side.bushes = 0;
    side.lamps = draw.in(2, 5);
    side.signs = draw.in(2, 7);
    side.bollards = draw.chance(0.5) ? draw.in(4, 20) : 0;
    side.boxes = draw.in(2, 7);
    side.people = draw.in(1, 10);
    side.bicycles = draw.in(0, 14);
    side.motorcycles = draw.few(4);
    side.tilt = 0;
  }
}

}  // namespace

RouteLimits route_limits(WorldKind kind) {
  switch (kind) {
    case WorldKind::residential: return {90, 0.035};
    case WorldKind::suburban: return {90, 0.05};
    case WorldKind::rural: return {90, 0.06};
    case WorldKind::motorway: return {400, 0.03};
    case WorldKind::city: return {250, 0.025};
  }
  return {};
}

WorldStyle draw_world_style(WorldKind kind, Random random) {
  WorldStyle style;
  Draw draw(random);
  const double share = draw.in(0.25, 0.95);
  switch (kind) {
    case WorldKind::residential: draw_residential(style, draw); break;
    case WorldKind::suburban: draw_suburban(style, draw); break;
    case WorldKind::rural: draw_rural(style, draw); break;
    case WorldKind::motorway: draw_motorway(style, draw); break;
    case WorldKind::city: draw_city(style, draw); break;
  }
  style.driven = style.marked || style.lanes > 1 ? 1 : share;
  return style;
}

}  // namespace adasplats
