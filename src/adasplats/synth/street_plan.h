// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/synth/street.h"

// Private to synth/: the layout of a street before its geometry is built, with all dimensions that
// several builders share.

namespace adasplats {

/// SemanticKITTI ids (Behley et al. 2019, semantic-kitti.yaml).
namespace label {
inline constexpr std::uint16_t kCar = 10, kRoad = 40, kSidewalk = 48, kOtherGround = 49,
                               kBuilding = 50, kFence = 51, kOtherStructure = 52, kVegetation = 70,
                               kTrunk = 71, kTerrain = 72, kPole = 80, kTrafficSign = 81,
                               kOtherObject = 99, kMovingCar = 252, kMovingPerson = 254;
}  // namespace label

/// The cross-section, metres from the axis of the road.
inline constexpr double kRoadHalfWidth = 5.5;  // two lanes and a parking lane on either side
inline constexpr double kLaneCenter = 1.7;
inline constexpr double kParkingCenter = 4.4;
inline constexpr double kKerbHeight = 0.13;
inline constexpr double kKerbWidth = 0.15;
inline constexpr double kFurnitureLine = 6.1;  // poles, lamps, barriers
inline constexpr double kTreeLine = 6.5;
inline constexpr double kWalkLine = 8.1;      // people
inline constexpr double kSidewalkEdge = 9.0;  // facades and garden fences
inline constexpr double kGardenDepth = 4.5;
inline constexpr double kBuildingDepth = 11.0;
inline constexpr double kSideStreetHalfRoad = 3.0;
inline constexpr double kSideStreetEnd = 36.0;
/// The cross streets at both ends: road, then sidewalk, then facades.
inline constexpr double kCrossRoad = 7.5;
inline constexpr double kCrossEnd = 10.0;
inline constexpr double kCrossHalfLength = 22.0;

enum class PlotKind : std::uint8_t { apartment, house, wall, side_street };
enum class GardenEdge : std::uint8_t { fence, hedge, wall_with_fence };

/// A plot on one side of the street, [x0, x1] along it.
struct Plot {
  PlotKind kind = PlotKind::apartment;
  int side = 1;  ///< +1: y > 0 (left of +x), -1: right
  double x0 = 0, x1 = 0;
  GardenEdge edge = GardenEdge::fence;  ///< of a house
  std::uint64_t number = 0;             ///< unique in the street; key of its random numbers
  double width() const { return x1 - x0; }
  double center() const { return 0.5 * (x0 + x1); }
};

enum class ItemKind : std::uint8_t {
  tree,
  pole,
  sign_pole,
  crossing_sign,
  traffic_light,
  lamp,
  barrier,
  bollard,
  bench,
  bin,
  advertising_column,
  bus_shelter,
  cabinet,
  parked_car,
};

/// An object along the street.
struct Item {
  ItemKind kind = ItemKind::tree;
  int side = 1;
  double x = 0;
  double length = 0;  ///< along the street, for barriers
  std::uint64_t number = 0;
};

struct StreetPlan {
  std::uint64_t seed = 1;
  double length = 0;
  double crossing = 0;  ///< x of the middle of the zebra crossing
  std::vector<Plot> plots;
  std::vector<Item> items;

  const Plot* plot_at(int side, double x) const;  ///< nullptr outside [0, length]
  /// Random numbers of one object; `purpose` separates the builders.
  Random random(std::uint64_t purpose, std::uint64_t number) const {
    return {seed, purpose, number};
  }
};

inline constexpr double kZebraHalfLength = 1.5;

StreetPlan make_street_plan(const StreetOptions& options);

/// Height of the road's surface, continued under sidewalks and gardens: long waves along the road,
/// a crossfall of 2 % down to the kerbs and 2 % up behind them.
double road_height(double x, double y);

/// Height of the sidewalk's paving: road_height() plus the kerb.
inline double sidewalk_height(double x, double y) { return road_height(x, y) + kKerbHeight; }

}  // namespace adasplats
