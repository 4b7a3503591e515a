// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adasplats {
namespace {

constexpr std::uint64_t kCityStream = 0x63697479;
constexpr double kPitchEast_m = 150, kPitchNorth_m = 170;  // mean distance between streets
constexpr double kPitchVariety = 0.12;  // maximum shift of a node, as a share of the distance
constexpr int kRun = 3;                 // blocks over which a street keeps its style
constexpr double kTransition_m =
    12;  // length of the transition between styles, before and after a crossing
constexpr double kParkShare = 0.11, kSquareShare = 0.05;

int floor_div(int a, int b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }

/// Removes features that only suit roads in open country: rising land at the sides, dead-end side
/// streets, and ditches, which would block joining streets.
void tame(WorldStyle& style, const CitySectionId& id, int lanes, double median) {
  style.lanes = lanes;
  style.lane_width = std::clamp(style.lane_width, 3.0, 3.5);
  style.median = median;
  style.marked = style.marked || lanes > 1;
  style.driven = 1;
  style.crossfall = style.undulation = 0;
  style.side_streets = style.gantries = 0;
  style.lights = false;
  style.plot_high = std::min(style.plot_high, 32.0);
  style.plot_low = std::min(style.plot_low, 18.0);
  style.setback_high = std::min(style.setback_high, 9.0);
  style.setback_low = std::min(style.setback_low, 6.0);
  if (id.axis == CityAxis::east) style.halls = 0;  // too deep for the strip
  for (SideStyle& side : style.sides) {
    side.bank = side.tilt = side.ditch = side.shoulder = side.noise_wall = 0;
    side.guard_rail = false;
    side.kerb = std::max(side.kerb, 0.05);
    side.sidewalk = std::clamp(side.sidewalk, 1.8, 4.5);
    side.verge = std::min(side.verge, 1.5);
    side.bushes = 0;
    if (side.parking_width <= 0) side.motorcycles = 0;  // they are parked on the road
    side.grass = std::min(side.grass, 40.0);
    if (side.frontage != Frontage::facades) side.frontage = Frontage::houses;
  }
}

}  // namespace

std::string name_of(const CitySectionId& id) {
  const bool east = id.axis == CityAxis::east;
  return "x" + std::to_string(east ? id.block : id.line) + "_y" +
         std::to_string(east ? id.line : id.block) + (east ? "_east" : "_north");
}

double CityRect::distance(double u, double v) const {
  const double du = std::max({u0 - u, 0.0, u - u1});
  const double dv = std::max({v0 - v, 0.0, v - v1});
  return std::hypot(du, dv);
}

CityGrid::CityGrid(std::uint64_t seed) : seed_(seed), land_(seed) {}

Random CityGrid::random(std::uint64_t purpose, std::int64_t a, std::int64_t b) const {
  return {seed_ ^ kCityStream, (purpose << 40) + static_cast<std::uint64_t>(a),
          static_cast<std::uint64_t>(b)};
}

double CityGrid::node(CityAxis axis, int i) const {
  const double pitch = axis == CityAxis::east ? kPitchEast_m : kPitchNorth_m;
  Random random = random_of(*this, CityPurpose::node, street_key(axis, 0), i);
  return pitch * (i + kPitchVariety * random.uniform(-1, 1));
}

int CityGrid::block_at(CityAxis axis, double along) const {
  const double pitch = axis == CityAxis::east ? kPitchEast_m : kPitchNorth_m;
  int block = static_cast<int>(std::floor(along / pitch));
  while (along < node(axis, block)) --block;
  while (along >= node(axis, block + 1)) ++block;
  return block;
}

CityRect CityGrid::rect(const CitySectionId& id) const {
  if (id.axis == CityAxis::east) {
    const double v = node(CityAxis::north, id.line);
    return {node(CityAxis::east, id.block), node(CityAxis::east, id.block + 1), v - kCityRow_m,
            v + kCityRow_m};
  }
  const auto u = [&](int i) { return node(CityAxis::east, i); };
  return {0.5 * (u(id.line - 1) + u(id.line)), 0.5 * (u(id.line) + u(id.line + 1)),
          node(CityAxis::north, id.block) + kCityRow_m,
          node(CityAxis::north, id.block + 1) - kCityRow_m};
}

BlockUse CityGrid::use(int i, int j) const {
  const double draw = random_of(*this, CityPurpose::block, i, j).uniform();
  return draw < kParkShare                  ? BlockUse::park
         : draw < kParkShare + kSquareShare ? BlockUse::square
                                            : BlockUse::built;
}

int CityGrid::lanes(CityAxis axis, int line) const {
  return random_of(*this, CityPurpose::lanes, street_key(axis, line), 0).uniform() < 0.2 ? 2 : 1;
}

WorldKind CityGrid::kind(const CitySectionId& id) const {
  Random random =
      random_of(*this, CityPurpose::kind, street_key(id.axis, id.line), floor_div(id.block, kRun));
  const double draw = random.uniform();
  if (lanes(id.axis, id.line) > 1 || draw < 0.55) return WorldKind::city;
  if (draw < 0.77) return WorldKind::residential;
  return draw < 0.92 ? WorldKind::suburban : WorldKind::rural;
}

WorldStyle CityGrid::style(const CitySectionId& id) const {
  const std::int64_t street = street_key(id.axis, id.line);
  WorldStyle style = draw_world_style(
      kind(id), random_of(*this, CityPurpose::style, street, floor_div(id.block, kRun)));
  Random whole = random_of(*this, CityPurpose::lanes, street, 1);
  const int lanes_of_street = lanes(id.axis, id.line);
  const double median =
      lanes_of_street > 1 && whole.uniform() < 0.5 ? whole.uniform(0.6, 1.8) : 0.0;
  tame(style, id, lanes_of_street, median);
  return style;
}

double CityGrid::lane_center(CityAxis axis, int line, int lane, double along) const {
  const int block = block_at(axis, along);
  const auto of_block = [&](int k) {
    const WorldStyle own = style({axis, line, k});
    return own.median + (lane + 0.5) * own.lane_width;
  };
  const double after = along - node(axis, block);
  const double before = node(axis, block + 1) - along;
  const auto mix = [&](int one, int other, double past) {
    if (floor_div(one, kRun) == floor_div(other, kRun)) return of_block(one);
    const double t = std::clamp((past + kTransition_m) / (2 * kTransition_m), 0.0, 1.0);
    const double share = t * t * (3 - 2 * t);
    return (1 - share) * of_block(one) + share * of_block(other);
  };
  if (after < kTransition_m) return mix(block - 1, block, after);
  if (before < kTransition_m) return mix(block, block + 1, -before);
  return of_block(block);
}

namespace {

BlockUse block_at_side(const CityGrid& grid, const CitySectionId& id, int side) {
  if (id.axis == CityAxis::east) return grid.use(id.block, side > 0 ? id.line : id.line - 1);
  return grid.use(side > 0 ? id.line - 1 : id.line, id.block);
}

LandPosition land_position(const CityGrid& grid, const CitySectionId& id) {
  const CityRect rect = grid.rect(id);
  if (id.axis == CityAxis::east) {
    const double v = grid.node(CityAxis::north, id.line);
    return
        [land = grid.land(), u = rect.u0, v](double s, double d) { return land.at(u + s, v + d); };
  }
  const double u = grid.node(CityAxis::east, id.line);
  return [land = grid.land(), u, v = rect.v0](double s, double d) { return land.at(u - d, v + s); };
}

double length_of(const CityGrid& grid, const CitySectionId& id) {
  const CityRect rect = grid.rect(id);
  return id.axis == CityAxis::east ? rect.u1 - rect.u0 : rect.v1 - rect.v0;
}

/// Plots of one side from `s` to `end`, without gaps.
void draw_city_plots(const CityGrid& grid, const CitySectionId& id, const WorldStyle& style,
                     int side, double s, double end, std::vector<WorldPlot>& plots) {
  const BlockUse use = block_at_side(grid, id, side);
  if (use != BlockUse::built) {
    WorldPlot whole{.side = side, .s0 = s, .s1 = end, .number = plots.size()};
    whole.use = use == BlockUse::park ? Frontage::park : Frontage::square;
    plots.push_back(whole);
    return;
  }
  Random draw = random_of(grid, CityPurpose::plots, street_key(id.axis, id.line),
                          2 * static_cast<std::int64_t>(id.block) + (side > 0 ? 1 : 0));
  const double fenceless = draw.uniform(0, 0.5);
  while (s < end) {
    WorldPlot plot = draw_world_plot(style, side, s, fenceless, draw);
    plot.number = plots.size();
    if (end - plot.s1 < style.plot_low) plot.s1 = end;
    s = plot.s1;
    plots.push_back(plot);
  }
}

}  // namespace

WorldPlan CityGrid::plan(const CitySectionId& id, bool bare) const {
  const double length_m = length_of(*this, id);
  const std::int64_t street = street_key(id.axis, id.line);
  const WorldOptions options = {
      random_of(*this, CityPurpose::section, street, id.block).next_bits(), kind(id), length_m};
  WorldLayout layout = {.style = style(id),
                        .route = WorldRoute(length_m, land_position(*this, id))};
  const CityRect own = rect(id);
  if (id.axis == CityAxis::east) {
    layout.reach_m = {kCityRow_m, kCityRow_m};
  } else {
    const double axis_u = node(CityAxis::east, id.line);
    layout.reach_m = {axis_u - own.u0, own.u1 - axis_u};
  }
  if (bare) return {options, std::move(layout)};
  const bool crossed = id.axis == CityAxis::east;
  const WorldPlan profile = plan(id, true);
  for (const int side : {1, -1}) {
    CityCrossing ends[2];  // zero where a street begins and ends at a strip
    if (crossed) {
      for (const bool at_end : {false, true})
        ends[at_end ? 1 : 0] = add_crossing(*this, id, profile, side, at_end, layout.patches);
    }
    draw_city_plots(*this, id, layout.style, side, ends[0].reach_m, length_m - ends[1].reach_m,
                    layout.plots);
  }
  add_open_ground(id, profile, layout.plots, layout.patches);
  return {options, std::move(layout)};
}

namespace {

constexpr std::uint64_t kLandStream = 0x6c616e64;
constexpr double kMaxSlopeOfBend = 0.045;  // per wave: crossings within 10 degrees of square
constexpr double kMaxSlopeOfHill = 0.014;

}  // namespace

double CityLand::Wave::at(double t) const {
  return amplitude * std::sin(kFullTurn * t / length_m + phase);
}

CityLand::CityLand(std::uint64_t seed) {
  Random random(seed, kLandStream, 0);
  const auto draw = [&](double shortest, double longest, double slope) {
    Wave wave = {0, random.uniform(shortest, longest), random.uniform(0, kFullTurn)};
    wave.amplitude = random.uniform(0.2, 1) * slope * wave.length_m / kFullTurn;
    return wave;
  };
  for (Wave& wave : shift_east_) wave = draw(400, 1100, kMaxSlopeOfBend);
  for (Wave& wave : shift_north_) wave = draw(400, 1100, kMaxSlopeOfBend);
  for (Hill& hill : hills_) {
    hill.wave = draw(250, 1000, kMaxSlopeOfHill);
    const double direction = random.uniform(0, kFullTurn);
    hill.east = std::cos(direction);
    hill.north = std::sin(direction);
  }
}

Vec3d CityLand::at(double u, double v) const {
  Vec3d position = {u, v, 0};
  for (const Wave& wave : shift_east_) position.x += wave.at(v);
  for (const Wave& wave : shift_north_) position.y += wave.at(u);
  for (const Hill& hill : hills_) position.z += hill.wave.at(hill.east * u + hill.north * v);
  return position;
}

}  // namespace adasplats
