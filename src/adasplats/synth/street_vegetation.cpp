// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "adasplats/synth/street_parts.h"

namespace adasplats {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr Material kBark = {label::kTrunk, 0.28F};
constexpr Material kTwig = {label::kVegetation, 0.26F};

Vec3d random_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double azimuth = random.uniform(0, kTwoPi);
  const double level = std::sqrt(1 - z * z);
  return {level * std::cos(azimuth), level * std::sin(azimuth), z};
}

}  // namespace

void add_leaf(MeshBuilder& builder, Vec3d center, double length_m, Random& random) {
  const Vec3d along = random_direction(random);
  const Vec3d other = random_direction(random);
  const Vec3d across = cross(along, other);
  const double size = length(across);
  if (size < 0.05) return;
  const Vec3d half_across = across * (0.3 * length_m / size);
  const Vec3d lift = cross(along, half_across) * 0.35;
  const Vec3d tip = center + along * (0.5 * length_m);
  const Vec3d stalk = center - along * (0.5 * length_m);
  const Material leaf = {label::kVegetation, static_cast<float>(random.uniform(0.38, 0.6))};
  builder.triangle(stalk, center + half_across + lift, tip, leaf);
  builder.triangle(stalk, tip, center - half_across + lift, leaf);
}

void add_limb(MeshBuilder& builder, const std::vector<Vec3d>& points, double radius_from,
              double radius_to, int sides, const Material& material) {
  const auto pieces = static_cast<double>(points.size() - 1);
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const double a = static_cast<double>(k) / pieces;
    const double b = static_cast<double>(k + 1) / pieces;
    builder.tube(points[k], points[k + 1], radius_from + a * (radius_to - radius_from),
                 radius_from + b * (radius_to - radius_from), sides, material);
  }
}

namespace {

struct TreeShape {
  double height = 8;
  double crown_base = 2.6;
  double crown_radius = 2.0;
  double trunk_radius = 0.14;
  int branches = 9;
  int leaves = 2400;
};

/// Ends of the branches, around which leaves grow.
std::vector<Vec3d> add_wood(MeshBuilder& builder, Vec3d foot, const TreeShape& tree,
                            Random& random) {
  const Vec3d lean = {random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), 0};
  const auto on_trunk = [&](double z) {
    const double share = z / tree.height;
    return foot + Vec3d{0, 0, z} + lean * (share * share * 2);
  };
  const double top = 0.85 * tree.height;
  std::vector<Vec3d> trunk = {foot - Vec3d{0, 0, 0.1}};
  for (const double share : {0.05, 0.5, 1.0}) trunk.push_back(on_trunk(share * tree.crown_base));
  add_limb(builder, trunk, tree.trunk_radius * 1.15, tree.trunk_radius * 0.85, 12, kBark);
  add_limb(builder,
           {on_trunk(tree.crown_base), on_trunk(0.5 * (tree.crown_base + top)), on_trunk(top)},
           tree.trunk_radius * 0.85, 0.03, 8, kTwig);

  std::vector<Vec3d> tips = {on_trunk(top)};
  for (int k = 0; k < tree.branches; ++k) {
    const double share = (k + random.uniform(0, 0.8)) / tree.branches;
    const Vec3d from = on_trunk(tree.crown_base + share * 0.85 * (top - tree.crown_base));
    const double azimuth = 2.4 * k + random.uniform(-0.4, 0.4);  // the golden angle
    const double reach = tree.crown_radius * (1.0 - 0.55 * share) * random.uniform(0.7, 1.0);
    const Vec3d out = {std::cos(azimuth), std::sin(azimuth), 0};
    const Vec3d knee = from + out * (0.5 * reach) + Vec3d{0, 0, 0.25 * reach};
    const Vec3d tip = from + out * reach + Vec3d{0, 0, 0.75 * reach};
    add_limb(builder, {from, knee, tip}, 0.05, 0.012, 6, kTwig);
    tips.insert(tips.end(), {knee, tip, 0.5 * (knee + tip)});
    for (int side = -1; side <= 1; side += 2) {
      const Vec3d across = {-out.y, out.x, 0};
      const Vec3d twig = knee + out * (0.3 * reach) + across * (side * 0.4 * reach) +
                         Vec3d{0, 0, random.uniform(0.1, 0.4) * reach};
      builder.tube(knee, twig, 0.02, 0.008, 5, kTwig);
      tips.push_back(twig);
    }
  }
  return tips;
}

void add_tree(MeshBuilder& builder, Vec3d foot, const TreeShape& tree, Random& random) {
  const std::vector<Vec3d> tips = add_wood(builder, foot, tree, random);
  for (int k = 0; k < tree.leaves; ++k) {
    const auto tip = static_cast<std::size_t>(random.uniform() * static_cast<double>(tips.size()));
    const double spread = 0.24 * tree.crown_radius;
    const Vec3d off = {spread * random.normal(), spread * random.normal(),
                       0.8 * spread * random.normal()};
    const Vec3d center = tips[tip] + off;
    if (center.z < foot.z + 0.75 * tree.crown_base) continue;
    add_leaf(builder, center, random.uniform(0.09, 0.18), random);
  }
}

/// Leaves in a box, denser near its surface, as in a cut hedge.
void add_hedge(MeshBuilder& builder, Vec3d low, Vec3d high, Random& random) {
  const Vec3d size = high - low;
  const double skin = 2 * (size.x * size.z + size.y * size.z) + size.x * size.y;
  const int leaves = static_cast<int>(520 * skin);
  for (int k = 0; k < leaves; ++k) {
    Vec3d p = {random.uniform(), random.uniform(), random.uniform()};
    const int axis = random.uniform() < size.y / (size.x + size.y) ? 0 : 1;
    const double depth = std::min(0.5, std::fabs(0.1 * random.normal()) / size[axis]);
    const double draw = random.uniform();
    if (draw < 0.3) {
      p.z = 1 - std::fabs(0.06 * random.normal());
    } else {
      p[axis] = draw < 0.65 ? depth : 1 - depth;
    }
    add_leaf(builder, low + Vec3d{p.x * size.x, p.y * size.y, p.z * size.z},
             random.uniform(0.06, 0.1), random);
  }
  for (double x = low.x + 0.2; x < high.x; x += 0.35) {  // stems
    const Vec3d foot = {x, 0.5 * (low.y + high.y), low.z - 0.1};
    builder.tube(foot, {x + random.uniform(-0.1, 0.1), foot.y, high.z - 0.2}, 0.02, 0.01, 5, kTwig);
  }
}

void add_bush(MeshBuilder& builder, Vec3d foot, double radius, Random& random) {
  const int leaves = static_cast<int>(900 * radius * radius);
  for (int k = 0; k < leaves; ++k) {
    const Vec3d direction = random_direction(random);
    const double reach = radius * std::cbrt(random.uniform(0.2, 1.0));
    const Vec3d center = foot + Vec3d{0, 0, 0.75 * radius} + reach * direction;
    if (center.z > foot.z) add_leaf(builder, center, random.uniform(0.06, 0.1), random);
  }
  for (int k = 0; k < 5; ++k) {
    const Vec3d direction = random_direction(random);
    builder.tube(foot - Vec3d{0, 0, 0.1},
                 foot + radius * Vec3d{0.6 * direction.x, 0.6 * direction.y, 0.9}, 0.018, 0.008, 5,
                 kTwig);
  }
}

/// Plants of a house's plot: front hedge if it has one, bushes, a small tree.
void add_garden_plants(const StreetPlan& plan, MeshBuilder& builder, const Plot& plot) {
  Random random = random_of(plan, Purpose::hedge, plot.number);
  if (plot.edge == GardenEdge::hedge) {
    const double y0 = plot.side * (kSidewalkEdge + 0.08);
    const double y1 = plot.side * (kSidewalkEdge + 0.75);
    const double z = sidewalk_height(plot.center(), y0);
    const double gap0 = plot.center() - 0.75;
    const double gap1 = plot.center() + 0.75;
    const auto piece = [&](double x0, double x1) {
      add_hedge(builder, {x0, std::min(y0, y1), z}, {x1, std::max(y0, y1), z + 1.45}, random);
    };
    piece(plot.x0 + 3.6, gap0);
    piece(gap1, plot.x1 - 0.15);
  }
  const auto ground = [&](double x, double from_axis) {
    const double y = plot.side * from_axis;
    return Vec3d{x, y, sidewalk_height(x, y)};
  };
  for (int k = 0; k < 3; ++k) {
    const double x = random.uniform(plot.center() + 1.3, plot.x1 - 0.8);
    add_bush(builder, ground(x, kSidewalkEdge + random.uniform(1.5, 3.7)),
             random.uniform(0.35, 0.6), random);
  }
  const TreeShape small = {.height = 4.5,
                           .crown_base = 1.3,
                           .crown_radius = 1.2,
                           .trunk_radius = 0.07,
                           .branches = 7,
                           .leaves = 2200};
  add_tree(builder, ground(plot.x0 + 4.6, kSidewalkEdge + 2.2), small, random);
}

TreeShape draw_street_tree(Random& random) {
  TreeShape tree;
  tree.height = random.uniform(6.5, 9.0);
  tree.crown_base = random.uniform(2.3, 2.9);
  tree.crown_radius = random.uniform(1.6, 2.2);
  tree.trunk_radius = random.uniform(0.1, 0.17);
  tree.branches = 8 + static_cast<int>(random.uniform(0, 4));
  tree.leaves = 3000 + static_cast<int>(random.uniform(0, 1500));
  return tree;
}

}  // namespace

void add_vegetation(const StreetPlan& plan, MeshBuilder& builder) {
  for (const Item& item : plan.items) {
    if (item.kind != ItemKind::tree) continue;
    Random random = random_of(plan, Purpose::tree, item.number);
    const double y = item.side * kTreeLine;
    add_tree(builder, {item.x, y, sidewalk_height(item.x, y)}, draw_street_tree(random), random);
  }
  for (const Plot& plot : plan.plots) {
    if (plot.kind == PlotKind::house) add_garden_plants(plan, builder, plot);
    if (plot.kind != PlotKind::wall) continue;
    Random random = random_of(plan, Purpose::bush, plot.number);
    for (const double x : {plot.x0 + 2.0, plot.x1 - 2.0}) {  // trees behind the wall
      const double y = plot.side * (kSidewalkEdge + random.uniform(3.0, 5.0));
      add_tree(builder, {x, y, sidewalk_height(x, y)}, draw_street_tree(random), random);
    }
  }
}

}  // namespace adasplats
