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

/// Time and azimuth of the head for one firing of all lasers.
struct MeasuredColumn {
  std::int64_t time_ns =
      0;                ///< by the sensor's clock, or since the full hour (PacketTraits::is_hourly)
  double head_rad = 0;  ///< counter-clockwise from +x, when the first laser fires
  double turn_rad_s = 0;      ///< angular velocity of the head, counter-clockwise
  std::uint32_t step = 0;     ///< of steps_per_turn() since the start of the revolution
  std::uint32_t frame = 0;    ///< with PacketTraits::has_frames
  bool is_valid = true;       ///< the column was measured
  std::int64_t lasts_ns = 0;  ///< until the next column; 0: column_s() of the decoder
};

/// Properties of a sensor's columns that depend on the manufacturer.
struct PacketTraits {
  bool is_hourly = false;   ///< times count from the full hour
  bool has_frames = false;  ///< columns have the number of their revolution or frame
  bool has_pauses = false;  ///< nothing is measured between frames
  bool has_cut = false;     ///< revolutions begin at step 0, else anywhere
};

/// The returns of one laser in one column, the nearest first: up to three.
struct LaserReturns {
  std::array<PacketReturn, 3> all;
  std::size_t count = 0;
};

/// Points in the sensor frame, in the order of firing.
struct PacketPoints {
  std::vector<Vec3d> positions;
  std::vector<double> late_s;  ///< since the start of their column
  std::vector<float> intensities;
  std::vector<std::uint16_t> rings;  ///< topmost 0
  /// As in LAS: the nearest return of a firing is 1 of return_counts.
  std::vector<std::uint8_t> return_numbers, return_counts;
};

class PacketParser;

/// Decodes the packets of one sensor, in any PacketFormat, with one return per firing or several
/// (one point if they are equal).
class PacketDecoder {
 public:
  explicit PacketDecoder(PacketSensor sensor);

  const PacketSensor& sensor() const { return sensor_; }
  std::uint32_t steps_per_turn() const;
  double column_s() const { return sensor_.column_s(); }
  const PacketTraits& traits() const { return traits_; }

  /// Whether a payload has the size of the sensor's packets (Hesai: begins like them).
  bool has_size(std::string_view payload) const;
  /// Why a payload of that size cannot be a packet of the sensor ("have an azimuth of ..."). The
  /// other functions require a payload without objection.
  std::optional<std::string> objection(std::string_view payload) const;
  /// How a packet contradicts the sensor's file, which is then of another device or mode ("have the
  /// serial number ...").
  std::optional<std::string> contradiction(std::string_view payload) const;
  /// Whether a payload is a packet of the sensor: size, no objection, no contradiction.
  bool accepts(std::string_view payload) const {
    return has_size(payload) && !objection(payload) && !contradiction(payload);
  }
  /// Whether a packet has more than one return per firing.
  bool is_dual(std::string_view payload) const;
  /// The columns of a packet. A packet of a VLS-128 with two returns has only one; its head is
  /// assumed to rotate at the model's rate.
  std::vector<MeasuredColumn> columns(std::string_view payload) const;
  /// Whether column `k` has a return.
  bool has_returns(std::string_view payload, std::size_t k) const;
  /// Adds the returns of column `k`, with intensities from 0 to 255 (Ouster's reflectivity can
  /// exceed 255).
  void add_points(std::string_view payload, std::size_t k, const MeasuredColumn& column,
                  PacketPoints& points) const;

 private:
  PacketSensor sensor_;
  const PacketParser* parser_;  ///< of the manufacturer; a static object
  PacketTraits traits_;
};

}  // namespace adasplats
