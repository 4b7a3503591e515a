// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/vehicle_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "adasplats/io/base/number_text.h"

namespace adasplats {

std::uint32_t body_column(Vec3f direction) {
  const double azimuth_rad =
      std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x));
  const double share = azimuth_rad / (2 * std::numbers::pi) + 0.5;
  return std::min(static_cast<std::uint32_t>(std::max(share, 0.0) * kBodyColumns),
                  kBodyColumns - 1);
}

double body_azimuth_deg(std::uint32_t column) { return column * (360.0 / kBodyColumns) - 180; }

std::size_t VehicleBody::find(std::uint16_t ring, Vec3f direction) const {
  const std::uint32_t column = body_column(direction);
  const auto found = std::ranges::lower_bound(
      cells, std::tuple(std::uint32_t{ring}, column), {}, [](const BodyCell& cell) {
        return std::tuple(std::uint32_t{cell.ring}, std::uint32_t{cell.column});
      });
  const bool is_there = found != cells.end() && found->ring == ring && found->column == column;
  return is_there ? static_cast<std::size_t>(found - cells.begin()) : cells.size();
}

double VehicleBody::range_to_boxes(Vec3d origin, Vec3d direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const BodyBox& box : boxes) {
    const RigidTransform box_from_sensor = box.sensor_from_box.inverse();
    const Vec3d from = box_from_sensor * origin, along = box_from_sensor.rotation * direction;
    double begin = 0, end = nearest;
    for (int axis = 0; axis < 3 && begin <= end; ++axis) {
      if (along[axis] == 0) {  // parallel to these sides
        if (!(std::fabs(from[axis]) < box.half_size_m[axis])) end = -1;
        continue;
      }
      const double near_side = (-box.half_size_m[axis] - from[axis]) / along[axis];
      const double far_side = (box.half_size_m[axis] - from[axis]) / along[axis];
      begin = std::max(begin, std::min(near_side, far_side));
      end = std::min(end, std::max(near_side, far_side));
    }
    if (begin < end) nearest = begin;
  }
  return nearest;
}

std::string vehicle_body_toml(const VehicleBody& body) {
  std::string text =
      "# What beams measure that end on the vehicle: ring (topmost 0), azimuth where its half "
      "degree\n"
      "# begins (counter-clockwise from +x), percent of its beams that do, range in mm, "
      "intensity.\n"
      "cells = [\n";
  for (const BodyCell& cell : body.cells) {
    text += "  [" + std::to_string(cell.ring) + ", " + exact_text(body_azimuth_deg(cell.column)) +
            ", " + std::to_string(std::lround(100 * static_cast<double>(cell.share))) + ", " +
            std::to_string(std::lround(1000 * static_cast<double>(cell.range_m))) + ", " +
            exact_text(std::round(static_cast<double>(cell.intensity) * 1e4) / 1e4) + "],\n";
  }
  return text + "]\n";
}

}  // namespace adasplats
