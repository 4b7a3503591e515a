// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/splats/rays/disk_evidence.h"

namespace adasplats {

// Whether beams started where they are said to. Of where the sensor really was, rays go through
// fewer seeds than of any place beside it; of a wrong place, others are as good or better. Numbers:
// docs/fidelity.md.

/// Where all beams are moved to, besides where they are said to have started: along x and y, in
/// units of origin_unit_m(). Not up: from above more is seen, so that rays from there go through
/// fewer seeds wherever the sensor was.
inline constexpr float kNearMove = 0.1F, kFarMove = 0.3F;
inline constexpr std::array<Vec3f, 8> kOriginMoves = {{{kNearMove, 0, 0},
                                                       {-kNearMove, 0, 0},
                                                       {0, kNearMove, 0},
                                                       {0, -kNearMove, 0},
                                                       {kFarMove, 0, 0},
                                                       {-kFarMove, 0, 0},
                                                       {0, kFarMove, 0},
                                                       {0, -kFarMove, 0}}};
inline constexpr std::size_t kNearMoves = 4;  ///< of these, the first

/// Seeds by what the rays that cross them say.
struct CrossedSeeds {
  std::uint64_t crossed = 0;       ///< that any ray ends at or goes through
  std::uint64_t contradicted = 0;  ///< of these, those that more rays go through than end at

  ADASPLATS_HD CrossedSeeds& operator+=(const CrossedSeeds& other) {
    crossed += other.crossed;
    contradicted += other.contradicted;
    return *this;
  }
};

/// The seeds of a piece of a place, by the rays as they are said to have started and by the same
/// rays moved.
struct MovedEvidence {
  CrossedSeeds given;
  std::array<CrossedSeeds, kOriginMoves.size()> moved{};

  MovedEvidence& operator+=(const MovedEvidence& other);
};

/// How well where beams are said to have started explains the points.
struct OriginCheck {
  std::uint64_t seeds = 0;         ///< that were looked at, which any ray crosses
  std::uint64_t contradicted = 0;  ///< of these, those that rays go through
  /// How many times as many they would be from the best of the places near by (and farther off),
  /// which may be another one in every part of the place; more than 1 of the right place. 0: too
  /// few are contradicted to tell.
  double near_rise = 0, far_rise = 0;

  double share() const;  ///< of seeds, 0..1
};

/// Of pieces that stand side by side in their order; each is a part of the place for itself if
/// enough of its seeds are contradicted, else with its neighbours.
OriginCheck origin_check(std::span<const MovedEvidence> pieces);

/// What makes it impossible that the beams started where they are said to; empty: nothing.
std::string origin_objection(const OriginCheck& check);
/// Why that is to be doubted, where it is possible; empty: no reason.
std::string origin_doubt(const OriginCheck& check);

/// Enough of the beams of a cloud to check where they started, whatever its order, without points
/// of classes that have a flag in `removed` (65,536 or none): positions and sensor positions alone.
/// `all`: how many points there are, of which the cloud may be a part.
PointCloud sample_beams(const PointCloud& cloud, std::span<const std::uint8_t> removed,
                        std::size_t all);
/// Median length of the beams, m; at least 10, as moves of less than a metre say little (see
/// origin_evidence()).
float origin_unit_m(const PointCloud& beams);

/// Rays end at a disk or go through it where there is no doubt: what poses, edges and grazing beams
/// get wrong is less than half a metre.
EvidenceOptions origin_evidence();

/// In so many pieces the seeds are counted that are looked at, at most so many.
inline constexpr std::size_t kOriginPieces = 16, kCheckedSeeds = 150'000;

}  // namespace adasplats
