// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/poses/nearest_pose.h"

namespace adasplats {

/// Where the sensor was, and how that is known.
struct PointOrigin {
  Vec3d world;
  OriginKind kind = OriginKind::none;
};

/// Finds the origins of points: what the scan or the file says, else what the options state, else
/// what they let be guessed.
class PointOrigins {
 public:
  /// Reads the trajectory of the options, if there is one. Errors: those of read_trajectory.
  explicit PointOrigins(const LoadOptions& options);

  /// Whether any point of the part can have an origin.
  bool has_any(const CloudPart& part) const {
    return part.is_sequence || !part.world_sensors.empty() || viewpoint_ || nearest_;
  }
  /// Of point `i` of a part, which stands at `world`.
  PointOrigin of(const CloudPart& part, std::size_t i, Vec3d world, const PartRun& run) const;

 private:
  std::optional<Vec3d> viewpoint_;
  Trajectory trajectory_;
  std::optional<NearestPose> nearest_;
};

/// Checks the origins of the points of one file (not of a sequence): none is farther away than
/// LiDARs measure, and where all are the same place, that station sees its points (trust_origins).
/// Errors: data, or usage where the options state the origin or have it guessed, with the figure.
void check_origins(const PointCloud& cloud, const std::filesystem::path& file,
                   const LoadOptions& options, const Executor& executor);

}  // namespace adasplats
