// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/street_plan.h"
#include "adasplats/synth/world/world.h"
#include "adasplats/synth/world/world_route.h"

// Private to synth/: the layout of a world before its geometry is built.

namespace adasplats {

/// SemanticKITTI ids that streets do not use.
namespace label {
inline constexpr std::uint16_t kOutlier = 1, kBicycle = 11, kBus = 13, kMotorcycle = 15,
                               kTruck = 18, kOtherVehicle = 20, kPerson = 30, kBicyclist = 31,
                               kMotorcyclist = 32, kParking = 44, kLaneMarking = 60,
                               kMovingBicyclist = 253, kMovingMotorcyclist = 255, kMovingBus = 257,
                               kMovingTruck = 258, kMovingOther = 259;
}  // namespace label

enum class Ground : std::uint8_t { road, marking, parking, sidewalk, other, terrain };
inline constexpr std::size_t kGroundCount = 6;

/// A strip of ground along the road, from the end of the previous one to `to`.
struct Strip {
  double to = 0;  ///< m from the axis
  Ground ground = Ground::road;
  double step = 0;  ///< above the road
};

/// An area with ground that differs from its strip: a driveway, a joining street, a square.
struct Patch {
  int side = 1;
  double s0 = 0, s1 = 0, d0 = 0, d1 = 0;  ///< d: absolute distance from the axis
  Ground ground = Ground::parking;
  double step = 0;
  bool crosses_sidewalk = false;  ///< keeps the kerb free of objects
  bool is_island = false;         ///< with a tree, between parked cars
  bool is_crossing = false;       ///< a driven cross street; kept free of objects
};

enum class EdgeKind : std::uint8_t { none, hedge, picket, bars, mesh, boards, wall };
enum class Frontage : std::uint8_t { houses, facades, open, wood, car_park, hall, park, square };

/// A plot on one side of the road. Metres.
struct WorldPlot {
  int side = 1;
  double s0 = 0, s1 = 0;
  Frontage use = Frontage::houses;
  double setback = 4;  ///< from the edge of the sidewalk to the house
  EdgeKind front = EdgeKind::none;
  EdgeKind between = EdgeKind::none;
  double edge_height = 1;
  bool driveway = false;
  std::uint64_t number = 0;
  double width() const { return s1 - s0; }
  double center() const { return 0.5 * (s0 + s1); }
};

/// One side of the road. Densities are numbers per 100 m.
struct SideStyle {
  double parking_width = 0;     ///< 0: no parking lane
  bool parking_marked = false;  ///< has class parking
  double parked_share = 0;      ///< share of occupied parking spaces
  double shoulder = 0;
  double kerb = 0.12;
  double verge = 0;  ///< grass between road and sidewalk
  double sidewalk = 2;
  Frontage frontage = Frontage::houses;
  double trees = 2, bushes = 4, lamps = 2.5, signs = 3, bollards = 0, boxes = 1, people = 1,
         bicycles = 1, motorcycles = 0.3;
  double grass = 0;  ///< tufts of tall grass
  bool power_line = false;
  bool guard_rail = false;
  double noise_wall = 0;  ///< height; 0: none
  double ditch = 0;       ///< depth
  double bank = 0;        ///< rise of the land at the roadside
  double tilt = 0;        ///< slope of the land beyond it
};

/// Random properties of one world of a kind.
struct WorldStyle {
  int lanes = 1;  ///< per direction
  double lane_width = 3;
  double median = 0;  ///< half width
  bool marked = true;
  double crossfall = 0.02;  ///< cross slope of the road
  double driven = 1;        ///< lateral position of the vehicle: 0 axis, 1 center of its lane
  double undulation = 0.1;  ///< of the land, m
  double roughness = 0.03;  ///< of soil and grass, m
  double plot_low = 12, plot_high = 22, setback_low = 2, setback_high = 7;
  double garden_trees = 1, garden_bushes = 3;
  double edge_bushes = 0.3;  ///< per metre of plot edge
  double leafiness = 1;
  double side_streets = 0.6;  ///< per 100 m of one side
  double cars = 1, trucks = 0.1, buses = 0.05, cyclists = 0.2, motorcyclists = 0.1, walkers = 1;
  double speed_m_per_s = 9;
  double car_parks = 0, halls = 0;  ///< shares of the plots
  double tram = 0;                  ///< tram poles per 100 m
  double gantries = 0;
  bool lights = false;             ///< traffic lights where streets join
  std::array<SideStyle, 2> sides;  ///< left, right
};

/// Width of the land on each side of a road.
inline constexpr double kReach_m = 58;

/// Layout of a city's street, which a world draws at random instead.
struct WorldLayout {
  WorldStyle style;
  WorldRoute route;
  std::array<double, 2> reach_m = {kReach_m, kReach_m};  ///< left, right
  double land_step = 0.1;  ///< height of the land beyond the sidewalks
  std::vector<WorldPlot> plots;
  std::vector<Patch> patches;  ///< overridden by those of plots
};

class WorldPlan {
 public:
  explicit WorldPlan(const WorldOptions& options);
  WorldPlan(const WorldOptions& options, WorldLayout layout);

  WorldOptions options;
  WorldStyle style;
  WorldRoute route;
  std::array<double, 2> reach_m = {kReach_m, kReach_m};  ///< left, right
  std::optional<double>
      land_step;  ///< height of the land beyond the sidewalks; nullopt: that of their kerb
  std::array<std::vector<Strip>, 2> strips;  ///< left, right
  std::vector<Patch> patches;
  std::vector<WorldPlot> plots;
  std::array<float, kGroundCount> ground_reflectances{};

  const SideStyle& side(int side) const { return style.sides[side > 0 ? 0 : 1]; }
  const std::vector<Strip>& strips_of(int side) const { return strips[side > 0 ? 0 : 1]; }
  /// Distances from the axis: outer edge of the lanes, of the road with parking lane and shoulder,
  /// of the sidewalk.
  double lanes_end() const { return style.median + style.lanes * style.lane_width; }
  double road_end(int side) const;
  double property_line(int side) const;
  double reach(int side) const { return reach_m[side > 0 ? 0 : 1]; }
  /// Center of a lane; 0 is the innermost.
  double lane_center(int lane) const { return style.median + (lane + 0.5) * style.lane_width; }

  /// Distance of the vehicle from the axis, on the right side.
  double driven_line() const { return style.driven * lane_center(style.lanes - 1); }

  struct Cell {
    Ground ground = Ground::terrain;
    double step = 0;
  };
  Cell cell_at(double s, double d) const;
  /// Height of the land without steps and roughness.
  double height(double s, double d) const;
  Vec3d ground_at(double s, double d) const;
  /// Pose of an object on either side: x along the road, y away from it, turned by `yaw`.
  RigidTransform pose_at(double s, int side, double from_axis, double yaw = 0) const;
  /// Whether an island is in the parking lane between s0 and s1.
  bool has_island(int side, double s0, double s1) const;
  /// Whether a driveway or a street crosses the sidewalk between s0 and s1.
  bool is_open(int side, double s0, double s1) const;
  /// Whether a driven street crosses there.
  bool is_crossing(int side, double s) const;

  Random random(std::uint64_t purpose, std::uint64_t number) const;

 private:
  void draw_ground();
  void draw_strips();
  void draw_plots();
  void draw_patches();
  void draw_islands(int side);

  std::array<std::array<double, 4>, 4>
      swells_{};  ///< waves of the land: direction, wavelength, phase
};

/// Depth of a car park: two rows of cars and a lane between them.
inline constexpr double kCarPark_m = 17;

/// Draws the style of a kind of world.
WorldStyle draw_world_style(WorldKind kind, Random random);
/// Draws the plot of a side that begins at s; the caller sets its number. `fenceless`: share of
/// plots without a fence.
WorldPlot draw_world_plot(const WorldStyle& style, int side, double s, double fenceless,
                          Random& draw);
RouteLimits route_limits(WorldKind kind);

}  // namespace adasplats
