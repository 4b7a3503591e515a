// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/synth_city.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <set>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/synth/city/city_drive.h"
#include "adasplats/synth/city/city_grid.h"
#include "adasplats/synth/city/city_sections.h"
#include "adasplats/synth/city/city_traffic.h"
#include "adasplats/synth/city/scan_schedule.h"

namespace adasplats {
namespace {

constexpr std::array<std::uint64_t, 3> kSeeds = {1, 2, 77};

/// Distance along `direction` to the first hit, m.
float nearest_m(const CitySection& section, Vec3d from, Vec3d direction, const Executor& executor) {
  const std::array<Ray, 1> ray = {Ray{vec_cast<float>(from), 0, vec_cast<float>(direction), 200}};
  std::array<Hit, 1> hit;
  section.tracer->nearest(ray, hit, executor);
  return hit[0].t;
}

// Oracle: rectangle containment; each position of a grid is in exactly one section.
TEST(CityGrid, SectionsTileThePlane) {
  for (const std::uint64_t seed : kSeeds) {
    const CityGrid grid(seed);
    for (double u = -401; u < 500; u += 13.7) {
      for (double v = -399; v < 500; v += 11.3) {
        int in = 0;
        for (const CitySectionId& id : sections_around(grid, {u, v, 0}, 0)) {
          const CityRect rect = grid.rect(id);
          if (u >= rect.u0 && u < rect.u1 && v >= rect.v0 && v < rect.v1) ++in;
        }
        ASSERT_EQ(in, 1) << u << " " << v;
      }
    }
  }
}

// Oracle: the definition, over all sections of a large region.
TEST(CityGrid, SectionsAroundEqualBruteForce) {
  const CityGrid grid(3);
  const Vec3d position = {33, -12, 0};
  std::set<CitySectionId> near;
  for (int i = -8; i < 9; ++i)
    for (int j = -8; j < 9; ++j)
      for (const CitySectionId id :
           {CitySectionId{CityAxis::east, j, i}, CitySectionId{CityAxis::north, i, j}})
        if (grid.rect(id).distance(position.x, position.y) < 120) near.insert(id);
  const std::set<CitySectionId> found = sections_around(grid, position, 120);
  EXPECT_TRUE(std::includes(found.begin(), found.end(), near.begin(), near.end()));
  EXPECT_LT(found.size(), 40U);
}

// Oracle: the land at positions that two sections share.
TEST(CityGrid, StreetsJoinInPositionAndHeight) {
  const CityGrid grid(5);
  const WorldPlan west = grid.plan({CityAxis::east, 2, 1});
  const WorldPlan east = grid.plan({CityAxis::east, 2, 2});
  for (const double d : {-20.0, -1.0, 0.0, 3.0, 30.0}) {
    const double end = west.options.length_m;
    EXPECT_LT(length(west.route.at(end, d) - east.route.at(0, d)), 1e-9);
    EXPECT_NEAR(west.height(end, d), east.height(0, d), 1e-9);
  }
  // North sections begin at the edge of the strip of the east street.
  const WorldPlan north = grid.plan({CityAxis::north, 2, 2});
  const Vec3d rim = east.route.at(0, kCityRow_m);
  EXPECT_LT(length(north.route.at(0, 0) - rim), 1e-9);
  EXPECT_NEAR(north.height(0, 0), east.height(0, kCityRow_m), 1e-9);
  // Lanes and sidewalks continue across the edge.
  for (double d = 0.3; d < north.property_line(-1); d += 0.5)
    EXPECT_EQ(north.cell_at(1, -d).ground, east.cell_at(d, kCityRow_m - 1).ground) << d;
}

// Oracle: consecutive poses are centimetres apart, and the plan has road under the vehicle.
TEST(CityDrive, IsContinuousAndOnRoads) {
  for (const std::uint64_t seed : kSeeds) {
    const CityGrid grid(seed);
    const CityDrive drive(grid, 2500);
    std::map<CitySectionId, WorldPlan> plans;
    TimedPose before = drive.at(0);
    double turned = 0;
    for (double s = 0.5; s <= 2500; s += 0.5) {
      const TimedPose here = drive.at(s);
      const double step =
          length(here.world_from_sensor.translation - before.world_from_sensor.translation);
      ASSERT_NEAR(step, 0.5, 0.02) << s;
      const double turn =
          angle_between(here.world_from_sensor.rotation, before.world_from_sensor.rotation);
      ASSERT_LT(turn, 0.2) << s;
      turned += turn;
      before = here;
      const Vec3d position = drive.grid_position(s);
      int on_road = 0;
      for (const CitySectionId& id : sections_around(grid, position, 0)) {
        const CityRect rect = grid.rect(id);
        if (position.x < rect.u0 || position.x >= rect.u1 || position.y < rect.v0 ||
            position.y >= rect.v1)
          continue;
        const auto plan = plans.try_emplace(id, grid.plan(id)).first;
        const bool east = id.axis == CityAxis::east;
        const double along = east ? position.x - rect.u0 : position.y - rect.v0;
        const double left = east ? position.y - grid.node(CityAxis::north, id.line)
                                 : grid.node(CityAxis::east, id.line) - position.x;
        const Ground ground = plan->second.cell_at(along, left).ground;
        on_road += ground == Ground::road || ground == Ground::marking ? 1 : 0;
        EXPECT_NEAR(plan->second.height(along, left), here.world_from_sensor.translation.z, 0.01);
      }
      ASSERT_EQ(on_road, 1) << s << " of seed " << seed;
    }
    EXPECT_GT(turned, 2 * std::numbers::pi);  // it turned at crossings
  }
}

// Oracle: the sequence of streets, from the sections' rectangles.
TEST(CityDrive, RepeatsStreetsAndVisitsMany) {
  const CityGrid grid(4);
  const CityDrive drive(grid, 8000);
  std::map<CitySectionId, int> passes;
  CitySectionId last;
  for (double s = 0; s < 8000; s += 1) {
    const Vec3d position = drive.grid_position(s);
    for (const CitySectionId& id : sections_around(grid, position, 0)) {
      if (grid.rect(id).distance(position.x, position.y) > 0 || id == last) continue;
      ++passes[id];
      last = id;
    }
  }
  EXPECT_GT(passes.size(), 25U);
  EXPECT_GT(std::ranges::count_if(passes, [](const auto& entry) { return entry.second > 1; }), 5);
}

// Oracle: rays at car height from the center of the lane: static objects are at least 0.5 m to the
// side of the vehicle and 2 m ahead of it.
TEST(CitySections, DrivenLanesAreClear) {
  const Executor executor(2);
  const CityGrid grid(6);
  const MoverModels models(grid, executor);
  const CityDrive drive(grid, 420);
  CitySections sections;
  for (double s = 0; s <= 420; s += 1.5) {
    const TimedPose pose = drive.at(s);
    for (const CitySectionId& id : sections_around(grid, drive.grid_position(s), 0)) {
      if (!sections.holds(id))
        sections.add(std::make_unique<CitySection>(grid, id, models), executor);
      for (const double height : {0.5, 1.0, 1.7}) {
        const Vec3d from = pose.world_from_sensor * Vec3d{0, 0, height};
        for (int k = 0; k < 8; ++k) {
          const double yaw = k * std::numbers::pi / 4;
          const Vec3d direction =
              pose.world_from_sensor.rotation * Vec3d{std::cos(yaw), std::sin(yaw), 0};
          EXPECT_GT(nearest_m(sections.section(id), from, direction, executor), 1)
              << name_of(id) << " at " << s << " m, height " << height << ", direction " << k;
        }
      }
    }
  }
  EXPECT_GT(sections.size(), 5U);
}

// Oracle: the same section built twice, the second time after others.
TEST(CitySections, AreEqualWhenRebuilt) {
  const Executor executor(1);
  const CityGrid grid(8);
  const MoverModels models(grid, executor);
  const CitySectionId id = {CityAxis::east, 1, 0};
  const CitySection one(grid, id, models);
  const CitySection between(grid, {CityAxis::north, 1, 0}, models);
  const CitySection again(CityGrid(8), id, models);
  EXPECT_EQ(one.built.mesh.vertices, again.built.mesh.vertices);
  EXPECT_EQ(one.built.mesh.classes, again.built.mesh.classes);
  EXPECT_EQ(one.built.instances, again.built.instances);
  EXPECT_NE(one.built.mesh.vertices, between.built.mesh.vertices);
  EXPECT_EQ(one.walkers.size(), again.walkers.size());
  for (const std::uint16_t instance : one.built.instances) ASSERT_LT(instance, kFirstMover);
}

TEST(CitySections, KeepDropsOtherSections) {
  const Executor executor(1);
  const CityGrid grid(8);
  const MoverModels models(grid, executor);
  const CitySectionId one = {CityAxis::north, 0, 0};
  const CitySectionId other = {CityAxis::north, 1, 0};
  CitySections sections;
  sections.add(std::make_unique<CitySection>(grid, one, models), executor);
  sections.add(std::make_unique<CitySection>(grid, other, models), executor);
  sections.keep({other});
  EXPECT_FALSE(sections.holds(one));
  EXPECT_TRUE(sections.holds(other));
}

// Oracle: distances between all pairs, over more than a period of the timetable.
TEST(CityTraffic, VehiclesNeverCollide) {
  const Executor executor(1);
  for (const std::uint64_t seed : kSeeds) {
    const CityGrid grid(seed);
    const MoverModels models(grid, executor);
    std::size_t seen = 0;
    for (double time_s = 100; time_s < 140; time_s += 0.4) {
      const auto placed = vehicles_around(grid, models, {70, 80, 0}, 200, time_s);
      seen = std::max(seen, placed.size());
      std::set<std::uint16_t> instances;
      for (std::size_t i = 0; i < placed.size(); ++i) {
        ASSERT_GE(placed[i].instance, kFirstMover);
        ASSERT_TRUE(instances.insert(placed[i].instance).second);
        for (std::size_t j = 0; j < i; ++j) {
          const Vec3d apart =
              placed[i].world_from_mover.translation - placed[j].world_from_mover.translation;
          ASSERT_GT(length(apart), 0.9) << time_s;
        }
      }
    }
    EXPECT_GT(seen, 10U);
  }
}

// Oracle: the speed from a block's length and time, from positions a moment apart.
TEST(CityTraffic, VehiclesMoveForwards) {
  const Executor executor(1);
  const CityGrid grid(2);
  const MoverModels models(grid, executor);
  std::map<std::uint16_t, PlacedMover> before;
  for (const PlacedMover& mover : vehicles_around(grid, models, {0, 0, 0}, 150, 50))
    before[mover.instance] = mover;
  int compared = 0;
  for (const PlacedMover& mover : vehicles_around(grid, models, {0, 0, 0}, 150, 50.1)) {
    const auto found = before.find(mover.instance);
    if (found == before.end()) continue;
    const Vec3d way = found->second.world_from_mover.inverse() * mover.world_from_mover.translation;
    if (length(way) > 5) continue;  // left; its id belongs to another vehicle
    ++compared;
    EXPECT_GT(way.x, 0.3);
    EXPECT_LT(way.x, 1.6);
    EXPECT_LT(std::hypot(way.y, way.z), 0.15);
  }
  EXPECT_GT(compared, 5);
}

TEST(ScanSchedule, SpacingGivesEveryPositionOnce) {
  ScanSchedule schedule({.length_m = 100, .spacing_m = 3}, 1000);
  std::vector<double> all;
  for (auto some = schedule.next(7, 12, 0); !some.empty(); some = schedule.next(7, 12, 0)) {
    EXPECT_LE(some.back() - some.front(), 12);
    all.insert(all.end(), some.begin(), some.end());
  }
  ASSERT_EQ(all.size(), 34U);
  for (std::size_t k = 0; k < all.size(); ++k)
    EXPECT_NEAR(all[k], 3.0 * static_cast<double>(k), 1e-9);
}

// Oracle: the requested number, with scans that deviate from the first assumption.
TEST(ScanSchedule, PointsAreMetToWithinOneScan) {
  constexpr std::size_t kRays = 1000;
  for (const double points_wanted : {700.0, 5'000.0, 300'000.0, 2e6}) {
    ScanSchedule schedule({.length_m = 400, .points = points_wanted}, kRays);
    double points = 0;
    double last = -1;
    for (auto some = schedule.next(64, 48, 0); !some.empty();
         some = schedule.next(64, 48, static_cast<std::size_t>(points))) {
      for (const double position : some) {
        EXPECT_GT(position, last);
        EXPECT_LE(position, 400 + 1e-6);
        last = position;
        points += 500 + position;  // 500 to 900 of 1000 rays
      }
    }
    EXPECT_NEAR(points, points_wanted, 900) << points_wanted;
    EXPECT_GE(last, points_wanted > 1e5 ? 380 : 0);
  }
}

TEST(ScanSchedule, RejectsContradictoryOptions) {
  for (const SynthCityOptions& options : {SynthCityOptions{.points = 1e6, .spacing_m = 1},
                                          SynthCityOptions{.length_m = 50, .points = 1e12},
                                          SynthCityOptions{.length_m = 1e6, .spacing_m = 0.01}}) {
    expect_error(ErrorKind::usage, {}, [&] { const ScanSchedule schedule(options, 100'000); });
  }
}

}  // namespace
}  // namespace adasplats
