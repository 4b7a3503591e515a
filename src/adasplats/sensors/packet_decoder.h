// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/packet_sensor.h"

namespace adasplats {

/// When and to where the head of a sensor looked when it fired all its lasers once.
struct MeasuredColumn {
  std::int64_t time_ns = 0;  ///< Velodyne: since the hour began; Ouster: of the sensor's clock
  double head_rad = 0;       ///< counter-clockwise from +x, when the first laser fired
  double turn_rad_s = 0;     ///< of the head, likewise
  std::uint32_t step = 0;    ///< of steps_per_turn() since the revolution began
  std::uint32_t frame = 0;   ///< Ouster: the number of the revolution
  bool is_valid = true;      ///< Ouster: it was measured
};

/// Points in the frame of the sensor, in the order of firing.
struct PacketPoints {
  std::vector<Vec3d> positions;
  std::vector<double> late_s;  ///< since their column began
  std::vector<float> intensities;
  std::vector<std::uint16_t> rings;  ///< from the topmost
  /// Of the returns of a firing, the nearest is 1 of return_counts; LAS numbers them so.
  std::vector<std::uint8_t> return_numbers, return_counts;
};

/// Takes the packets of one sensor apart: formats as PacketFormat says, of one return a firing or
/// of two (the last and the strongest, which are one point where they are the same).
class PacketDecoder {
 public:
  explicit PacketDecoder(PacketSensor sensor) : sensor_(std::move(sensor)) {}

  const PacketSensor& sensor() const { return sensor_; }
  std::uint32_t steps_per_turn() const;
  double column_s() const { return 1.0 / (sensor_.model.rotation_hz * sensor_.model.columns); }

  /// Whether a payload is of the size of a packet of the sensor.
  bool has_size(std::string_view payload) const {
    return payload.size() == sensor_.payload_bytes();
  }
  /// What speaks against a payload of that size being one: another sensor's.
  std::optional<std::string> objection(std::string_view payload) const;
  /// Whether a packet against which nothing speaks has two returns a firing.
  bool is_dual(std::string_view payload) const;
  /// The columns of a packet against which nothing speaks. Of a VLS-128 with two returns that is
  /// one, and the head is taken to turn as fast as the model's while it fires.
  std::vector<MeasuredColumn> columns(std::string_view payload) const;
  /// Whether anything came back in column `k` of it.
  bool has_returns(std::string_view payload, std::size_t k) const;
  /// Adds the returns of column `k`, with intensities from 0 to 255 (Ouster's reflectivity may be
  /// higher).
  void add_points(std::string_view payload, std::size_t k, const MeasuredColumn& column,
                  PacketPoints& points) const;

 private:
  /// What came back to a laser in column `k`, the nearest first: nothing, one or two.
  struct Returns {
    std::array<PacketReturn, 2> all;
    std::size_t count = 0;
  };
  Returns returns_at(std::string_view payload, std::size_t k, std::size_t laser) const;
  std::optional<std::string> velodyne_objection(std::string_view payload) const;
  std::optional<std::string> ouster_objection(std::string_view payload) const;
  std::vector<MeasuredColumn> velodyne_columns(std::string_view payload) const;
  std::vector<MeasuredColumn> ouster_columns(std::string_view payload) const;

  PacketSensor sensor_;
};

}  // namespace adasplats
