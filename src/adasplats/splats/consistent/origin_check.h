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

// Checks the sensor positions. From the true positions rays pass through fewer seeds than from
// shifted ones; from wrong positions, shifted ones are as good or better. Numbers:
// docs/research/positions.md.

/// Shifts of all beam origins that the check tries: along x and y, in units of origin_unit_m(). Not
/// upward: rays from above pass through fewer seeds wherever the sensor was.
inline constexpr float kNearMove = 0.1F, kFarMove = 0.3F;
inline constexpr std::array<Vec3f, 8> kOriginMoves = {{{kNearMove, 0, 0},
                                                       {-kNearMove, 0, 0},
                                                       {0, kNearMove, 0},
                                                       {0, -kNearMove, 0},
                                                       {kFarMove, 0, 0},
                                                       {-kFarMove, 0, 0},
                                                       {0, kFarMove, 0},
                                                       {0, -kFarMove, 0}}};
inline constexpr std::size_t kNearMoves = 4;  ///< the first of these

/// Counts of seeds that rays cross.
struct CrossedSeeds {
  std::uint64_t crossed = 0;       ///< seeds that any ray ends at or passes through
  std::uint64_t contradicted = 0;  ///< those that more rays pass through than end at

  ADASPLATS_HD CrossedSeeds& operator+=(const CrossedSeeds& other) {
    crossed += other.crossed;
    contradicted += other.contradicted;
    return *this;
  }
};

/// The seeds of one part of the scene, counted with the given sensor positions and with shifted
/// ones.
struct MovedEvidence {
  CrossedSeeds given;
  std::array<CrossedSeeds, kOriginMoves.size()> moved{};

  MovedEvidence& operator+=(const MovedEvidence& other);
};

/// How well the sensor positions explain the points.
struct OriginCheck {
  std::uint64_t seeds = 0;         ///< checked seeds that any ray crosses
  std::uint64_t contradicted = 0;  ///< those that rays pass through
  /// `contradicted` from the best near (far) shift divided by `contradicted`; the best shift may
  /// differ between parts of the scene. Above 1 for correct positions. 0: too few contradicted
  /// seeds.
  double near_rise = 0, far_rise = 0;

  double share() const;  ///< of seeds, 0..1
};

/// Evaluates parts that are neighbours in their order. Parts with too few contradicted seeds are
/// joined with the next ones.
OriginCheck origin_check(std::span<const MovedEvidence> scene_parts);

/// Error text if the sensor positions cannot be correct; else empty.
std::string origin_objection(const OriginCheck& check);
/// Warning text if they are possible but unlikely; else empty.
std::string origin_doubt(const OriginCheck& check);

/// A sample of beams large enough for the check, independent of the order of points, without points
/// whose class is flagged in `removed` (65,536 flags or none): positions and sensor positions only.
/// `all`: number of points of the scene, of which the cloud may be a part.
PointCloud sample_beams(const PointCloud& cloud, std::span<const std::uint8_t> removed,
                        std::size_t all);
/// Median length of the beams, m; at least 10, since shifts of less than a metre have little effect
/// (see origin_evidence()).
float origin_unit_m(const PointCloud& beams);

/// Counts rays only if they clearly end at a disk or pass through it: errors of poses, edges and
/// grazing beams are less than half a metre.
EvidenceOptions origin_evidence();

/// Number of parts, and maximum number of checked seeds.
inline constexpr std::size_t kOriginPieces = 16, kCheckedSeeds = 150'000;

}  // namespace adasplats
