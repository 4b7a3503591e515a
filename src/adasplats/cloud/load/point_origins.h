// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/poses/nearest_pose.h"

namespace adasplats {

/// The sensor position of a point, and how it is known.
struct PointOrigin {
  Vec3d world;
  OriginKind kind = OriginKind::none;
};

/// Finds the origins of points: from the scan or the file, else as stated by the options, else
/// guessed from the trajectory.
class PointOrigins {
 public:
  /// Reads the trajectory of the options, if given. Errors: those of read_trajectory.
  explicit PointOrigins(const LoadOptions& options);

  /// Whether any point of the part can have an origin.
  bool has_any(const CloudPart& part) const {
    return part.is_sequence || !part.world_sensors.empty() || viewpoint_ || nearest_;
  }
  /// The origin of point `i` of a part, which is at `world`.
  PointOrigin of(const CloudPart& part, std::size_t i, Vec3d world, const PartRun& run) const;

 private:
  std::optional<Vec3d> viewpoint_;
  Trajectory trajectory_;
  std::optional<NearestPose> nearest_;
};

/// Checks the origins of the points of one file (not of a sequence): all are within the range of
/// LiDARs, and few points are hidden behind others as seen from there (unless trust_origins).
/// Errors: data, or usage if the options gave the origin, with the figure.
void check_origins(const PointCloud& cloud, const std::filesystem::path& file,
                   const LoadOptions& options, const Executor& executor);

}  // namespace adasplats
