// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

/// Adds objects with consecutive instance ids.
class Parking {
 public:
  Parking(const WorldPlan& plan, MeshBuilder& builder) : plan_(plan), builder_(builder) {}

  std::uint16_t next_instance() const { return instance_; }

  void put(VehicleKind kind, std::uint16_t class_id, double s, int side, double from_axis,
           double yaw, Random& random) {
    if (plan_.is_crossing(side, s)) return;
    const RigidTransform pose = plan_.pose_at(s, side, from_axis, yaw);
    add_vehicle(builder_, kind, pose, {class_id, draw_paint(random), instance_++}, random);
  }
  /// Without a rider, slightly tilted.
  void put_bike(bool motorcycle, double s, int side, double from_axis, double yaw, Random& random) {
    if (plan_.is_crossing(side, s)) return;
    RigidTransform pose = plan_.pose_at(s, side, from_axis, yaw);
    pose.rotation = pose.rotation * rotation_from_yaw_pitch_roll(0, 0, random.uniform(-0.2, 0.2));
    builder_.set_frame(pose);
    const auto reflectance = static_cast<float>(random.uniform(0.1, 0.5));
    if (motorcycle)
      add_motorcycle(builder_, {label::kMotorcycle, reflectance, instance_++});
    else
      add_bicycle(builder_, {label::kBicycle, reflectance, instance_++});
    builder_.reset_frame();
  }

 private:
  const WorldPlan& plan_;
  MeshBuilder& builder_;
  std::uint16_t instance_ = 1;
};

void park_along(const WorldPlan& plan, Parking& parking, int side) {
  const SideStyle& own = plan.side(side);
  if (own.parking_width <= 0) return;
  Random random = random_of(plan, WorldPurpose::parked, side > 0 ? 1 : 0);
  const double middle = plan.lanes_end() + 0.5 * own.parking_width;
  for (double s = 3; s < plan.options.length_m - 8;) {
    // Trucks and buses need more than a narrow lane.
    const double draw = random.uniform() * (own.parking_width > 2.2 ? 1 : 0.91);
    const VehicleKind kind = draw < 0.91    ? VehicleKind::car
                             : draw < 0.945 ? VehicleKind::truck
                             : draw < 0.975 ? VehicleKind::trailer
                                            : VehicleKind::bus;
    const double room = vehicle_length(kind) + random.uniform(0.6, 1.8);
    const bool taken = random.uniform() < own.parked_share;
    if (taken && !plan.is_open(side, s, s + room) && !plan.has_island(side, s, s + room)) {
      const std::uint16_t class_id = kind == VehicleKind::car       ? label::kCar
                                     : kind == VehicleKind::truck   ? label::kTruck
                                     : kind == VehicleKind::trailer ? label::kOtherVehicle
                                                                    : label::kBus;
      // Most cars face the direction of their lane, against x on either side.
      const bool is_car = kind == VehicleKind::car;
      const double against = is_car && random.uniform() < 0.12 ? 0 : std::numbers::pi;
      // A truck with a trailer is longer behind its origin than ahead of it.
      const double ahead = kind != VehicleKind::truck ? 0.5 * room : side < 0 ? room - 5.5 : 5.5;
      parking.put(kind, class_id, s + ahead, side, middle + random.uniform(-0.12, 0.12),
                  against + random.uniform(-0.03, 0.03), random);
    }
    s += room;
  }
}

void park_in_drives(const WorldPlan& plan, Parking& parking) {
  for (const WorldPlot& plot : plan.plots) {
    if (!plot.driveway) continue;
    Random random = random_of(plan, WorldPurpose::parked, 100 + plot.number);
    if (random.uniform() > 0.55) continue;
    const double deep = plan.property_line(plot.side) + random.uniform(2.8, 3 + plot.setback);
    const double draw = random.uniform();
    const double yaw = (random.uniform() < 0.5 ? 0.5 : -0.5) * std::numbers::pi;
    if (draw < 0.88)
      parking.put(VehicleKind::car, label::kCar, plot.s0 + 1.9, plot.side, deep, yaw, random);
    else
      parking.put(VehicleKind::trailer, label::kOtherVehicle, plot.s0 + 1.9, plot.side, deep, yaw,
                  random);
  }
}

/// Two rows of cars, with their nose or tail towards the lane between them.
void fill_car_parks(const WorldPlan& plan, Parking& parking) {
  for (const WorldPlot& plot : plan.plots) {
    if (plot.use != Frontage::car_park) continue;
    Random random = random_of(plan, WorldPurpose::parked, 5000 + plot.number);
    const double taken = random.uniform(0.2, 0.9);
    const double line = plan.property_line(plot.side);
    for (const double deep : {line + 3.6, line + kCarPark_m - 3}) {
      for (double s = plot.s0 + 2; s < plot.s1 - 1.8; s += 2.55) {
        if (random.uniform() > taken) continue;
        const double yaw = (random.uniform() < 0.5 ? 0.5 : -0.5) * std::numbers::pi;
        parking.put(VehicleKind::car, label::kCar, s, plot.side, deep + random.uniform(-0.3, 0.3),
                    yaw + 0.03 * random.normal(), random);
      }
    }
  }
}

/// Vehicles in front of barns and workshops.
void park_at_halls(const WorldPlan& plan, Parking& parking) {
  for (const WorldPlot& plot : plan.plots) {
    if (plot.use != Frontage::hall) continue;
    Random random = random_of(plan, WorldPurpose::parked, 9000 + plot.number);
    const double deep = plan.property_line(plot.side) + 2.5;
    for (double s = plot.s0 + 6; s < plot.s1 - 12; s += random.uniform(8, 24)) {
      const double draw = random.uniform();
      const double yaw = 0.3 * random.normal();
      if (draw < 0.4)
        parking.put(VehicleKind::trailer, label::kOtherVehicle, s, plot.side, deep, yaw, random);
      else if (draw < 0.6)
        parking.put(VehicleKind::truck, label::kTruck, s + 5, plot.side, deep, yaw, random);
      else if (draw < 0.8)
        parking.put(VehicleKind::car, label::kCar, s, plot.side, deep, yaw, random);
    }
  }
}

void stand_on_sidewalk(const WorldPlan& plan, Parking& parking, int side) {
  const SideStyle& own = plan.side(side);
  Random random = random_of(plan, WorldPurpose::standing, side > 0 ? 1 : 0);
  const double wide = std::max(1.2, own.sidewalk + own.verge);
  const double kerb = plan.road_end(side);
  for (const double s : positions_along(plan, own.bicycles, 0.6, random)) {
    if (plan.is_open(side, s - 1, s + 5)) continue;
    const double yaw = random.uniform() < 0.5 ? 0.1 * random.normal() : 1.3;
    const int group = random.uniform() < 0.3 ? 1 + static_cast<int>(random.uniform(1, 7)) : 1;
    for (int k = 0; k < group; ++k)
      parking.put_bike(false, s + 0.6 * k, side, kerb + random.uniform(0.75, 0.85) * wide,
                       group > 1 ? 1.4 + 0.1 * random.normal() : yaw, random);
  }
  for (const double s : positions_along(plan, own.motorcycles, 1.5, random))
    parking.put_bike(true, s, side,
                     random.uniform() < 0.5 ? kerb - 0.6 : kerb + random.uniform(0.3, 0.7) * wide,
                     random.uniform(-1.6, 1.6), random);
  for (const double s : positions_along(plan, own.people, 0.5, random)) {
    const int group = random.uniform() < 0.3 ? 2 : 1;
    for (int k = 0; k < group; ++k)
      parking.put(VehicleKind::walker, label::kPerson, s + 0.7 * k, side,
                  kerb + random.uniform(0.1, 0.9) * wide, random.uniform(0, 6.28), random);
  }
}

/// Riders waiting at the kerb.
void wait_on_road(const WorldPlan& plan, Parking& parking, int side) {
  Random random = random_of(plan, WorldPurpose::standing, side > 0 ? 3 : 2);
  const double edge = plan.road_end(side) - 0.1;
  for (const double s : positions_along(plan, 0.3 * plan.style.cyclists, 3, random))
    parking.put(VehicleKind::cyclist, label::kBicyclist, s, side, edge, std::numbers::pi, random);
  for (const double s : positions_along(plan, 0.3 * plan.style.motorcyclists, 4, random))
    parking.put(VehicleKind::motorcyclist, label::kMotorcyclist, s, side, edge, std::numbers::pi,
                random);
}

}  // namespace

std::uint16_t add_world_objects(const WorldPlan& plan, MeshBuilder& builder) {
  Parking parking(plan, builder);
  park_in_drives(plan, parking);
  fill_car_parks(plan, parking);
  park_at_halls(plan, parking);
  for (const int side : {1, -1}) {
    park_along(plan, parking, side);
    stand_on_sidewalk(plan, parking, side);
    wait_on_road(plan, parking, side);
  }
  return parking.next_instance();
}

}  // namespace adasplats
