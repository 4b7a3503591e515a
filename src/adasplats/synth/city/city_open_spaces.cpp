// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/synth/city/city_grid.h"

namespace adasplats {
namespace {

constexpr double kPathHalf_m = 1.4;
constexpr double kParkTree_m2 = 110, kParkBush_m2 = 260;
constexpr double kSquareTrees_m = 9;  // spacing
constexpr double kSquareRim_m = 2.5;

Random open_random(const CityGrid& grid, const CitySectionId& id, int side, int purpose) {
  return random_of(grid, CityPurpose::furniture,
                   1000 + 4 * street_key(id.axis, id.line) + (side > 0 ? 1 : 0),
                   8 * static_cast<std::int64_t>(id.block) + purpose);
}

/// Furnishes one park or square of a section.
class OpenSpace {
 public:
  OpenSpace(const WorldPlan& plan, const WorldPlot& plot, std::uint16_t instance, Random random,
            MeshBuilder& builder)
      : plan_(plan), plot_(plot), instance_(instance), random_(random), builder_(builder) {}

  std::uint16_t next_instance() const { return instance_; }
  double line() const { return plan_.property_line(plot_.side); }
  double reach() const { return plan_.reach(plot_.side); }
  double area() const { return plot_.width() * (reach() - line()); }

  template <class Add>
  void scatter(double m2, Ground on, Add add) {
    for (int k = static_cast<int>(area() / m2 * random_.uniform(0.6, 1.4)); k > 0; --k) {
      const double s = random_.uniform(plot_.s0 + 1.5, plot_.s1 - 1.5);
      const double d = random_.uniform(line() + 1.5, reach() - 0.5);
      if (ground(s, d) == on) add(s, d);
    }
    builder_.reset_frame();
  }

  void tree(double s, double d) { plant_park_tree(plan_, builder_, s, plot_.side, d, random_); }
  void bush(double s, double d) {
    builder_.set_frame(plan_.pose_at(s, plot_.side, d));
    const double radius = random_.uniform(0.4, 1.2);
    add_leafy_bush(builder_, radius, radius * random_.uniform(0.8, 1.6), random_);
  }
  void bench(double s, double d, double yaw) {
    builder_.set_frame(plan_.pose_at(s, plot_.side, d, yaw));
    add_world_bench(builder_, {label::kOtherObject, 0.35F});
  }
  void lamp(double s, double d) {
    builder_.set_frame(plan_.pose_at(s, plot_.side, d));
    add_street_lamp(builder_, 3.8, 0, 0.05, {label::kPole, 0.3F});
  }
  void person(double s, double d) {
    add_vehicle(builder_, VehicleKind::walker,
                plan_.pose_at(s, plot_.side, d, random_.uniform(0, 2 * std::numbers::pi)),
                {label::kPerson, static_cast<float>(random_.uniform(0.1, 0.7)), instance_++},
                random_);
  }
  /// A market stall: posts, counter and roof.
  void stall(double s, double d) {
    const Material cloth = {label::kOtherStructure, static_cast<float>(random_.uniform(0.3, 0.8))};
    builder_.set_frame(
        plan_.pose_at(s, plot_.side, d, 0.5 * std::numbers::pi * random_.uniform(0, 4)));
    for (const double x : {-1.4, 1.4})
      for (const double y : {-1.0, 1.0})
        builder_.beam({x, y, -0.2}, {x, y, 2.2}, 0.03, 0.03, cloth);
    builder_.box({-1.4, -1, 0.8}, {1.4, -0.3, 0.9}, cloth);
    builder_.quad({-1.6, -1.3, 2.1}, {1.6, -1.3, 2.1}, {1.6, 1.2, 2.5}, {-1.6, 1.2, 2.5}, cloth);
  }
  /// A basin with a column in the center.
  void fountain(double s, double d) {
    const Material stone = {label::kOtherStructure, 0.6F};
    builder_.set_frame(plan_.pose_at(s, plot_.side, d));
    builder_.tube({0, 0, -0.3}, {0, 0, 0.55}, 2.6, 2.6, 24, stone);
    builder_.tube({0, 0, 0.5}, {0, 0, 2.2}, 0.35, 0.25, 14, stone);
    builder_.ellipsoid({0, 0, 2.4}, {0.5, 0.5, 0.45}, 8, 14, stone);
    builder_.reset_frame();
  }
  Ground ground(double s, double d) const { return plan_.cell_at(s, plot_.side * d).ground; }
  const WorldPlot& plot() const { return plot_; }
  Random& random() { return random_; }

 private:
  const WorldPlan& plan_;
  const WorldPlot& plot_;
  std::uint16_t instance_;
  Random random_;
  MeshBuilder& builder_;
};

void fill_park(OpenSpace& park) {
  park.scatter(kParkTree_m2, Ground::terrain, [&](double s, double d) { park.tree(s, d); });
  park.scatter(kParkBush_m2, Ground::terrain, [&](double s, double d) { park.bush(s, d); });
  const double path = park.line() + 5;
  for (double s = park.plot().s0 + 8; s < park.plot().s1 - 4; s += park.random().uniform(14, 26)) {
    park.bench(s, path + kPathHalf_m + 0.5, 0);
    park.lamp(s + 4, path - kPathHalf_m - 0.4);
  }
  park.scatter(60, Ground::other, [&](double s, double d) { park.person(s, d); });
}

void fill_square(OpenSpace& square) {
  const double first = square.line() + kSquareRim_m;
  for (double s = square.plot().s0 + kSquareRim_m; s < square.plot().s1 - 2; s += kSquareTrees_m)
    square.tree(s, first);
  for (double s = square.plot().s0 + 7; s < square.plot().s1 - 4;
       s += square.random().uniform(9, 20)) {
    square.bench(s, first + 1.6, std::numbers::pi);
    square.lamp(s + 3.5, first + 1.2);
  }
  const double middle = 0.5 * (first + square.reach());
  if (square.reach() - first > 14) square.fountain(square.plot().center(), middle);
  const auto is_free = [&](double s, double d) {
    const double to_fountain = std::hypot(s - square.plot().center(), d - middle);
    return d > first + 4 && to_fountain > 5;
  };
  if (square.random().uniform() < 0.5)
    square.scatter(160, Ground::sidewalk, [&](double s, double d) {
      if (is_free(s, d)) square.stall(s, d);
    });
  square.scatter(90, Ground::sidewalk, [&](double s, double d) {
    if (is_free(s, d)) square.person(s, d);
  });
}

}  // namespace

void add_open_ground(const CitySectionId& id, const WorldPlan& profile,
                     const std::vector<WorldPlot>& plots, std::vector<Patch>& patches) {
  for (const WorldPlot& plot : plots) {
    const double line = profile.property_line(plot.side);
    const double reach = profile.reach(plot.side);
    const auto add = [&](double s0, double s1, double d0, double d1, Ground ground) {
      patches.push_back({.side = plot.side,
                         .s0 = s0,
                         .s1 = s1,
                         .d0 = d0,
                         .d1 = d1,
                         .ground = ground,
                         .step = *profile.land_step});
    };
    if (plot.use == Frontage::square) add(plot.s0, plot.s1, line, reach, Ground::sidewalk);
    if (plot.use != Frontage::park) continue;
    const double path = line + 5;
    add(plot.s0 + 2, plot.s1 - 2, path - kPathHalf_m, path + kPathHalf_m, Ground::other);
    // Two paths through the middle of the block; every section that they cross draws the same ones.
    if (id.axis == CityAxis::east)
      add(plot.center() - kPathHalf_m, plot.center() + kPathHalf_m, line, reach, Ground::other);
    else
      add(plot.s0, plot.s1, reach - kPathHalf_m, reach, Ground::other);
  }
}

std::uint16_t add_open_spaces(const CityGrid& grid, const CitySectionId& id, const WorldPlan& plan,
                              std::uint16_t instance, MeshBuilder& builder) {
  for (const WorldPlot& plot : plan.plots) {
    if (plot.use != Frontage::park && plot.use != Frontage::square) continue;
    OpenSpace space(plan, plot, instance, open_random(grid, id, plot.side, 0), builder);
    if (plot.use == Frontage::park)
      fill_park(space);
    else
      fill_square(space);
    instance = space.next_instance();
  }
  return instance;
}

}  // namespace adasplats
