// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr double kPassing_m = 2.5;  // lateral distance between passing movers
constexpr double kPoseEvery_s = 0.25;

std::uint16_t moving_class(VehicleKind kind) {
  switch (kind) {
    case VehicleKind::car: return label::kMovingCar;
    case VehicleKind::truck: return label::kMovingTruck;
    case VehicleKind::bus: return label::kMovingBus;
    case VehicleKind::trailer: return label::kMovingOther;
    case VehicleKind::cyclist: return label::kMovingBicyclist;
    case VehicleKind::motorcyclist: return label::kMovingMotorcyclist;
    case VehicleKind::walker: return label::kMovingPerson;
  }
  return label::kMovingOther;
}

/// One lane of movers that follow each other at one speed.
struct TrafficLane {
  VehicleKind kind = VehicleKind::car;
  int side = -1;
  double from_axis = 1.5;
  bool forth = true;  ///< towards larger s
  double speed_m_per_s = 9;
  double in_100_m = 1;
};

Trajectory path_along(const WorldPlan& plan, const TrafficLane& lane, double from_s) {
  Trajectory path;
  const double yaw = (lane.side > 0) == lane.forth ? 0 : std::numbers::pi;
  for (int k = 0; k < 400; ++k) {
    const double time_s = kPoseEvery_s * k;
    const double s = from_s + (lane.forth ? 1 : -1) * lane.speed_m_per_s * time_s;
    if (s < 1 || s > plan.options.length_m - 1) {
      if (!path.empty()) break;
      continue;
    }
    path.push_back({time_s, plan.pose_at(s, lane.side, lane.from_axis, yaw)});
  }
  return path;
}

class TrafficMaker {
 public:
  TrafficMaker(const WorldPlan& plan, std::uint16_t first_instance)
      : plan_(plan), instance_(first_instance) {}

  void fill(const TrafficLane& lane) {
    if (lane.in_100_m <= 0) return;
    Random random = random_of(plan_, WorldPurpose::traffic, ++lanes_);
    const double mean = 100 / lane.in_100_m;
    const double room = vehicle_length(lane.kind) + 0.4 * lane.speed_m_per_s;
    // Starts before the road's begin, for movers that enter during the drive.
    const double span = plan_.options.length_m + 200;
    for (double ahead = mean * random.uniform(); ahead < span;
         ahead += std::max(room, mean * random.uniform(0.3, 1.7))) {
      const double from = lane.forth ? plan_.options.length_m - ahead : ahead;
      add(lane, from, random);
    }
  }
  std::vector<MovingObject> take() { return std::move(moving_); }

 private:
  void add(const TrafficLane& lane, double from_s, Random& random) {
    TrafficLane own = lane;
    if (lane.kind == VehicleKind::walker) {  // walkers are not in single file
      own.from_axis += random.uniform(-0.5, 0.5);
      own.forth = random.uniform() < 0.5;
      own.speed_m_per_s = random.uniform(0.8, 1.7);
    }
    Trajectory path = path_along(plan_, own, from_s);
    if (path.size() < 2) return;
    MeshBuilder builder;
    add_vehicle(builder, lane.kind, RigidTransform{},
                {moving_class(lane.kind), draw_paint(random), instance_}, random);
    BuiltMesh built = builder.take();
    moving_.push_back(
        {std::move(built.mesh), std::move(built.reflectances), instance_++, std::move(path)});
  }

  const WorldPlan& plan_;
  std::uint16_t instance_;
  std::uint64_t lanes_ = 0;
  std::vector<MovingObject> moving_;
};

}  // namespace

std::vector<MovingObject> make_world_traffic(const WorldPlan& plan, std::uint16_t first_instance) {
  TrafficMaker maker(plan, first_instance);
  const WorldStyle& style = plan.style;
  for (const int side : {1, -1}) {
    for (int lane = 0; lane < style.lanes; ++lane) {
      // One kind per lane, so that no mover catches up with a slower one.
      Random random = random_of(plan, WorldPurpose::traffic, 1000 + 10 * lane + (side > 0 ? 1 : 0));
      const double heavy = style.trucks + style.buses;
      const bool outer = lane + 1 == style.lanes;
      VehicleKind kind = VehicleKind::car;
      const double rare = plan.options.kind == WorldKind::motorway ? 1 : 0.35;
      if (outer && random.uniform() < rare * heavy / (heavy + 0.6 * style.cars + 1e-9))
        kind = random.uniform() < style.trucks / heavy ? VehicleKind::truck : VehicleKind::bus;
      const double speed = style.speed_m_per_s * (outer ? 0.8 : 1.0) * random.uniform(0.85, 1.15);
      const double many = kind == VehicleKind::car ? style.cars : std::max(0.4, heavy);
      // No oncoming traffic if the vehicle drives in the middle of a narrow road.
      const double line = plan.lane_center(lane);
      if (side > 0 && line + plan.driven_line() < kPassing_m) continue;
      maker.fill({kind, side, line, side < 0, speed, many / style.lanes});
    }
    const double edge = plan.road_end(side);
    const double line = plan.side(side).parking_width > 0 ? plan.lanes_end() - 0.4 : edge - 0.5;
    // Nothing overtakes the scanning vehicle in its lane.
    constexpr double kClearance_m = 1.4;
    const double driven = plan.driven_line();
    const auto fits = [&](double from_axis) {
      return side > 0 || from_axis - driven > kClearance_m;
    };
    maker.fill({VehicleKind::cyclist, side, line, side < 0, 4.5, fits(line) ? style.cyclists : 0});
    const double beside_line = plan.lanes_end() - 0.9;
    maker.fill({VehicleKind::motorcyclist, side, beside_line, side < 0, 8,
                fits(beside_line) ? style.motorcyclists : 0});
    if (plan.options.kind == WorldKind::motorway) continue;
    const double walk = 0.5 * (edge + std::max(edge + 1.4, plan.property_line(side)));
    maker.fill({VehicleKind::walker, side, walk, side < 0, 1.3, style.walkers});
  }
  return maker.take();
}

}  // namespace adasplats
