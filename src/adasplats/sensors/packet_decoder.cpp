// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_decoder.h"

#include <utility>

#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_parser.h"

namespace adasplats {
namespace {

const PacketParser& parser_of(PacketFormat format) {
  if (is_hesai(format)) return hesai_parser();
  return is_ouster(format) ? ouster_parser() : velodyne_parser();
}

}  // namespace

void add_return(LaserReturns& returns, PacketReturn found) {
  if (found.counts == 0) return;
  for (std::size_t i = 0; i < returns.count; ++i)
    if (returns.all[i].counts == found.counts) return;
  std::size_t at = returns.count++;
  for (; at > 0 && found.counts < returns.all[at - 1].counts; --at)
    returns.all[at] = returns.all[at - 1];
  returns.all[at] = found;
}

LaserShot PacketParser::shot_at(const PacketSensor& sensor, std::string_view /*payload*/,
                                std::size_t /*k*/, const MeasuredColumn& column,
                                std::size_t laser) const {
  const LidarModel& model = sensor.model;
  const std::size_t ring = sensor.ring_of_laser[laser];
  const double late_s = model.firing_times_s.empty() ? 0.0 : model.firing_times_s[ring];
  return {firing_at(model, ring, column.head_rad + column.turn_rad_s * late_s), late_s};
}

PacketDecoder::PacketDecoder(PacketSensor sensor)
    : sensor_(std::move(sensor)),
      parser_(&parser_of(sensor_.format)),
      traits_(parser_->traits(sensor_)) {}

std::uint32_t PacketDecoder::steps_per_turn() const { return parser_->steps_per_turn(sensor_); }

bool PacketDecoder::has_size(std::string_view payload) const {
  return parser_->has_size(sensor_, payload);
}

std::optional<std::string> PacketDecoder::objection(std::string_view payload) const {
  return parser_->objection(sensor_, payload);
}

std::optional<std::string> PacketDecoder::contradiction(std::string_view payload) const {
  return parser_->contradiction(sensor_, payload);
}

bool PacketDecoder::is_dual(std::string_view payload) const {
  return parser_->is_dual(sensor_, payload);
}

std::vector<MeasuredColumn> PacketDecoder::columns(std::string_view payload) const {
  return parser_->columns(sensor_, payload);
}

bool PacketDecoder::has_returns(std::string_view payload, std::size_t k) const {
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser)
    if (sensor_.ring_of_laser[laser] != kNoRing &&
        parser_->returns_at(sensor_, payload, k, laser).count > 0)
      return true;
  return false;
}

void PacketDecoder::add_points(std::string_view payload, std::size_t k,
                               const MeasuredColumn& column, PacketPoints& points) const {
  for (std::size_t laser = 0; laser < sensor_.lasers(); ++laser) {
    const std::size_t ring = sensor_.ring_of_laser[laser];
    if (ring == kNoRing) continue;
    const LaserReturns returns = parser_->returns_at(sensor_, payload, k, laser);
    if (returns.count == 0) continue;
    const auto [firing, late_s] = parser_->shot_at(sensor_, payload, k, column, laser);
    for (std::size_t number = 0; number < returns.count; ++number) {
      const PacketReturn& found = returns.all[number];
      const double range_m = found.counts * sensor_.facts.quantum_m + sensor_.range_offsets_m[ring];
      points.positions.push_back(vec_cast<double>(firing.origin) +
                                 range_m * vec_cast<double>(firing.direction));
      points.late_s.push_back(late_s);
      points.intensities.push_back(found.intensity);
      points.rings.push_back(firing.ring);
      points.return_numbers.push_back(static_cast<std::uint8_t>(number + 1));
      points.return_counts.push_back(static_cast<std::uint8_t>(returns.count));
    }
  }
}

}  // namespace adasplats
