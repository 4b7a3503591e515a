// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "adasplats/synth/street_parts.h"

// The ground is a grid of rectangles with cuts at the features of the plan. Each cell has a class
// and a height above the road's surface; a vertical face closes the step between neighbours of
// different heights. Kerbs, driveways, tree pits and side streets need no special cases.

namespace adasplats {
namespace {

constexpr double kMinCell_m = 0.06;
constexpr double kTerrainRoughness = 0.035;

struct Cell {
  std::uint16_t class_id = 0;
  float reflectance = 0.2F;
  double step = 0;
  bool rough = false;  ///< soil, not paving
};

constexpr Cell kAsphalt = {label::kRoad, 0.16F, 0, false};
constexpr Cell kMarking = {label::kRoad, 0.75F, 0, false};
constexpr Cell kKerbStone = {label::kSidewalk, 0.42F, kKerbHeight, false};
constexpr Cell kPaving = {label::kSidewalk, 0.30F, kKerbHeight, false};
constexpr Cell kDriveway = {label::kOtherGround, 0.26F, 0.03, false};
constexpr Cell kGardenPath = {label::kOtherGround, 0.38F, kKerbHeight, false};
constexpr Cell kSoil = {label::kTerrain, 0.34F, kKerbHeight - 0.02, true};

bool is_driveway(const Plot& plot, double x) {
  return plot.kind == PlotKind::house && x > plot.x0 + 0.6 && x < plot.x0 + 3.4;
}

bool is_tree_pit(const StreetPlan& plan, int side, double x, double from_axis) {
  if (std::fabs(from_axis - kTreeLine) > 0.6) return false;
  return std::ranges::any_of(plan.items, [&](const Item& item) {
    return item.kind == ItemKind::tree && item.side == side && std::fabs(item.x - x) < 0.6;
  });
}

Cell road_cell(const StreetPlan& plan, double x, double y) {
  const double from_crossing = std::fabs(x - plan.crossing);
  if (from_crossing < kZebraHalfLength && std::fabs(y) < kRoadHalfWidth - 0.5)
    return std::fmod(y + 100.25, 1.0) < 0.5 ? kMarking : kAsphalt;
  const bool dashed = std::fmod(x, 5.0) < 3.0;
  if (std::fabs(y) < 0.07 && dashed && from_crossing > 3) return kMarking;
  return kAsphalt;
}

Cell sidewalk_cell(const StreetPlan& plan, const Plot& plot, double x, double from_axis) {
  const bool kerb = from_axis < kRoadHalfWidth + kKerbWidth;
  if (is_driveway(plot, x)) return kDriveway;
  if (std::fabs(x - plan.crossing) < kZebraHalfLength && kerb) {
    Cell lowered = kKerbStone;
    lowered.step = 0.04;
    return lowered;
  }
  if (kerb) return kKerbStone;
  return is_tree_pit(plan, plot.side, x, from_axis) ? kSoil : kPaving;
}

std::optional<Cell> plot_cell(const Plot& plot, double x, double from_axis) {
  switch (plot.kind) {
    case PlotKind::apartment:
      return from_axis < kSidewalkEdge + 0.6 ? std::optional(kPaving) : std::nullopt;
    case PlotKind::wall:
      return from_axis < kSidewalkEdge + kBuildingDepth ? std::optional(kSoil) : std::nullopt;
    case PlotKind::house:
      if (is_driveway(plot, x) && from_axis < kSidewalkEdge + kGardenDepth + 3)
        return Cell{label::kOtherGround, 0.26F, kKerbHeight, false};
      if (std::fabs(x - plot.center()) < 0.6 && from_axis < kSidewalkEdge + kGardenDepth)
        return kGardenPath;
      return from_axis < kSidewalkEdge + kBuildingDepth ? std::optional(kSoil) : std::nullopt;
    case PlotKind::side_street: break;
  }
  return std::nullopt;
}

std::optional<Cell> cell_at(const StreetPlan& plan, double x, double y) {
  const double from_axis = std::fabs(y);
  const double beyond = std::max(-x, x - plan.length);  // the street's end
  if (beyond > 0) {
    if (from_axis > kCrossHalfLength) return std::nullopt;
    if (beyond < kCrossRoad) return kAsphalt;
    return beyond < kCrossRoad + kKerbWidth ? kKerbStone : kPaving;
  }
  if (from_axis < kRoadHalfWidth) return road_cell(plan, x, y);
  const Plot* plot = plan.plot_at(y > 0 ? 1 : -1, x);
  if (plot == nullptr) return std::nullopt;
  if (plot->kind == PlotKind::side_street) {
    const double off = std::fabs(x - plot->center());
    if (from_axis > kSideStreetEnd) return std::nullopt;
    if (off < kSideStreetHalfRoad) return kAsphalt;
    return off < kSideStreetHalfRoad + kKerbWidth ? kKerbStone : kPaving;
  }
  return from_axis < kSidewalkEdge ? sidewalk_cell(plan, *plot, x, from_axis)
                                   : plot_cell(*plot, x, from_axis);
}

/// Feature cuts unchanged, plus regular cuts at `step` where no feature cut is near.
std::vector<double> merged_cuts(std::vector<double> features, double low, double high,
                                double step) {
  std::ranges::sort(features);
  std::vector<double> cuts;
  for (const double cut : features)
    if (cuts.empty() || cut - cuts.back() > 1e-6) cuts.push_back(cut);
  const std::size_t fixed = cuts.size();
  for (int k = 0; low + k * step <= high; ++k) {
    const double cut = low + k * step;
    const auto end = cuts.begin() + static_cast<std::ptrdiff_t>(fixed);
    const auto above = std::lower_bound(cuts.begin(), end, cut);
    const bool near_above = above != end && *above - cut < kMinCell_m;
    const bool near_below = above != cuts.begin() && cut - *(above - 1) < kMinCell_m;
    if (!near_above && !near_below) cuts.push_back(cut);
  }
  std::ranges::sort(cuts);
  return cuts;
}

std::vector<double> cuts_along(const StreetPlan& plan) {
  std::vector<double> cuts = {-kCrossEnd,
                              -kCrossRoad - kKerbWidth,
                              -kCrossRoad,
                              0,
                              plan.length,
                              plan.length + kCrossRoad,
                              plan.length + kCrossRoad + kKerbWidth,
                              plan.length + kCrossEnd,
                              plan.crossing - kZebraHalfLength,
                              plan.crossing + kZebraHalfLength};
  for (int k = 0; 5.0 * k < plan.length; ++k) {  // ends of the dashes
    cuts.push_back(5.0 * k);
    cuts.push_back(5.0 * k + 3.0);
  }
  for (const Plot& plot : plan.plots) {
    cuts.push_back(plot.x0);
    if (plot.kind == PlotKind::side_street)
      for (const double off : {kSideStreetHalfRoad, kSideStreetHalfRoad + kKerbWidth})
        cuts.insert(cuts.end(), {plot.center() - off, plot.center() + off});
    if (plot.kind == PlotKind::house)
      cuts.insert(cuts.end(),
                  {plot.x0 + 0.6, plot.x0 + 3.4, plot.center() - 0.6, plot.center() + 0.6});
  }
  for (const Item& item : plan.items)
    if (item.kind == ItemKind::tree) cuts.insert(cuts.end(), {item.x - 0.6, item.x + 0.6});
  return merged_cuts(cuts, -kCrossEnd, plan.length + kCrossEnd, 1.0);
}

std::vector<double> cuts_across() {
  std::vector<double> positive = {0.07,
                                  kRoadHalfWidth,
                                  kRoadHalfWidth + kKerbWidth,
                                  kTreeLine - 0.6,
                                  kTreeLine + 0.6,
                                  7.8,
                                  kSidewalkEdge,
                                  kSidewalkEdge + 0.6,
                                  kSidewalkEdge + kBuildingDepth,
                                  kCrossHalfLength,
                                  kSideStreetEnd};
  for (int k = 0; k < 11; ++k) positive.push_back(0.25 + 0.5 * k);  // the bars of the crossing
  for (double y = kSidewalkEdge + 1.2; y < kSidewalkEdge + kBuildingDepth - 0.3; y += 0.6)
    positive.push_back(y);
  for (double y = kCrossHalfLength + 2; y < kSideStreetEnd - 0.5; y += 2) positive.push_back(y);
  std::vector<double> cuts = {0.0};
  for (const double y : positive) cuts.insert(cuts.end(), {y, -y});
  std::ranges::sort(cuts);
  return cuts;
}

/// Height of a cell's corner. The roughness of soil is drawn by corner, so cells that share a
/// corner agree.
double corner_height(const StreetPlan& plan, const Cell& cell, double x, double y) {
  double rough = 0;
  if (cell.rough) {
    const std::uint64_t name =
        std::bit_cast<std::uint64_t>(x) ^ Random::mix(std::bit_cast<std::uint64_t>(y));
    rough = kTerrainRoughness * random_of(plan, Purpose::ground, name).uniform(-1, 1);
  }
  return road_height(x, y) + cell.step + rough;
}

/// The face between two cells along the edge from (x0, y0) to (x1, y1).
void add_step(const StreetPlan& plan, MeshBuilder& builder, const std::optional<Cell>& one,
              const std::optional<Cell>& other, std::array<double, 2> from,
              std::array<double, 2> to) {
  if (!one || !other || (one->step == other->step && one->rough == other->rough)) return;
  const Cell& upper = one->step > other->step ? *one : *other;
  const bool stone = !upper.rough;
  const Material face = {stone ? label::kSidewalk : label::kTerrain,
                         stone ? kKerbStone.reflectance : kSoil.reflectance};
  const auto corner = [&](const Cell& cell, std::array<double, 2> p) {
    return Vec3d{p[0], p[1], corner_height(plan, cell, p[0], p[1])};
  };
  builder.quad(corner(*one, from), corner(*one, to), corner(*other, to), corner(*other, from),
               face);
}

}  // namespace

void add_ground(const StreetPlan& plan, MeshBuilder& builder) {
  const std::vector<double> xs = cuts_along(plan);
  const std::vector<double> ys = cuts_across();
  const std::size_t columns = xs.size() - 1;
  const std::size_t rows = ys.size() - 1;
  std::vector<std::optional<Cell>> cells(columns * rows);
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t j = 0; j < rows; ++j)
      cells[i * rows + j] = cell_at(plan, 0.5 * (xs[i] + xs[i + 1]), 0.5 * (ys[j] + ys[j + 1]));

  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      const std::optional<Cell>& cell = cells[i * rows + j];
      if (!cell) continue;
      const auto corner = [&](std::size_t a, std::size_t b) {
        return Vec3d{xs[a], ys[b], corner_height(plan, *cell, xs[a], ys[b])};
      };
      builder.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1),
                   {cell->class_id, cell->reflectance});
      if (i + 1 < columns)
        add_step(plan, builder, cell, cells[(i + 1) * rows + j], {xs[i + 1], ys[j]},
                 {xs[i + 1], ys[j + 1]});
      if (j + 1 < rows)
        add_step(plan, builder, cell, cells[i * rows + j + 1], {xs[i], ys[j + 1]},
                 {xs[i + 1], ys[j + 1]});
    }
  }
}

}  // namespace adasplats
