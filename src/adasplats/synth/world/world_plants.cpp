// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

Vec3d draw_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double azimuth = random.uniform(0, kFullTurn);
  const double level = std::sqrt(1 - z * z);
  return {level * std::cos(azimuth), level * std::sin(azimuth), z};
}

enum class Crown : std::uint8_t { round, cone, column };

struct WorldTree {
  Crown crown = Crown::round;
  double height = 8, crown_base = 2, crown_radius = 2, trunk_radius = 0.15;
  int leaves = 2500;
  double leaf = 0.25;
  double lean = 0;
};

WorldTree draw_tree(double leafiness, double tallest, Random& random) {
  WorldTree tree;
  const double kind = random.uniform();
  tree.crown = kind < 0.7 ? Crown::round : kind < 0.88 ? Crown::cone : Crown::column;
  tree.height = random.uniform(3, tallest);
  tree.trunk_radius = tree.height * random.uniform(0.011, 0.022);
  tree.lean = 0.05 * random.normal();
  switch (tree.crown) {
    case Crown::round:
      tree.crown_base = random.uniform(0.15, 0.4) * tree.height;
      tree.crown_radius = random.uniform(0.22, 0.42) * tree.height;
      break;
    case Crown::cone:
      tree.crown_base = random.uniform(0.02, 0.15) * tree.height;
      tree.crown_radius = random.uniform(0.17, 0.3) * tree.height;
      break;
    case Crown::column:
      tree.crown_base = random.uniform(0.05, 0.2) * tree.height;
      tree.crown_radius = random.uniform(0.08, 0.16) * tree.height;
      break;
  }
  tree.leaf = random.uniform(0.14, 0.3);
  const double skin = tree.crown_radius * (tree.height - tree.crown_base) * kFullTurn;
  const double leaves =
      leafiness * random.uniform(0.5, 1.2) * skin / (0.25 * tree.leaf * tree.leaf);
  tree.leaves = static_cast<int>(std::clamp(leaves, 400.0, 4500.0));
  tree.leaf = std::max(tree.leaf, std::sqrt(leafiness * skin / (0.35 * tree.leaves)));
  return tree;
}

/// More and smaller leaves for plants near the road.
WorldTree with_fine_leaves(WorldTree tree) {
  tree.leaves *= 2;
  tree.leaf /= std::numbers::sqrt2;
  return tree;
}

/// Relative width of the crown at a share of its height, 0..1.
double crown_width(Crown crown, double share) {
  switch (crown) {
    case Crown::round: return std::sqrt(std::max(0.0, 1 - std::pow(2 * share - 0.85, 2) / 1.33));
    case Crown::cone: return 1 - 0.97 * share;
    case Crown::column: return std::sqrt(std::max(0.0, std::sin(std::numbers::pi * share)));
  }
  return 0;
}

/// In the builder's frame, with its foot at the origin.
void add_world_tree(MeshBuilder& builder, const WorldTree& tree, Random& random) {
  const Material bark = {label::kTrunk, static_cast<float>(random.uniform(0.3, 0.55))};
  const Material branch = {label::kVegetation, bark.reflectance};
  const double azimuth = random.uniform(0, kFullTurn);
  const auto stem = [&](double z) {
    return Vec3d{tree.lean * z * std::cos(azimuth), tree.lean * z * std::sin(azimuth), z};
  };
  const double fork = std::max(tree.crown_base, 0.15 * tree.height);
  add_limb(builder, {stem(-0.4), stem(0.1), stem(0.5 * fork), stem(fork)}, 1.3 * tree.trunk_radius,
           0.9 * tree.trunk_radius, 9, bark);
  add_limb(builder, {stem(fork), stem(0.9 * tree.height)}, 0.9 * tree.trunk_radius, 0.03, 6, bark);
  const double crown_height = tree.height - tree.crown_base;
  // Leaves surround clumps, so that a crown has holes and bulges.
  const int clumps = 12 + static_cast<int>(random.uniform(0, 24));
  const int each = std::max(1, tree.leaves / clumps);
  for (int k = 0; k < clumps; ++k) {
    const double share = (k + random.uniform()) / clumps;
    const double angle = 2.4 * k + random.uniform(-0.5, 0.5);  // the golden angle
    const double reach =
        tree.crown_radius * crown_width(tree.crown, share) * std::sqrt(random.uniform(0.15, 1));
    const Vec3d center = stem(tree.crown_base + share * crown_height) +
                         Vec3d{reach * std::cos(angle), reach * std::sin(angle), 0};
    const double below = std::max(0.3 * tree.crown_base, center.z - 0.6 * reach - 0.2);
    if (tree.crown == Crown::round)
      builder.tube(stem(below), center, 0.35 * tree.trunk_radius, 0.012, 4, branch);
    const double spread = 0.2 * tree.crown_radius + 0.12;
    for (int n = 0; n < each; ++n) {
      const Vec3d leaf =
          center + spread * Vec3d{random.normal(), random.normal(), 0.8 * random.normal()};
      if (leaf.z < 0.5 * tree.crown_base) continue;
      add_leaf(builder, leaf, tree.leaf * random.uniform(0.7, 1.3), random);
    }
  }
}

void plant(const WorldPlan& plan, MeshBuilder& builder, double s, int side, double from_axis,
           const WorldTree& tree, Random& random) {
  builder.set_frame(plan.pose_at(s, side, from_axis, random.uniform(0, kFullTurn)));
  add_world_tree(builder, tree, random);
}

void plant_bush(const WorldPlan& plan, MeshBuilder& builder, double s, int side, double from_axis,
                Random& random) {
  const double radius = random.uniform(0.3, 1.1) * random.uniform(0.8, 1.6);
  builder.set_frame(plan.pose_at(s, side, from_axis, random.uniform(0, kFullTurn)),
                    {random.uniform(0.7, 1.4), 1, 1});
  add_leafy_bush(builder, radius, radius * random.uniform(0.8, 2), random);
}

void plant_garden(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::garden, plot.number);
  const double line = plan.property_line(plot.side);
  const auto draw_place = [&](double& s, double& d) {
    s = random.uniform(plot.s0 + 1, plot.s1 - 1);
    // In front of the house, behind it, or next to the driveway.
    const bool before = plot.setback > 2.5 && random.uniform() < 0.7;
    d = line + (before ? random.uniform(0.9, plot.setback - 0.8)
                       : random.uniform(plot.setback + 12, plot.setback + 24));
    return !before || !plan.is_open(plot.side, s - 0.8, s + 0.8);
  };
  const auto count = [&](double mean) { return static_cast<int>(mean * random.uniform(0, 2)); };
  double s = 0;
  double d = 0;
  for (int k = count(plan.style.garden_trees + 0.5); k > 0; --k) {
    if (!draw_place(s, d)) continue;
    plant(plan, builder, s, plot.side, d,
          draw_tree(plan.style.leafiness, random.uniform(4, 12), random), random);
  }
  for (int k = count(plan.style.garden_bushes); k > 0; --k)
    if (draw_place(s, d)) plant_bush(plan, builder, s, plot.side, d, random);
}

/// Bushes at the edge of a plot.
void plant_edge(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::edges_plants, plot.number);
  const double line = plan.property_line(plot.side);
  const int count =
      static_cast<int>(plan.style.edge_bushes * plot.width() * random.uniform(0, 1.6));
  for (int k = 0; k < count; ++k) {
    const bool front = random.uniform() < 0.6 && plot.setback > 1.5;
    const double s = front ? random.uniform(plot.s0, plot.s1) : plot.s1 - random.uniform(0.2, 0.9);
    if (front && plan.is_open(plot.side, s - 0.7, s + 0.7)) continue;
    plant_bush(plan, builder, s, plot.side,
               line + (front ? random.uniform(0.7, 1.4) : random.uniform(0.7, plot.setback + 12)),
               random);
  }
}

/// Tufts of tall grass between the road and the land.
void plant_grass(const WorldPlan& plan, MeshBuilder& builder, int side) {
  Random random = random_of(plan, WorldPurpose::grass, side > 0 ? 1 : 0);
  const double line = plan.road_end(side) + 0.5;
  const double reach = random.uniform(1, 9);
  for (const double s : positions_along(plan, plan.side(side).grass, 0, random)) {
    const double out = line + reach * random.uniform();
    if (plan.cell_at(s, side * out).ground != Ground::terrain) continue;
    builder.set_frame(plan.pose_at(s, side, out));
    const double height = random.uniform(0.25, 0.8);
    for (int blade = 0; blade < 30; ++blade) {
      const Vec3d foot = {0.3 * random.normal(), 0.3 * random.normal(), -0.05};
      const Vec3d tip = foot + height * Vec3d{0.3 * random.normal(), 0.3 * random.normal(),
                                              random.uniform(0.6, 1.1)};
      const double azimuth = random.uniform(0, kFullTurn);
      const Vec3d wide = 0.02 * Vec3d{std::cos(azimuth), std::sin(azimuth), 0};
      builder.triangle(foot - wide, foot + wide, tip,
                       {label::kVegetation, static_cast<float>(random.uniform(0.35, 0.6))});
    }
  }
}

/// A tree on each island of the parking lane, with low plants around it.
void plant_islands(const WorldPlan& plan, MeshBuilder& builder) {
  Random random = random_of(plan, WorldPurpose::islands, 0);
  const double low = random.uniform() < 0.6 ? random.uniform(0.25, 0.8) : 0;
  for (const Patch& patch : plan.patches) {
    if (!patch.is_island) continue;
    const double s = 0.5 * (patch.s0 + patch.s1);
    const double d = 0.5 * (patch.d0 + patch.d1);
    if (random.uniform() < 0.8) {
      WorldTree tree = draw_tree(plan.style.leafiness, random.uniform(5, 11), random);
      tree.crown = Crown::round;
      tree.crown_base = std::max(tree.crown_base, 1.9);
      tree.height = std::max(tree.height, 4.5);
      plant(plan, builder, s, patch.side, d, with_fine_leaves(tree), random);
    }
    builder.reset_frame();
    if (low > 0)
      add_leafy_hedge(builder, plan.ground_at(patch.s0 + 0.15, patch.side * d),
                      plan.ground_at(patch.s1 - 0.15, patch.side * d),
                      low * random.uniform(0.8, 1.2), patch.d1 - patch.d0 - 0.3, random);
  }
}

void plant_wood(const WorldPlan& plan, MeshBuilder& builder, const WorldPlot& plot) {
  Random random = random_of(plan, WorldPurpose::garden, plot.number);
  const double line = plan.property_line(plot.side) + random.uniform(0.8, 6);
  const double deep = std::min(plan.reach(plot.side) - 3, line + random.uniform(6, 26));
  const double room = random.uniform(10, 30);  // m2 per tree
  const int trees = static_cast<int>(plot.width() * (deep - line) / room);
  for (int k = 0; k < trees; ++k) {
    WorldTree tree = draw_tree(plan.style.leafiness, random.uniform(6, 16), random);
    tree.leaves = tree.leaves / 4;
    tree.leaf *= 1.6;
    plant(plan, builder, random.uniform(plot.s0, plot.s1), plot.side, random.uniform(line, deep),
          tree, random);
  }
  for (int k = static_cast<int>(plot.width() * random.uniform(0.1, 0.7)); k > 0; --k)
    plant_bush(plan, builder, random.uniform(plot.s0, plot.s1), plot.side,
               line + 5 * random.uniform() * random.uniform(), random);
}

/// Trees between the road and the plots, or just behind; bushes of the open land.
void plant_side(const WorldPlan& plan, MeshBuilder& builder, int side) {
  Random random = random_of(plan, WorldPurpose::trees, side > 0 ? 1 : 0);
  const SideStyle& own = plan.side(side);
  const bool at_kerb = own.sidewalk + own.verge > 1.8;
  const double line = at_kerb ? plan.road_end(side) + 0.9 : plan.property_line(side) + 1.6;
  const double tallest = random.uniform(5, 14);
  for (const double s : positions_along(plan, own.trees, 3, random)) {
    if (plan.is_open(side, s - 1, s + 1)) continue;
    WorldTree tree = draw_tree(plan.style.leafiness, tallest, random);
    if (at_kerb) {  // trees over a road are pruned
      tree.crown = Crown::round;
      tree.height = std::max(tree.height, 5.0);
      tree.crown_base = std::max(tree.crown_base, 2.1);
    }
    plant(plan, builder, s, side, line + 0.15 * random.normal(), with_fine_leaves(tree), random);
  }
  if (own.frontage != Frontage::open) return;
  for (const double s : positions_along(plan, own.bushes, 0.5, random)) {
    if (plan.is_crossing(side, s)) continue;
    plant_bush(plan, builder, s, side,
               plan.property_line(side) + 1 + 14 * random.uniform() * random.uniform(), random);
  }
}

}  // namespace

void plant_park_tree(const WorldPlan& plan, MeshBuilder& builder, double s, int side,
                     double from_axis, Random& random) {
  WorldTree tree = draw_tree(plan.style.leafiness, random.uniform(7, 15), random);
  tree.crown = Crown::round;
  tree.crown_base = std::max(tree.crown_base, 2.0);
  tree.height = std::max(tree.height, 5.0);
  tree.leaves /= 2;
  tree.leaf *= std::numbers::sqrt2;
  plant(plan, builder, s, side, from_axis, tree, random);
  builder.reset_frame();
}

std::vector<double> positions_along(const WorldPlan& plan, double in_100_m, double room,
                                    Random& random) {
  std::vector<double> positions;
  if (in_100_m <= 0) return positions;
  const double mean = 100 / in_100_m;
  for (double s = mean * random.uniform(); s < plan.options.length_m - 0.5;
       s += std::max(room, mean * random.uniform(0.4, 1.6)))
    positions.push_back(s);
  return positions;
}

void add_leafy_hedge(MeshBuilder& builder, Vec3d from, Vec3d to, double height, double thickness,
                     Random& random) {
  const Vec3d along = to - from;
  const double length_m = length(along);
  const Vec3d across = normalized(Vec3d{-along.y, along.x, 0}) * (0.5 * thickness);
  builder.box(0.5 * (from + to) + Vec3d{0, 0, 0.5 * height - 0.08}, 0.5 * along, 0.6 * across,
              {0, 0, 0.5 * height - 0.06}, {label::kVegetation, 0.3F});
  const int leaves = static_cast<int>(90 * length_m * (2 * height + thickness));
  for (int k = 0; k < leaves; ++k) {
    const double share = random.uniform();
    const double inward = std::fabs(0.12 * random.normal());
    double up = random.uniform();
    double out = random.uniform() < 0.5 ? 1 - inward : inward - 1;
    if (random.uniform() < thickness / (2 * height + thickness)) {
      up = 1 + 0.04 * random.normal();
      out = random.uniform(-1, 1);
    }
    add_leaf(builder, from + share * along + out * across + Vec3d{0, 0, up * height},
             random.uniform(0.08, 0.17), random);
  }
}

void add_leafy_bush(MeshBuilder& builder, double radius, double height, Random& random) {
  const Vec3d middle = {0, 0, 0.5 * height};
  builder.ellipsoid(middle, {0.55 * radius, 0.55 * radius, 0.35 * height}, 5, 8,
                    {label::kVegetation, 0.3F});
  const int leaves = static_cast<int>(std::clamp(190 * radius * (radius + height), 40.0, 1200.0));
  for (int k = 0; k < leaves; ++k) {
    const Vec3d direction = draw_direction(random);
    const double reach = std::cbrt(random.uniform(0.25, 1.15));
    const Vec3d leaf = middle + reach * Vec3d{radius * direction.x, radius * direction.y,
                                              0.5 * height * direction.z};
    if (leaf.z > 0) add_leaf(builder, leaf, random.uniform(0.09, 0.2), random);
  }
}

void add_world_plants(const WorldPlan& plan, MeshBuilder& builder) {
  for (const WorldPlot& plot : plan.plots) {
    if (plot.use == Frontage::houses) {
      plant_garden(plan, builder, plot);
      plant_edge(plan, builder, plot);
    }
    const bool park = plot.use == Frontage::open && plan.side(plot.side).frontage != Frontage::open;
    if (plot.use == Frontage::wood || park) plant_wood(plan, builder, plot);
  }
  for (const int side : {1, -1}) {
    plant_side(plan, builder, side);
    plant_grass(plan, builder, side);
  }
  plant_islands(plan, builder);
  builder.reset_frame();
}

}  // namespace adasplats
