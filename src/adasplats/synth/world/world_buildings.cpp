// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/synth/street_parts.h"
#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr double kFooting = 1.6;  // walls extend below sloping land
constexpr double kStorey = 2.75;
// Distance behind the sidewalk at which a row along a joining street begins, and its minimum
// length.
constexpr double kRowBehindFacades_m = 11.5, kRowBehindHouses_m = 22;
constexpr double kMinRow_m = 5;

struct WorldHouse {
  double width = 9, depth = 8;
  int storeys = 2;
  double roof = 3;  ///< height of the ridge above the eaves; 0: flat
  bool ridge_along = true;
  float wall = 0.5F, tiles = 0.3F;
  double eaves() const { return storeys * kStorey + 0.3; }
};

WorldHouse draw_house(double widest, Random& random) {
  WorldHouse house;
  house.width = std::clamp(random.uniform(7, 14), 4.5, std::max(4.5, widest));
  house.depth = random.uniform(6.5, 12);
  house.storeys = random.uniform() < 0.25 ? 1 : random.uniform() < 0.8 ? 2 : 3;
  house.roof = random.uniform() < 0.12 ? 0 : random.uniform(1.5, 4.2);
  house.ridge_along = random.uniform() < 0.65;
  house.wall = static_cast<float>(random.uniform(0.42, 0.8));
  house.tiles = static_cast<float>(random.uniform(0.15, 0.5));
  return house;
}

/// One wall with an opening in most bays, storey by storey.
void add_house_wall(MeshBuilder& builder, const WallFrame& wall, double width,
                    const WorldHouse& house, bool has_door, Random& random) {
  const int bays = std::max(1, static_cast<int>(std::lround(width / random.uniform(2.4, 3.6))));
  const double bay = width / bays;
  const int door = has_door ? static_cast<int>(random.uniform() * bays) : -1;
  const bool shutters = random.uniform() < 0.3;
  for (int storey = 0; storey < house.storeys; ++storey) {
    const double floor = 0.25 + storey * kStorey;
    const double top = storey + 1 == house.storeys ? house.eaves() : floor + kStorey;
    for (int b = 0; b < bays; ++b) {
      const WallRect panel = {b * bay, (b + 1) * bay, storey == 0 ? -kFooting : floor, top};
      const double middle = (b + 0.5) * bay;
      const double half = std::min(0.4 * bay, random.uniform(0.4, 1.1));
      if (storey == 0 && b == door) {
        add_wall_with_opening(builder, wall, panel, {middle - 0.5, middle + 0.5, 0.2, 2.3},
                              OpeningKind::door, house.wall);
      } else if (random.uniform() < 0.8) {
        add_wall_with_opening(builder, wall, panel,
                              {middle - half, middle + half, floor + 0.85, floor + 2.2},
                              shutters ? OpeningKind::shutters : OpeningKind::window, house.wall);
      } else {
        builder.quad(wall(panel.a0, 0, panel.z0), wall(panel.a1, 0, panel.z0),
                     wall(panel.a1, 0, panel.z1), wall(panel.a0, 0, panel.z1),
                     {label::kBuilding, house.wall});
      }
    }
  }
}

/// Roof with overhanging eaves, gables and a chimney; x along the front, y away from the road.
void add_house_roof(MeshBuilder& builder, const WorldHouse& house) {
  const Material stone = {label::kBuilding, house.wall};
  const Material tiles = {label::kBuilding, house.tiles};
  const double half = 0.5 * house.width;
  const double top = house.eaves();
  if (house.roof <= 0) {
    builder.box({-half - 0.2, -0.2, top - 0.1}, {half + 0.2, house.depth + 0.2, top + 0.25}, tiles);
    return;
  }
  // Computed as if the ridge were along x: u along it, v across.
  const double length_u = house.ridge_along ? house.width : house.depth;
  const double length_v = house.ridge_along ? house.depth : house.width;
  const auto at = [&](double u, double v, double z) {
    return house.ridge_along ? Vec3d{u - half, v, z} : Vec3d{v - half, u, z};
  };
  constexpr double kOver = 0.45;
  const double ridge = top + house.roof;
  const double low = top - kOver * house.roof / (0.5 * length_v);
  for (const double v : {-kOver, length_v + kOver})
    builder.quad(at(-kOver, v, low), at(length_u + kOver, v, low),
                 at(length_u + kOver, 0.5 * length_v, ridge), at(-kOver, 0.5 * length_v, ridge),
                 tiles);
  for (const double u : {0.0, length_u})
    builder.triangle(at(u, 0, top), at(u, length_v, top), at(u, 0.5 * length_v, ridge), stone);
  const Vec3d chimney = at(0.3 * length_u, 0.4 * length_v, ridge);
  builder.box(chimney - Vec3d{0.35, 0.3, 1.5}, chimney + Vec3d{0.35, 0.3, 0.8}, stone);
}

/// In the builder's frame: x along the front with 0 at its middle, y away from the road.
void add_house(MeshBuilder& builder, const WorldHouse& house, Random& random) {
  const double half = 0.5 * house.width;
  add_house_wall(builder, {{-half, 0, 0}, {1, 0, 0}, {0, -1, 0}}, house.width, house, true, random);
  add_house_wall(builder, {{-half, house.depth, 0}, {0, -1, 0}, {-1, 0, 0}}, house.depth, house,
                 false, random);
  add_house_wall(builder, {{half, 0, 0}, {0, 1, 0}, {1, 0, 0}}, house.depth, house, false, random);
  builder.quad({-half, house.depth, -kFooting}, {half, house.depth, -kFooting},
               {half, house.depth, house.eaves()}, {-half, house.depth, house.eaves()},
               {label::kBuilding, house.wall});
  add_house_roof(builder, house);
  if (random.uniform() < 0.4) {  // a porch
    const double x = random.uniform(-0.6, 0.6) * half;
    builder.box({x - 1.1, -1.3, 2.5}, {x + 1.1, 0, 2.65}, {label::kBuilding, house.tiles});
    for (const double post : {x - 1, x + 1})
      builder.beam({post, -1.2, -0.5}, {post, -1.2, 2.5}, 0.06, 0.06,
                   {label::kBuilding, house.wall});
  }
  if (random.uniform() < 0.3) {  // a bay window
    const double x = random.uniform(-0.5, 0.5) * half;
    builder.box({x - 1.2, -0.8, -kFooting}, {x + 1.2, 0, 2.9}, {label::kBuilding, house.wall});
    builder.quad({x - 1, -0.82, 1}, {x + 1, -0.82, 1}, {x + 1, -0.82, 2.3}, {x - 1, -0.82, 2.3},
                 {label::kBuilding, kDarkPane});
  }
}

void add_house_plot(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::house, plot.number);
  const double front = plan.property_line(plot.side) + plot.setback;
  const double left = plot.s0 + (plot.driveway ? 3.6 : 0.6);
  const double gap = random.uniform() < 0.25 ? 0 : random.uniform(0.5, 2.5);
  const double widest = plot.s1 - gap - left;
  if (widest < 4.5) return;
  WorldHouse house = draw_house(widest, random);
  if (gap == 0 && random.uniform() < 0.7) house.width = widest;
  const double middle = left + random.uniform(0.5, 1) * (widest - house.width) + 0.5 * house.width;
  builder.set_frame(plan.pose_at(middle, plot.side, front, random.normal() * 0.01));
  add_house(builder, house, random);
  if (plot.driveway && random.uniform() < 0.6) {
    const double back = front + random.uniform(1, 7);
    builder.set_frame(plan.pose_at(plot.s0 + 1.9, plot.side, back));
    const double z = random.uniform(2.3, 2.9);
    builder.box({-1.6, 0, -kFooting}, {1.6, 5.5, z}, {label::kBuilding, house.wall * 0.9F});
    builder.box({-1.7, -0.2, z}, {1.7, 5.7, z + 0.15}, {label::kBuilding, house.tiles});
  }
  if (random.uniform() < 0.3) {  // a shed at the back
    builder.set_frame(plan.pose_at(plot.s0 + random.uniform(2, plot.width() - 2), plot.side,
                                   front + house.depth + random.uniform(3, 9),
                                   random.uniform(-1, 1)));
    builder.box({-1.4, -1.1, -1}, {1.4, 1.1, 2.1},
                {random.uniform() < 0.6 ? label::kBuilding : label::kOtherStructure, 0.35F});
  }
  builder.reset_frame();
}

void add_facade_plot(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::house, plot.number);
  const double setback = random.uniform() < 0.3 ? random.uniform(0.3, 3) : 0.05;
  const double front = plan.property_line(plot.side) + setback;
  // Chords between the ends, so that rows along a curve join.
  constexpr double kChord_m = 15;
  const int rows = std::max(1, static_cast<int>(std::lround(plot.width() / kChord_m)));
  for (int k = 0; k < rows; ++k) {
    const double width = plot.width() / rows;
    const double from = plot.s0 + k * width;
    const Vec3d one = plan.ground_at(from, plot.side * front);
    const Vec3d other = plan.ground_at(from + width, plot.side * front);
    const Vec3d chord = {other.x - one.x, other.y - one.y, 0};
    const Vec3d along = normalized(chord);
    const Vec3d out = static_cast<double>(plot.side) * Vec3d{along.y, -along.x, 0};
    builder.set_frame({Mat3d{}, {one.x, one.y, std::min(one.z, other.z)}});
    add_facade_row(builder, {{0, 0, 0}, along, out}, length(chord), 0.1, random);
  }
  builder.reset_frame();
}

/// A barn, workshop or shop: large, with few openings.
void add_hall(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::house, plot.number);
  WorldHouse hall;
  hall.width = std::max(6.0, plot.width() * random.uniform(0.5, 0.95));
  hall.depth = random.uniform(8, 18);
  hall.storeys = random.uniform() < 0.5 ? 1 : 2;
  hall.roof = random.uniform() < 0.5 ? 0 : random.uniform(1, 3);
  hall.wall = static_cast<float>(random.uniform(0.3, 0.75));
  hall.tiles = static_cast<float>(random.uniform(0.2, 0.6));
  const double front = plan.property_line(plot.side) + random.uniform(5, 18);
  builder.set_frame(plan.pose_at(plot.center(), plot.side, front, 0.05 * random.normal()));
  const double half = 0.5 * hall.width;
  builder.box({-half, 0, -kFooting}, {half, hall.depth, hall.eaves()},
              {label::kBuilding, hall.wall});
  add_house_roof(builder, hall);
  for (double x = 1 - half; x < half - 4; x += random.uniform(5, 9))  // gates
    builder.box({x, -0.05, -0.2}, {x + 3, 0.05, 2.6}, {label::kBuilding, 0.25F});
  builder.reset_frame();
}

/// The houses of the next street, visible between those of this one.
void add_back_row(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::behind, plot.number);
  if (random.uniform() < 0.35) return;
  const double front = plan.property_line(plot.side) + plot.setback + random.uniform(24, 32);
  const WorldHouse house = draw_house(plot.width() - 2, random);
  if (front + house.depth > plan.reach(plot.side)) return;
  builder.set_frame(plan.pose_at(plot.center(), plot.side, front, 0.1 * random.normal()));
  add_house(builder, house, random);
  builder.reset_frame();
}

/// Houses or a row of facades along one side of a street that joins at s. `towards`: +1 if the
/// street is towards larger s.
void line_side_street(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot, double s,
                      int towards, double from) {
  Random random =
      random_of(plan, WorldPurpose::behind, 2 * plot.number + (towards > 0 ? 1 : 0) + 100'000);
  const double back = plan.property_line(plot.side) + from;
  const double reach = plan.reach(plot.side);
  if (reach - back < kMinRow_m) return;
  if (plot.use == Frontage::facades) {
    const Vec3d one = plan.ground_at(s, plot.side * back);
    const Vec3d along =
        normalized(plan.route.at(s, plot.side * (back + 1)) - plan.route.at(s, plot.side * back));
    const double turn = static_cast<double>(plot.side * towards);
    builder.set_frame({Mat3d{}, one});
    add_facade_row(builder, {{0, 0, 0}, along, turn * Vec3d{along.y, -along.x, 0}}, reach - back,
                   0.1, random);
  } else if (plot.use == Frontage::houses) {
    const double inward = random.uniform(2, 5);
    for (double d = back + 6; d < reach - 6; d += random.uniform(13, 20)) {
      // The front faces the street; y of its frame points away from it.
      const double yaw = (plot.side > 0) == (towards > 0) ? 0.5 : -0.5;
      builder.set_frame(plan.pose_at(s - towards * inward, plot.side, d, yaw * std::numbers::pi));
      add_house(builder, draw_house(11, random), random);
    }
  }
  builder.reset_frame();
}

void add_side_streets(const WorldPlan& plan, MeshBuilder& builder) {
  for (std::size_t k = 0; k + 1 < plan.plots.size(); ++k) {
    const WorldPlot& one = plan.plots[k];
    const WorldPlot& other = plan.plots[k + 1];
    if (one.side != other.side || other.s0 - one.s1 < 1) continue;
    line_side_street(plan, builder, one, one.s1, 1,
                     one.use == Frontage::facades ? kRowBehindFacades_m : kRowBehindHouses_m);
    line_side_street(plan, builder, other, other.s0, -1,
                     other.use == Frontage::facades ? kRowBehindFacades_m : kRowBehindHouses_m);
  }
}

}  // namespace

void add_corner_rows(const WorldPlan& plan, MeshBuilder& builder) {
  for (const int side : {1, -1}) {
    const auto of_side = [&](const WorldPlot& plot) { return plot.side == side; };
    const auto first = std::ranges::find_if(plan.plots, of_side);
    if (first == plan.plots.end()) continue;
    const auto last = std::find_if(plan.plots.rbegin(), plan.plots.rend(), of_side);
    const auto from = [](const WorldPlot& plot) {
      return plot.use == Frontage::facades ? kRowBehindFacades_m : kRowBehindHouses_m;
    };
    line_side_street(plan, builder, *first, first->s0, -1, from(*first));
    line_side_street(plan, builder, *last, last->s1, 1, from(*last));
  }
}

void add_world_buildings(const WorldPlan& plan, MeshBuilder& builder) {
  add_side_streets(plan, builder);
  for (const WorldPlot& plot : plan.plots) {
    if (plot.use == Frontage::houses && plan.side(plot.side).frontage == Frontage::houses)
      add_back_row(plan, builder, plot);
    if (plot.use == Frontage::hall) add_hall(plan, builder, plot);
    if (plot.use == Frontage::houses) add_house_plot(plan, builder, plot);
    if (plot.use == Frontage::facades) add_facade_plot(plan, builder, plot);
  }
}

}  // namespace adasplats
