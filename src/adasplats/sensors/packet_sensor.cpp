// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/packet_sensor.h"

#include <algorithm>
#include <numeric>

#include "adasplats/core/error.h"
#include "adasplats/core/words.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_bytes.h"
#include "adasplats/sensors/packet_parser.h"

namespace adasplats {
namespace {

constexpr std::size_t kOusterLasers[] = {16, 32, 64, 128};

/// "velodyne-vlp-16, ...": the sensors of the library with a supported packet format.
std::string sensors_with_packets() {
  std::string list;
  for (const std::string& name : lidar_model_names())
    if (load_lidar_model(name).packets) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Error not_packets(const LidarModel& model, const std::string& why) {
  return {ErrorKind::usage, "sensor '" + model.name + "': " + why +
                                "; sensors with packets: " + sensors_with_packets() +
                                ", or a sensor file with the keys packets and laser_ids"};
}

void check_beams(const LidarModel& model, PacketFormat format, std::size_t lasers) {
  const std::size_t beams = std::max(model.elevations_rad.size(), model.packets->lasers);
  const std::string name(word_of(format, kPacketFormats));
  // Lasers of some Hesai models skip columns.
  if ((!model.free_pattern.empty() && !is_hesai(format)) || model.rosette ||
      model.elevations_rad.empty())
    throw not_packets(
        model, "does not fire all its beams in every column, which packets " + name + " require");
  const bool fits = lasers != 0
                        ? beams == lasers
                        : std::ranges::find(kOusterLasers, beams) != std::end(kOusterLasers);
  if (!fits)
    throw not_packets(model, "has " + std::to_string(beams) + " beams, packets " + name + " hold " +
                                 (lasers != 0 ? std::to_string(lasers) : "16, 32, 64 or 128"));
  if (!is_ouster(format) && model.packets->laser_ids.empty())
    throw not_packets(model, "has no laser_ids, the positions of its beams in packets " + name);
  if (format == PacketFormat::at_128 && !model.packets->mirror)
    throw not_packets(model,
                      "lacks the angles of its mirror: give the sensor's correction file (.dat)");
  if (format == PacketFormat::ot_128 && model.firing_times_s.empty())
    throw not_packets(model, "has no firing times, which packets " + name + " require");
  if (!model.clockwise) throw not_packets(model, "rotates counter-clockwise");
}

}  // namespace

PacketFacts facts_of_packets(PacketFormat format) {
  constexpr std::uint32_t kSixteenBits = 65535;
  constexpr std::uint16_t kVelodynePort = 2368, kOusterPort = 7502, kHesaiPort = 2368;
  constexpr double kMillimetre_m = 0.001;  // packets state their unit as a multiple
  if (is_hesai(format)) return {hesai_lasers(format), kMillimetre_m, 65535 * 255, 0, kHesaiPort};
  switch (format) {
    case PacketFormat::vlp_16: return {16, 0.002, kSixteenBits, 24, kVelodynePort};
    case PacketFormat::hdl_32e: return {32, 0.002, kSixteenBits, 12, kVelodynePort};
    case PacketFormat::vlp_32c: return {32, 0.004, kSixteenBits, 12, kVelodynePort};
    case PacketFormat::hdl_64e: return {64, 0.002, kSixteenBits, 6, kVelodynePort};
    case PacketFormat::vls_128: return {128, 0.004, kSixteenBits, 3, kVelodynePort};
    case PacketFormat::ouster_legacy: return {0, 0.001, (1U << 20) - 1, 16, kOusterPort};
    case PacketFormat::ouster_low:
    case PacketFormat::ouster_low_dual: return {0, 0.008, (1U << 15) - 1, 16, kOusterPort};
    default: break;
  }
  return {0, 0.001, (1U << 19) - 1, 16, kOusterPort};
}

std::size_t PacketSensor::payload_bytes() const {
  if (is_hesai(format)) return hesai_payload_bytes(format);
  if (!is_ouster(format)) return kVelodyneBytes;
  return OusterBytes(format, lasers(), facts.columns, model.packets->has_safety_head).packet();
}

PacketSensor packet_sensor(const LidarModel& model) {
  if (!model.packets && !model.packet_profile.empty())
    throw Error(ErrorKind::usage, "sensor '" + model.name + "': its packets have the profile " +
                                      model.packet_profile +
                                      ", which is not supported; supported: " + ouster_profiles());
  if (!model.packets) throw not_packets(model, "its packet format is unknown");
  PacketSensor sensor{
      model.packets->format, facts_of_packets(model.packets->format), model, {}, {}, {}};
  if (model.packets->columns != 0) sensor.facts.columns = model.packets->columns;
  check_beams(model, sensor.format, sensor.facts.lasers);
  const std::size_t beams = model.elevations_rad.size();
  sensor.ring_of_laser.resize(std::max(beams, model.packets->lasers), kNoRing);
  sensor.laser_of_ring.resize(beams);
  for (std::size_t ring = 0; ring < beams; ++ring) {
    const std::size_t laser =
        model.packets->laser_ids.empty() ? ring : model.packets->laser_ids[ring];
    sensor.laser_of_ring[ring] = static_cast<std::uint16_t>(laser);
    sensor.ring_of_laser.at(laser) = static_cast<std::uint16_t>(ring);
  }
  sensor.range_offsets_m = model.packets->range_offsets_m;
  if (sensor.range_offsets_m.empty()) {
    sensor.range_offsets_m.assign(beams, 0.0);
    if (is_ouster(sensor.format) && !model.beam_origins_m.empty())
      std::ranges::transform(model.beam_origins_m, sensor.range_offsets_m.begin(),
                             [](const Vec3d& origin) { return -origin.x; });
  }
  // Hesai's blocks begin with the first shot; firing times of files begin anywhere.
  std::vector<double>& times_s = sensor.model.firing_times_s;
  if (is_hesai(sensor.format) && !times_s.empty()) {
    const double first_s = std::ranges::min(times_s);
    for (double& time_s : times_s) time_s -= first_s;
  }
  return sensor;
}

}  // namespace adasplats
