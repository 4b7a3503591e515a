// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace adasplats {

/// Format of a sensor's UDP packets. Sources: the sections on packet structure in the sensors' user
/// manuals; for Ouster "Software User Manual", lidar data packet format.
enum class PacketFormat : std::uint8_t {
  vlp_16,         ///< VLP-16: two firing sequences of 16 lasers per block
  hdl_32e,        ///< HDL-32E: one firing sequence of 32 lasers per block
  vlp_32c,        ///< VLP-32C: the same, in steps of 4 mm
  hdl_64e,        ///< HDL-64E S2 and S3: one block for the upper lasers, one for the lower
  vls_128,        ///< VLS-128: four blocks of 32 lasers
  ouster_legacy,  ///< Ouster, profile LEGACY: 16 columns, 12 bytes per channel
  ouster_single,  ///< Ouster, profile RNG19_RFL8_SIG16_NIR16; read only
  ouster_dual,    ///< Ouster, profile RNG19_RFL8_SIG16_NIR16_DUAL: 16 bytes per channel; read only
  ouster_low,     ///< Ouster, profile RNG15_RFL8_NIR8: 4 bytes per channel, in steps of 8 mm; read
                  ///< only
  ouster_low_dual,  ///< Ouster, profile RNG15_RFL8_NIR8_DUAL: 8 bytes per channel; read only
  pandar_40p,       ///< Hesai, from here on: hesai_parser.cpp; read only
  pandar_64,
  pandar_qt,  ///< PandarQT, 64 channels
  xt_16,
  xt_32,
  xt_32m,  ///< XT32M2X
  qt_128,  ///< QT128C2X
  ot_128,
  at_128,  ///< AT128: angles depend on the mirror's azimuth (MirrorAngles)
};
inline constexpr std::pair<std::string_view, PacketFormat> kPacketFormats[] = {
    {"vlp-16", PacketFormat::vlp_16},
    {"hdl-32e", PacketFormat::hdl_32e},
    {"vlp-32c", PacketFormat::vlp_32c},
    {"hdl-64e", PacketFormat::hdl_64e},
    {"vls-128", PacketFormat::vls_128},
    {"ouster-legacy", PacketFormat::ouster_legacy},
    {"ouster-rng19-rfl8-sig16-nir16", PacketFormat::ouster_single},
    {"ouster-rng19-rfl8-sig16-nir16-dual", PacketFormat::ouster_dual},
    {"ouster-rng15-rfl8-nir8", PacketFormat::ouster_low},
    {"ouster-rng15-rfl8-nir8-dual", PacketFormat::ouster_low_dual},
    {"pandar40p", PacketFormat::pandar_40p},
    {"pandar64", PacketFormat::pandar_64},
    {"pandarqt", PacketFormat::pandar_qt},
    {"xt16", PacketFormat::xt_16},
    {"xt32", PacketFormat::xt_32},
    {"xt32m", PacketFormat::xt_32m},
    {"qt128", PacketFormat::qt_128},
    {"ot128", PacketFormat::ot_128},
    {"at128", PacketFormat::at_128}};

constexpr bool is_ouster(PacketFormat format) {
  return format >= PacketFormat::ouster_legacy && format <= PacketFormat::ouster_low_dual;
}
constexpr bool is_hesai(PacketFormat format) { return format >= PacketFormat::pandar_40p; }

/// Angles of a sensor with a rotating mirror (Hesai AT128), degrees. While the encoder is between
/// frame_starts[f] and frame_ends[f], facet f deflects the beams (manual, "Angle Correction").
struct MirrorAngles {
  std::vector<double> frame_starts, frame_ends;
  std::vector<double> azimuths, elevations;  ///< one a laser
  /// Corrections every 2 degrees of the encoder, 180 a laser.
  std::vector<float> azimuth_adjustments, elevation_adjustments;

  struct Angles {
    double azimuth = 0;  ///< clockwise from the sensor's +y
    double elevation = 0;
  };
  Angles at(std::size_t laser, std::size_t frame, double encoder) const;
  /// The frame that contains an encoder angle; the number of frames if none does.
  std::size_t frame_of(double encoder) const;
};

/// Positions of a sensor's beams in its packets.
struct PacketLayout {
  PacketFormat format = PacketFormat::vlp_16;
  /// The manufacturer's number of each beam, its position in a firing; one a beam, or empty: 0 is
  /// the topmost.
  std::vector<std::uint32_t> laser_ids;
  /// Positions of a firing if they are more than the beams; else 0.
  std::size_t lasers = 0;
  /// Added to a packet's range, which then starts at the origin of the beam, m; one a beam, or
  /// empty for zero. Velodyne: dist_correction of the calibration.
  std::vector<double> range_offsets_m;
  // Of the metadata of an Ouster:
  std::size_t columns = 0;       ///< per packet; 0: as usual for the format
  bool has_safety_head = false;  ///< header type FUSA: frames are numbered with 32 bits
  std::uint64_t serial = 0;      ///< of the device, in every packet but LEGACY; 0: not given
  std::shared_ptr<const MirrorAngles> mirror;  ///< at_128 only
};

}  // namespace adasplats
