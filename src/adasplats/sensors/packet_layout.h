// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace adasplats {

/// Which of the makers' UDP packets a sensor sends. Sources: the user manuals of the sensors, their
/// sections on packet structure; of Ouster the "Software User Manual", lidar data packet format.
enum class PacketFormat : std::uint8_t {
  vlp_16,         ///< VLP-16: two firing sequences of 16 lasers a block
  hdl_32e,        ///< HDL-32E: one of 32 lasers
  vlp_32c,        ///< VLP-32C: likewise, in steps of 4 mm
  hdl_64e,        ///< HDL-64E S2 and S3: a block of the upper lasers, one of the lower
  vls_128,        ///< VLS-128: four blocks of 32 lasers
  ouster_legacy,  ///< Ouster, profile LEGACY: 16 columns of 12 bytes a channel
  ouster_single,  ///< Ouster, profile RNG19_RFL8_SIG16_NIR16; read, not written
  ouster_dual,    ///< Ouster, profile RNG19_RFL8_SIG16_NIR16_DUAL; likewise, 16 bytes a channel
};
inline constexpr std::pair<std::string_view, PacketFormat> kPacketFormats[] = {
    {"vlp-16", PacketFormat::vlp_16},
    {"hdl-32e", PacketFormat::hdl_32e},
    {"vlp-32c", PacketFormat::vlp_32c},
    {"hdl-64e", PacketFormat::hdl_64e},
    {"vls-128", PacketFormat::vls_128},
    {"ouster-legacy", PacketFormat::ouster_legacy},
    {"ouster-rng19-rfl8-sig16-nir16", PacketFormat::ouster_single},
    {"ouster-rng19-rfl8-sig16-nir16-dual", PacketFormat::ouster_dual}};

constexpr bool is_ouster(PacketFormat format) { return format >= PacketFormat::ouster_legacy; }

/// How the beams of a sensor stand in its packets.
struct PacketLayout {
  PacketFormat format = PacketFormat::vlp_16;
  /// The maker's number of each beam, which is its place in a firing; one a beam, or empty: from
  /// the topmost.
  std::vector<std::uint32_t> laser_ids;
  /// What is to be added to a range of a packet, so that it counts from where the beam leaves, m;
  /// one a beam, or empty for zero. Velodyne: dist_correction of the unit's calibration.
  std::vector<double> range_offsets_m;
};

}  // namespace adasplats
