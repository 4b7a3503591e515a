// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kPlotStream = 1;
constexpr std::uint64_t kItemStream = 2;
constexpr std::uint64_t kParkingStream = 3;
constexpr double kSideStreetEvery = 130;
constexpr double kModule = 17.5;  // of sidewalk furniture

/// The first plots are fixed so that the shortest street has one of each kind.
PlotKind kind_of_plot(int side, std::size_t index, double since_side_street, Random& random) {
  constexpr std::array kLeft = {PlotKind::apartment, PlotKind::house, PlotKind::apartment,
                                PlotKind::wall};
  constexpr std::array kRight = {PlotKind::apartment, PlotKind::side_street, PlotKind::apartment,
                                 PlotKind::house};
  const double draw = random.uniform();
  if (index < 4) return side > 0 ? kLeft[index] : kRight[index];
  if (since_side_street > kSideStreetEvery) return PlotKind::side_street;
  if (draw < 0.58) return PlotKind::apartment;
  return draw < 0.9 ? PlotKind::house : PlotKind::wall;
}

double width_of_plot(PlotKind kind, Random& random) {
  switch (kind) {
    case PlotKind::apartment: return random.uniform(10.5, 16.0);
    case PlotKind::house: return random.uniform(11.0, 14.0);
    case PlotKind::wall: return random.uniform(7.0, 11.0);
    case PlotKind::side_street: break;
  }
  return 8.0;
}

void add_plots(StreetPlan& plan, int side) {
  const double squeeze = std::min(1.0, plan.length / 70);
  double x = 0;
  double last_side_street = side > 0 ? -0.4 * kSideStreetEvery : 0;
  for (std::size_t index = 0; x < plan.length; ++index) {
    Plot plot;
    plot.side = side;
    plot.number = plan.plots.size();
    Random random = plan.random(kPlotStream, plot.number);
    plot.kind = kind_of_plot(side, index, x - last_side_street, random);
    const bool side_street = plot.kind == PlotKind::side_street;
    plot.x0 = x;
    plot.x1 = x + width_of_plot(plot.kind, random) * (side_street ? 1.0 : squeeze);
    if (side_street && plan.length - plot.x1 < 9) plot.kind = PlotKind::apartment;
    if (side_street) last_side_street = x;
    if (plan.length - plot.x1 < 7) plot.x1 = plan.length;
    const double edge = random.uniform();
    plot.edge = edge < 0.6   ? GardenEdge::fence
                : edge < 0.8 ? GardenEdge::hedge
                             : GardenEdge::wall_with_fence;
    if (index < 4) plot.edge = side > 0 ? GardenEdge::fence : GardenEdge::hedge;
    x = plot.x1;
    plan.plots.push_back(plot);
  }
}

/// Whether the furniture line is free between x0 and x1.
bool is_free(const StreetPlan& plan, int side, double x0, double x1) {
  if (x0 < 1.5 || x1 > plan.length - 1.5) return false;
  if (x1 > plan.crossing - 2.2 && x0 < plan.crossing + 2.2) return false;
  return std::ranges::none_of(plan.plots, [&](const Plot& plot) {
    return plot.side == side && plot.kind == PlotKind::side_street && x1 > plot.x0 - 0.8 &&
           x0 < plot.x1 + 0.8;
  });
}

/// Half of the space that an item needs on the furniture line, besides its length.
double half_room(ItemKind kind) {
  switch (kind) {
    case ItemKind::bench: return 0.95;
    case ItemKind::advertising_column: return 0.9;
    case ItemKind::cabinet: return 0.6;
    case ItemKind::barrier: return 0.1;
    default: return 0.2;
  }
}

/// Adds an item unless the space is occupied.
void put_item(StreetPlan& plan, ItemKind kind, int side, double x, double length) {
  const double x0 = x - half_room(kind);
  const double x1 = x + length + half_room(kind);
  if (!is_free(plan, side, x0, x1)) return;
  const bool occupied = std::ranges::any_of(plan.items, [&](const Item& item) {
    return item.side == side && x1 > item.x - half_room(item.kind) &&
           x0 < item.x + item.length + half_room(item.kind);
  });
  if (!occupied) plan.items.push_back({kind, side, x, length, plan.items.size()});
}

/// One furniture module of a sidewalk: 17.5 m with two trees, one pole and, in every second one, a
/// lamp, a barrier or bollards.
void add_module(StreetPlan& plan, int side, double x, int module) {
  Random random =
      plan.random(kItemStream, static_cast<std::uint64_t>(module) * 2 + (side > 0 ? 1 : 0));
  const auto put = [&](ItemKind kind, double at, double length = 0.0) {
    put_item(plan, kind, side, at, length);
  };
  const bool even = ((module + (side > 0 ? 0 : 1)) % 2) == 0;
  put(ItemKind::tree, x + random.uniform(1.6, 2.4));
  if (module % 5 == 0 && side > 0) put(ItemKind::bus_shelter, x + 3.0, 3.2);
  put(even || random.uniform() < 0.3 ? ItemKind::sign_pole : ItemKind::pole,
      x + random.uniform(6.9, 7.3));
  if (even) put(ItemKind::lamp, x + random.uniform(7.8, 8.2));
  if (side > 0 || even) put(ItemKind::tree, x + random.uniform(11.1, 11.5));
  if (even || side > 0) {
    put(ItemKind::barrier, x + 12.3, 4.8);
  } else {
    for (int k = 0; k < 4; ++k) put(ItemKind::bollard, x + 12.6 + 1.4 * k);
  }
  if (!even) put(ItemKind::barrier, x + 3.0, 3.5);
  const double draw = random.uniform();
  put(draw < 0.4 ? ItemKind::bench : ItemKind::cabinet, x + random.uniform(9.3, 9.7));
  if (even) put(ItemKind::bin, x + 4.2);
  if (module % 4 == 1 && side > 0) put(ItemKind::advertising_column, x + 8.2);
}

void add_crossing_items(StreetPlan& plan) {
  for (const int side : {-1, 1}) {
    const auto put = [&](ItemKind kind, double x) {
      plan.items.push_back({kind, side, x, 0, plan.items.size()});
    };
    // Each driver sees one on the right, before the crossing.
    put(ItemKind::traffic_light, plan.crossing + (side > 0 ? 1.0 : -1.0) * 1.9);
    put(ItemKind::crossing_sign, plan.crossing - (side > 0 ? 1.0 : -1.0) * 1.9);
  }
}

void add_parked_cars(StreetPlan& plan, int side) {
  constexpr double kRoom = 5.4;  // length of one car with a gap
  Random random = plan.random(kParkingStream, side > 0 ? 1 : 0);
  for (double x = 7; x < plan.length - 7;) {
    const bool near_crossing = std::fabs(x - plan.crossing) < 5.5;
    const bool occupied = random.uniform() < 0.72;
    const Plot* plot = plan.plot_at(side, x);
    const auto opens = [&](double at) {
      const Plot* there = plan.plot_at(side, at);
      return there != nullptr && there->kind == PlotKind::side_street;
    };
    const bool before_side_street = plot == nullptr || opens(x) || opens(x - 3.5) || opens(x + 3.5);
    const bool before_driveway =
        plot != nullptr && plot->kind == PlotKind::house && std::fabs(x - plot->x0 - 2.0) < 3.4;
    if (occupied && !near_crossing && !before_side_street && !before_driveway)
      plan.items.push_back({ItemKind::parked_car, side, x, 4.3, plan.items.size()});
    x += kRoom + random.uniform(-0.2, 0.4);
  }
}

double position_of_crossing(const StreetPlan& plan) {
  // Near the middle, but clear of side streets.
  for (double x = 0.55 * plan.length; x < plan.length - 8; x += 1) {
    const bool blocked = std::ranges::any_of(plan.plots, [&](const Plot& plot) {
      return plot.kind == PlotKind::side_street && x > plot.x0 - 5 && x < plot.x1 + 5;
    });
    if (!blocked) return x;
  }
  return 0.5 * plan.length;
}

}  // namespace

const Plot* StreetPlan::plot_at(int side, double x) const {
  const auto found = std::ranges::find_if(
      plots, [&](const Plot& plot) { return plot.side == side && x >= plot.x0 && x <= plot.x1; });
  return found == plots.end() ? nullptr : &*found;
}

double road_height(double x, double y) {
  const double along = 0.05 * std::sin(2 * std::numbers::pi * x / 61.0) +
                       0.03 * std::sin(2 * std::numbers::pi * x / 137.0);
  const double from_axis = std::fabs(y);
  const double across = 0.02 * (std::min(std::max(from_axis - kRoadHalfWidth, 0.0), 4.0) -
                                std::min(from_axis, kRoadHalfWidth));
  return along + across;
}

StreetPlan make_street_plan(const StreetOptions& options) {
  if (!(options.length_m >= kMinStreetLength_m && options.length_m <= kMaxStreetLength_m))
    throw Error(ErrorKind::usage, "street length of " + std::to_string(options.length_m) +
                                      " m; expected " + std::to_string(kMinStreetLength_m) +
                                      " to " + std::to_string(kMaxStreetLength_m) + " m");
  StreetPlan plan;
  plan.seed = options.seed;
  plan.length = options.length_m;
  add_plots(plan, 1);
  add_plots(plan, -1);
  plan.crossing = position_of_crossing(plan);
  for (const int side : {1, -1}) {
    int module = 0;
    for (double x = side > 0 ? 0 : 4; x < plan.length; x += kModule, ++module)
      add_module(plan, side, x, module);
  }
  add_crossing_items(plan);
  for (const int side : {1, -1}) add_parked_cars(plan, side);
  return plan;
}

}  // namespace adasplats
