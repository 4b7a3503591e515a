// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "adasplats/synth/city/city_grid.h"

namespace adasplats {
namespace {

constexpr double kZebra_m = 3.2, kStripe_m = 0.5;
constexpr double kZebraShare = 0.6, kLightsShare = 0.55;

/// The north street at one end of an east section, on one side of it.
CitySectionId crossing_street(const CitySectionId& id, int side, bool at_end) {
  return {CityAxis::north, at_end ? id.block + 1 : id.block, side > 0 ? id.line : id.line - 1};
}

/// Adds patches by their distance from the center of the crossing, at either end.
class CrossingPatches {
 public:
  CrossingPatches(std::vector<Patch>& patches, int side, bool at_end, double length_m)
      : patches_(patches), side_(side), at_end_(at_end), length_m_(length_m) {}

  void add(double s0, double s1, double d0, double d1, Ground ground, double step) {
    patches_.push_back({.side = side_,
                        .s0 = at_end_ ? length_m_ - s1 : s0,
                        .s1 = at_end_ ? length_m_ - s0 : s1,
                        .d0 = d0,
                        .d1 = d1,
                        .ground = ground,
                        .step = step,
                        .crosses_sidewalk = true,
                        .is_crossing = true});
  }

 private:
  std::vector<Patch>& patches_;
  int side_;
  bool at_end_;
  double length_m_;
};

}  // namespace

CityCrossing add_crossing(const CityGrid& grid, const CitySectionId& id, const WorldPlan& profile,
                          int side, bool at_end, std::vector<Patch>& patches) {
  const CitySectionId north_id = crossing_street(id, side, at_end);
  const WorldPlan north = grid.plan(north_id, true);
  const int towards = at_end ? 1 : -1;  // side of the north street on which this section is
  const double north_road = north.road_end(towards);
  const double north_edge = north.property_line(towards);
  const double road = profile.road_end(side);
  const double edge = profile.property_line(side);
  CrossingPatches add(patches, side, at_end, profile.options.length_m);
  double from = 0;
  for (const Strip& strip : north.strips_of(towards)) {
    if (strip.to > north_edge + 1e-9) break;
    add.add(from, strip.to, edge, kCityRow_m, strip.ground, strip.step);
    from = strip.to;
  }
  add.add(0, north_road, 0, edge, Ground::road, 0);
  add.add(north_road, north_edge, road, edge, Ground::sidewalk, profile.side(side).kerb);
  // Draws by arm, so that both sections and both sides of an arm agree on the markings.
  const int node = at_end ? id.block + 1 : id.block;
  const std::int64_t arm = 4 * static_cast<std::int64_t>(id.line) + (at_end ? 0 : 1);
  if (random_of(grid, CityPurpose::crossing, node, arm).uniform() < kZebraShare)
    for (double d = 0.25; d + kStripe_m < road; d += 2 * kStripe_m)
      add.add(north_edge, north_edge + kZebra_m, d, d + kStripe_m, Ground::marking, 0);
  const std::int64_t other_arm = 4 * static_cast<std::int64_t>(id.line) + (side > 0 ? 2 : 3);
  if (random_of(grid, CityPurpose::crossing, node, other_arm).uniform() < kZebraShare)
    for (double s = 0.25; s + kStripe_m < north_road; s += 2 * kStripe_m)
      add.add(s, s + kStripe_m, edge, edge + kZebra_m, Ground::marking, 0);
  return {north_edge};
}

void add_crossing_furniture(const CityGrid& grid, const CitySectionId& id, const WorldPlan& plan,
                            MeshBuilder& builder) {
  if (id.axis != CityAxis::east) return;
  constexpr Material kHead = {label::kOtherObject, 0.25F};
  for (const bool at_end : {false, true}) {
    const int node = at_end ? id.block + 1 : id.block;
    Random random = random_of(grid, CityPurpose::furniture, node, id.line);
    const bool lights = random.uniform() < kLightsShare;
    const bool over_road = random.uniform() < 0.4;
    const Material steel = {label::kPole, static_cast<float>(random.uniform(0.15, 0.5))};
    for (const int side : {1, -1}) {
      const WorldPlan north = grid.plan(crossing_street(id, side, at_end), true);
      const double off = north.property_line(at_end ? 1 : -1) - 0.4;
      const double s = at_end ? plan.options.length_m - off : off;
      builder.set_frame(plan.pose_at(s, side, plan.road_end(side) + 0.5));
      // Signs and lights on the right side of their road face oncoming drivers.
      const double tall = lights && over_road ? 5.8 : lights ? 3.4 : 2.6;
      builder.tube({0, 0, -0.4}, {0, 0, tall}, 0.07, 0.06, 10, steel);
      if (!lights) {
        add_sign(builder, {}, 0.07, tall - 0.4, {1, 0, 0}, SignShape::triangle);
        continue;
      }
      for (const double x : {0.1, -0.32})
        builder.box({x, -0.15, 2.3}, {x + 0.22, 0.15, 3.2}, kHead);
      if (!over_road) continue;
      builder.tube({0, 0, tall - 0.2}, {0, -3, tall}, 0.05, 0.04, 8, steel);
      builder.box({0.05, -3, tall - 0.9}, {0.27, -2.7, tall}, kHead);
    }
  }
  builder.reset_frame();
}

}  // namespace adasplats
