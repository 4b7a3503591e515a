// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/world/world_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace adasplats {
namespace {

constexpr std::uint64_t kWorldStream = 0x776f726c64;  // separate from the street's
constexpr double kDrivewayHalf = 1.5;

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

EdgeKind draw_edge(Random& random, double none) {
  if (random.uniform() < none) return EdgeKind::none;
  const double draw = random.uniform();
  if (draw < 0.48) return EdgeKind::hedge;
  if (draw < 0.58) return EdgeKind::picket;
  if (draw < 0.67) return EdgeKind::bars;
  if (draw < 0.79) return EdgeKind::mesh;
  if (draw < 0.87) return EdgeKind::boards;
  return EdgeKind::wall;
}

}  // namespace

WorldPlot draw_world_plot(const WorldStyle& style, int side, double s, double fenceless,
                          Random& draw) {
  const Frontage frontage = style.sides[side > 0 ? 0 : 1].frontage;
  WorldPlot plot{.side = side, .s0 = s, .use = frontage};
  plot.s1 = s + draw.uniform(style.plot_low, style.plot_high);
  if (frontage == Frontage::open && draw.uniform() < 0.12) plot.use = Frontage::houses;
  if (frontage == Frontage::houses && draw.uniform() < 0.06) plot.use = Frontage::wood;
  if (frontage == Frontage::facades && draw.uniform() < 0.13) plot.use = Frontage::open;
  const double other_use = draw.uniform();
  if (other_use < style.car_parks)
    plot.use = Frontage::car_park;
  else if (other_use < style.car_parks + style.halls)
    plot.use = Frontage::hall;
  plot.setback = draw.uniform(style.setback_low, style.setback_high);
  plot.front = draw_edge(draw, fenceless);
  plot.between = draw_edge(draw, fenceless + 0.1);
  const double tall = draw.uniform();
  plot.edge_height = 0.4 + 1.5 * tall * tall;
  plot.driveway = plot.use == Frontage::houses && plot.width() > 11 && draw.uniform() < 0.7;
  return plot;
}

WorldPlan::WorldPlan(const WorldOptions& world_options)
    : options(world_options),
      style(draw_world_style(options.kind, random(0, 1))),
      route(options.length_m, route_limits(options.kind), random(0, 2)) {
  draw_ground();
  draw_strips();
  draw_plots();
  draw_patches();
}

WorldPlan::WorldPlan(const WorldOptions& world_options, WorldLayout layout)
    : options(world_options),
      style(layout.style),
      route(std::move(layout.route)),
      reach_m(layout.reach_m),
      land_step(layout.land_step),
      patches(std::move(layout.patches)),
      plots(std::move(layout.plots)) {
  draw_ground();
  draw_strips();
  draw_patches();
}

void WorldPlan::draw_ground() {
  Random reflectances = random(0, 3);
  constexpr std::array<double, kGroundCount> kTypical = {0.46, 0.7, 0.5, 0.58, 0.54, 0.66};
  for (std::size_t k = 0; k < kGroundCount; ++k)
    ground_reflectances[k] = static_cast<float>(kTypical[k] * reflectances.uniform(0.75, 1.25));
  Random swell = random(0, 4);
  for (auto& [direction, wavelength, phase, share] : swells_) {
    direction = swell.uniform(0, 2 * std::numbers::pi);
    wavelength = swell.uniform(9, 60);
    phase = swell.uniform(0, 2 * std::numbers::pi);
    share = wavelength / 60;
  }
}

Random WorldPlan::random(std::uint64_t purpose, std::uint64_t number) const {
  const auto kind = static_cast<std::uint64_t>(options.kind);
  return {options.seed, kWorldStream + 1000 * kind + purpose, number};
}

double WorldPlan::road_end(int which) const {
  return lanes_end() + side(which).parking_width + side(which).shoulder;
}

double WorldPlan::property_line(int which) const {
  return road_end(which) + side(which).verge + side(which).sidewalk;
}

void WorldPlan::draw_strips() {
  for (const int which : {1, -1}) {
    const SideStyle& own = side(which);
    std::vector<Strip>& list = strips[which > 0 ? 0 : 1];
    constexpr double kLine = 0.075;  // half the width of a painted line
    Random draw = random(1, which > 0 ? 1 : 0);
    if (style.median > 0)
      list.push_back({style.median, draw.uniform() < 0.6 ? Ground::terrain : Ground::other, 0});
    else if (style.marked)
      list.push_back({kLine, Ground::marking, 0});
    for (int lane = 1; style.marked && lane < style.lanes; ++lane) {
      const double line = style.median + lane * style.lane_width;
      list.push_back({line - kLine, Ground::road, 0});
      list.push_back({line + kLine, Ground::marking, 0});
    }
    list.push_back({lanes_end(), Ground::road, 0});
    if (own.parking_width > 0)
      list.push_back({lanes_end() + own.parking_width,
                      own.parking_marked ? Ground::parking : Ground::road, 0});
    if (own.shoulder > 0)
      list.push_back(
          {road_end(which), options.kind == WorldKind::motorway ? Ground::road : Ground::other, 0});
    const bool sidewalk_first = draw.uniform() < 0.4 && own.kerb > 0;
    const double middle = road_end(which) + (sidewalk_first ? own.sidewalk : own.verge);
    const Ground inner = sidewalk_first ? Ground::sidewalk : Ground::terrain;
    const Ground outer = sidewalk_first ? Ground::terrain : Ground::sidewalk;
    if (middle > road_end(which)) list.push_back({middle, inner, own.kerb});
    if (property_line(which) > middle) list.push_back({property_line(which), outer, own.kerb});
    list.push_back({reach(which), Ground::terrain, land_step.value_or(own.kerb)});
  }
}

void WorldPlan::draw_plots() {
  std::uint64_t number = 0;
  for (const int which : {1, -1}) {
    Random draw = random(2, which > 0 ? 1 : 0);
    double s = -draw.uniform(0, 10);
    const double fenceless = draw.uniform(0, 0.5);
    while (s < options.length_m) {
      WorldPlot plot = draw_world_plot(style, which, s, fenceless, draw);
      plot.number = number++;
      s = plot.s1;
      if (draw.uniform() < style.side_streets * plot.width() / 100) s += draw.uniform(8, 13);
      plots.push_back(plot);
    }
  }
}

void WorldPlan::draw_patches() {
  for (const int which : {1, -1}) {
    Random draw = random(3, which > 0 ? 1 : 0);
    const SideStyle& own = side(which);
    const double edge = property_line(which);
    const double road = road_end(which);
    const Ground drive = draw.uniform() < 0.6   ? Ground::parking
                         : draw.uniform() < 0.6 ? Ground::sidewalk
                                                : Ground::other;
    const Ground square = draw.uniform() < 0.5 ? Ground::other : Ground::sidewalk;
    double last = -1e9;
    for (const WorldPlot& plot : plots) {
      if (plot.side != which) continue;
      if (last > -1e8 && plot.s0 - last > 1) {  // a street joins between two plots
        patches.push_back(
            {which, last + 1.8, plot.s0 - 1.8, road, reach(which), Ground::road, 0, true});
        if (own.sidewalk > 0)
          for (const double s : {last, plot.s0 - 1.8})
            patches.push_back({which, s, s + 1.8, edge, reach(which), Ground::sidewalk, own.kerb});
      }
      last = plot.s1;
      if (plot.use == Frontage::facades || (plot.use == Frontage::open && own.sidewalk > 2))
        patches.push_back({which, plot.s0, plot.s1, edge, edge + 14, square, own.kerb});
      if (plot.use == Frontage::houses && plot.setback < 6 && draw.uniform() < 0.25)  // paved
        patches.push_back({which, plot.s0, plot.s1, edge, edge + plot.setback, drive, own.kerb});
      if (plot.use == Frontage::car_park)
        patches.push_back({which, plot.s0 + 0.5, plot.s1 - 0.5, edge + 0.7, edge + kCarPark_m,
                           Ground::parking, own.kerb});
      if (!plot.driveway) continue;
      const double middle = plot.s0 + kDrivewayHalf + 0.4;
      const double depth = edge + plot.setback + draw.uniform(0, 6);
      patches.push_back({which, middle - kDrivewayHalf, middle + kDrivewayHalf, edge, depth, drive,
                         own.kerb, true});
    }
    draw_islands(which);
  }
}

void WorldPlan::draw_islands(int which) {
  Random draw = random(5, which > 0 ? 1 : 0);
  const SideStyle& own = side(which);
  if (own.parking_width <= 0 || draw.uniform() > 0.45) return;
  const double apart = draw.uniform(12, 28);
  const double length_m = draw.uniform(1.2, 4);
  for (double s = draw.uniform(0, apart); s < options.length_m; s += apart) {
    if (is_open(which, s - 1, s + length_m + 1)) continue;
    patches.push_back({.side = which,
                       .s0 = s,
                       .s1 = s + length_m,
                       .d0 = lanes_end() + 0.25,
                       .d1 = road_end(which),
                       .ground = Ground::terrain,
                       .step = own.kerb,
                       .is_island = true});
  }
}

bool WorldPlan::has_island(int which, double s0, double s1) const {
  return std::ranges::any_of(patches, [&](const Patch& patch) {
    return patch.side == which && patch.is_island && s1 > patch.s0 && s0 < patch.s1;
  });
}

WorldPlan::Cell WorldPlan::cell_at(double s, double d) const {
  const int which = d > 0 ? 1 : -1;
  const double off = std::fabs(d);
  for (auto patch = patches.rbegin(); patch != patches.rend(); ++patch)
    if (patch->side == which && s >= patch->s0 && s < patch->s1 && off >= patch->d0 &&
        off < patch->d1)
      return {patch->ground, patch->step};
  for (const Strip& strip : strips_of(which))
    if (off < strip.to) return {strip.ground, strip.step};
  return {Ground::terrain, strips_of(which).back().step};
}

double WorldPlan::height(double s, double d) const {
  const int which = d > 0 ? 1 : -1;
  const SideStyle& own = side(which);
  const double off = std::fabs(d);
  const double crossfall = style.crossfall * std::min(off, road_end(which));
  const double beyond = std::max(0.0, off - property_line(which));
  const double roads_edge = off - road_end(which);
  double z = route.land_height(s, d) - crossfall;
  z += own.bank * smooth_step((beyond - 2) / 7) + own.tilt * std::max(0.0, beyond - 2);
  z -= own.ditch * std::exp(-std::pow((roads_edge - 2.2) / 0.8, 2));
  if (beyond <= 0) return z;
  const Vec3d position = route.at(s, d);
  double swell = 0;
  for (const auto& [direction, wavelength, phase, share] : swells_)
    swell +=
        share * std::sin(2 * std::numbers::pi *
                             (position.x * std::cos(direction) + position.y * std::sin(direction)) /
                             wavelength +
                         phase);
  return z + style.undulation * swell * smooth_step(beyond / 12);
}

Vec3d WorldPlan::ground_at(double s, double d) const {
  Vec3d position = route.at(s, d);
  position.z = height(s, d) + cell_at(s, d).step;
  return position;
}

RigidTransform WorldPlan::pose_at(double s, int which, double from_axis, double yaw) const {
  const double turned = which > 0 ? 0 : std::numbers::pi;
  return {rotation_from_yaw_pitch_roll(route.heading(s) + turned + yaw, 0, 0),
          ground_at(s, which * from_axis)};
}

bool WorldPlan::is_open(int which, double s0, double s1) const {
  return std::ranges::any_of(patches, [&](const Patch& patch) {
    return patch.side == which && patch.crosses_sidewalk && s1 > patch.s0 && s0 < patch.s1;
  });
}

bool WorldPlan::is_crossing(int which, double s) const {
  return std::ranges::any_of(patches, [&](const Patch& patch) {
    return patch.side == which && patch.is_crossing && s >= patch.s0 && s <= patch.s1;
  });
}

}  // namespace adasplats
