// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_traffic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "adasplats/synth/city/city_grid.h"

namespace adasplats {
namespace {

constexpr double kBlockTime_s = 16;  // between two crossings: about 35 km/h
// When the vehicles of a lane pass a crossing, as shares of that time; the shortest gap is about 2
// s. On north streets they pass half a period later.
constexpr std::array<double, 3> kPasses = {0.02, 0.14, 0.26};
constexpr double kLater = 0.02;  // maximum delay of a vehicle
constexpr double kNorthLater = 0.5;
constexpr int kSlotsOfBlock = static_cast<int>(kPasses.size());

struct KindOfModel {
  VehicleKind kind;
  int variants;
  std::uint16_t class_id;
};
constexpr std::array<KindOfModel, 6> kModels = {
    {{VehicleKind::car, 24, label::kMovingCar},
     {VehicleKind::truck, 6, label::kMovingTruck},
     {VehicleKind::bus, 3, label::kMovingBus},
     {VehicleKind::cyclist, 8, label::kMovingBicyclist},
     {VehicleKind::motorcyclist, 5, label::kMovingMotorcyclist},
     {VehicleKind::walker, 16, label::kMovingPerson}}};

int wrap(int value, int count) { return ((value % count) + count) % count; }

VehicleKind draw_kind(Random& random) {
  const double draw = random.uniform();
  return draw < 0.86   ? VehicleKind::car
         : draw < 0.91 ? VehicleKind::truck
         : draw < 0.95 ? VehicleKind::bus
                       : VehicleKind::motorcyclist;
}

/// One lane of an entire street and its vehicles at a given time.
class Rail {
 public:
  Rail(const CityGrid& grid, const MoverModels& models, CityAxis axis, int line, bool forth,
       int lane)
      : grid_(grid), models_(models), axis_(axis), line_(line), forth_(forth), lane_(lane) {}

  /// Vehicles between `from` and `to` along the street.
  void vehicles(double from, double to, double time_s, double density,
                std::vector<PlacedMover>& placed) const {
    each_slot(from, to, time_s / kBlockTime_s, 1, [&](int slot, double blocks, int pass) {
      Random random = random_of(grid_, CityPurpose::slots, key(), kSlotsOfBlock * slot + pass);
      const bool taken = random.uniform() < density;
      const double late = kLater * random.uniform();
      if (!taken) return;
      const VehicleKind kind = draw_kind(random);
      add_mover(models_.pick(kind, random), blocks - (forth_ ? late : -late),
                static_cast<std::uint16_t>(4 * wrap(slot, 32) + pass), 0, placed);
    });
  }
  /// Cyclists at the edge of the road, at half the speed.
  void cyclists(double from, double to, double time_s, double density,
                std::vector<PlacedMover>& placed) const {
    each_slot(from, to, 0.5 * time_s / kBlockTime_s, 0.5, [&](int slot, double blocks, int pass) {
      if (pass != 0) return;
      Random random = random_of(grid_, CityPurpose::slots, key(), (1 << 30) + slot);
      if (random.uniform() >= density) return;
      add_mover(models_.pick(VehicleKind::cyclist, random), blocks,
                static_cast<std::uint16_t>(4 * wrap(slot, 32) + 3), kCyclistsLine_m, placed);
    });
  }

 private:
  static constexpr double kCyclistsLine_m = 1.2;  // offset to the right of the center of the lane

  std::int64_t key() const { return (4 * street_key(axis_, line_) + (forth_ ? 1 : 0)) * 4 + lane_; }

  /// Calls `call` with every slot and its position in blocks, for movers with `pace` blocks per
  /// period.
  template <class Call>
  void each_slot(double from, double to, double blocks, double pace, Call call) const {
    const int first = grid_.block_at(axis_, from);
    const int last = grid_.block_at(axis_, to) + 1;
    const double sign = forth_ ? 1 : -1;
    const double half = axis_ == CityAxis::north ? kNorthLater : 0;
    const int low = static_cast<int>(std::floor(sign * blocks - last)) - 2;
    const int high = static_cast<int>(std::ceil(sign * blocks - first)) + 2;
    for (int slot = low; slot <= high; ++slot) {
      for (int pass = 0; pass < kSlotsOfBlock; ++pass) {
        const double position = sign * (blocks - pace * (kPasses[pass] + half)) - slot;
        if (position >= first && position < last) call(slot, position, pass);
      }
    }
  }

  Vec3d position_on(double along, double more_right) const {
    const double right = grid_.lane_center(axis_, line_, lane_, along) + more_right;
    if (axis_ == CityAxis::east) {
      const double v = grid_.node(CityAxis::north, line_);
      return grid_.land().at(along, v + (forth_ ? -right : right));
    }
    const double u = grid_.node(CityAxis::east, line_);
    return grid_.land().at(u + (forth_ ? right : -right), along);
  }

  void add_mover(std::size_t model, double blocks, std::uint16_t in_street, double more_right,
                 std::vector<PlacedMover>& placed) const {
    const double block = std::floor(blocks);
    const double before = grid_.node(axis_, static_cast<int>(block));
    const double next = grid_.node(axis_, static_cast<int>(block) + 1);
    const double along = before + (blocks - block) * (next - before);
    const double half = forth_ ? 0.5 : -0.5;
    const Vec3d here = position_on(along, more_right);
    const Vec3d ahead =
        position_on(along + half, more_right) - position_on(along - half, more_right);
    const double pitch = -std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
    // 8 streets of 2 axes, 2 directions and 2 lanes; 128 vehicles each.
    const int street =
        ((wrap(line_, 8) * 2 + (axis_ == CityAxis::north ? 1 : 0)) * 2 + (forth_ ? 1 : 0)) * 2 +
        std::min(lane_, 1);
    placed.push_back(
        {model,
         static_cast<std::uint16_t>(kFirstMover + 128 * street + in_street),
         {rotation_from_yaw_pitch_roll(std::atan2(ahead.y, ahead.x), pitch, 0), here}});
  }

  const CityGrid& grid_;
  const MoverModels& models_;
  CityAxis axis_;
  int line_;
  bool forth_;
  int lane_;
};

constexpr std::uint16_t kFirstWalker = kFirstMover + 64 * 128;
constexpr int kMaxWalkers = 16;  // per side of a section
static_assert(kFirstWalker + 2 * kMaxWalkers * kSectionGroups <= 65535);

}  // namespace

std::pair<Vec3f, Vec3f> city_bounds(const TriangleMesh& mesh) {
  Vec3f low = mesh.vertices.front();
  Vec3f high = low;
  for (const Vec3f& vertex : mesh.vertices) {
    low = min(low, vertex);
    high = max(high, vertex);
  }
  constexpr Vec3f kMargin = {0.01F, 0.01F, 0.01F};  // covers the rounding of hits
  return {low - kMargin, high + kMargin};
}

MoverModels::MoverModels(const CityGrid& grid, const Executor& executor) {
  for (const KindOfModel& of : kModels) {
    for (int k = 0; k < of.variants; ++k) {
      Random random = random_of(grid, CityPurpose::models, static_cast<int>(of.kind), k);
      MeshBuilder builder;
      add_vehicle(builder, of.kind, RigidTransform{}, {of.class_id, draw_paint(random), 0}, random);
      auto model = std::make_unique<MoverModel>();
      model->built = builder.take();
      std::tie(model->low, model->high) = city_bounds(model->built.mesh);
      model->tracer = make_cpu_tracer(SceneView{{}, &model->built.mesh}, executor);
      models_.push_back(std::move(model));
      kinds_.push_back(of.kind);
    }
  }
}

std::size_t MoverModels::pick(VehicleKind kind, Random& random) const {
  const auto first = std::ranges::find(kinds_, kind);
  const auto count = static_cast<double>(std::count(first, kinds_.end(), kind));
  return static_cast<std::size_t>(first - kinds_.begin()) +
         static_cast<std::size_t>(count * random.uniform());
}

std::uint16_t section_group(const CitySectionId& id) {
  const bool east = id.axis == CityAxis::east;
  const int i = wrap(east ? id.block : id.line, 8);
  const int j = wrap(east ? id.line : id.block, 8);
  return static_cast<std::uint16_t>((8 * i + j) * 2 + (east ? 0 : 1));
}

std::vector<Walker> draw_walkers(const CityGrid& grid, const CitySectionId& id,
                                 const WorldPlan& plan, const MoverModels& models) {
  std::vector<Walker> walkers;
  for (const int side : {1, -1}) {
    double s0 = 2;
    double s1 = plan.options.length_m - 2;
    for (const Patch& patch : plan.patches) {  // keeps walkers off the road
      if (patch.side != side || !patch.is_crossing) continue;
      if (patch.s1 < 0.5 * plan.options.length_m)
        s0 = std::max(s0, patch.s1 + 1);
      else
        s1 = std::min(s1, patch.s0 - 1);
    }
    if (s1 - s0 < 5) continue;
    Random random = random_of(grid, CityPurpose::walkers,
                              2 * street_key(id.axis, id.line) + (side > 0 ? 1 : 0), id.block);
    const double expected = plan.style.walkers * (s1 - s0) / 100 * random.uniform(0.5, 1.5);
    const double walk = 0.5 * (plan.road_end(side) + plan.property_line(side));
    for (int k = 0; k < std::min(kMaxWalkers, static_cast<int>(expected + random.uniform())); ++k) {
      Walker walker = {
          .side = side, .from_axis = walk + random.uniform(-0.4, 0.4), .s0 = s0, .s1 = s1};
      walker.model = models.pick(VehicleKind::walker, random);
      walker.speed_m_per_s = random.uniform(0.8, 1.7);
      walker.phase_m = random.uniform(0, 2 * (s1 - s0));
      walker.instance = static_cast<std::uint16_t>(
          kFirstWalker + (2 * section_group(id) + (side > 0 ? 1 : 0)) * kMaxWalkers + k);
      walkers.push_back(walker);
    }
  }
  return walkers;
}

PlacedMover place_walker(const Walker& walker, const WorldPlan& plan, double time_s) {
  const double way = walker.s1 - walker.s0;
  const double done = std::fmod(walker.phase_m + walker.speed_m_per_s * time_s, 2 * way);
  const bool forth = done < way;
  const double s = walker.s0 + (forth ? done : 2 * way - done);
  const double yaw = (walker.side > 0) == forth ? 0 : std::numbers::pi;
  return {walker.model, walker.instance, plan.pose_at(s, walker.side, walker.from_axis, yaw)};
}

std::vector<PlacedMover> vehicles_around(const CityGrid& grid, const MoverModels& models,
                                         Vec3d grid_position, double reach_m, double time_s) {
  std::vector<PlacedMover> placed;
  for (const CityAxis axis : {CityAxis::east, CityAxis::north}) {
    const bool east = axis == CityAxis::east;
    const double along = east ? grid_position.x : grid_position.y;
    const double across = east ? grid_position.y : grid_position.x;
    const CityAxis other = east ? CityAxis::north : CityAxis::east;
    const int last = grid.block_at(other, across + reach_m);
    for (int line = grid.block_at(other, across - reach_m); line <= last; ++line) {
      Random random = random_of(grid, CityPurpose::density, street_key(axis, line), 0);
      const int lanes = grid.lanes(axis, line);
      const double busy = random.uniform();
      const double density = 0.08 + 0.55 * busy * busy;
      const double cyclists = 0.35 * random.uniform() * random.uniform();
      for (const bool forth : {true, false}) {
        for (int lane = 0; lane < lanes; ++lane) {
          const Rail rail(grid, models, axis, line, forth, lane);
          rail.vehicles(along - reach_m, along + reach_m, time_s, density, placed);
          if (lane + 1 == lanes)
            rail.cyclists(along - reach_m, along + reach_m, time_s, cyclists, placed);
        }
      }
    }
  }
  return placed;
}

}  // namespace adasplats
