// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// How it is known where the LiDAR was when it measured a point, in the order of trust. A ray says
/// that a surface is at its end and that nothing is before it: a false one destroys good splats, so
/// only origins that somebody knew make rays.
enum class OriginKind : std::uint8_t {
  none = 0,      ///< not known; the sensor position is the point's own and means nothing
  guessed = 1,   ///< by a rule (the nearest pose of a trajectory): turns normals, is no evidence
  stated = 2,    ///< by the user, for a station; loading checks that it is possible
  measured = 3,  ///< in the file, or of the scan
};

/// Whether a normal can be turned towards such an origin.
ADASPLATS_HD constexpr bool is_known(OriginKind kind) { return kind != OriginKind::none; }

/// Whether the line from such an origin to the point is a beam: evidence of what is free.
ADASPLATS_HD constexpr bool is_beam(OriginKind kind) {
  return kind == OriginKind::stated || kind == OriginKind::measured;
}

}  // namespace adasplats
