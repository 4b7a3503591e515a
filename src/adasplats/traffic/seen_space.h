// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// What a scan saw at a place.
enum class Seen : std::uint8_t {
  unknown,   ///< no beams nearby, or they ended before it
  free,      ///< the beams around it passed it
  occupied,  ///< a beam ended there
};

struct SeenSpaceOptions {
  double margin_m = 0.5;  ///< a beam that ended so far behind a place passed it
  double reach_deg = 2;   ///< of beams from the direction of the place; further ones are ignored
};

/// The beams of one scan by direction, which show where space was free at that time.
class SeenSpace {
 public:
  SeenSpace(const KittiSequence& drive, std::size_t index, const KittiScan& scan,
            const SeenSpaceOptions& options);
  /// At a place in world coordinates, m.
  Seen at(Vec3d place) const;

 private:
  struct Beam {
    Vec3f origin, end;
  };
  struct Direction {
    float elevation, azimuth;  ///< tangent; rad
  };
  /// Sides of a direction.
  struct Side {
    bool above, left;
  };
  /// The columns around a direction, for all of its sides.
  class Columns;

  SeenSpaceOptions options_;
  RigidTransform sensor_from_world_;
  std::vector<std::uint32_t> starts_;  ///< of columns
  /// By column and elevation: what is searched is apart from what is read of few beams.
  std::vector<float> elevations_, azimuths_;
  std::vector<Beam> beams_;
};

}  // namespace adasplats
