// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "adasplats/cloud/point_cloud.h"
#include "adasplats/cloud/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/scene/scene.h"
#include "adasplats/simulate/scan.h"

namespace adasplats {

/// A rigid thing that moves through the street: triangles in its own frame and where it is when.
struct MovingObject {
  TriangleMesh mesh;                ///< own frame; classes are moving classes
  std::uint16_t instance = 0;
  Trajectory world_from_object;
};

/// The procedural street: exact geometry with SemanticKITTI classes. Metres, z up, the road along
/// +x, origin zero.
struct Street {
  TriangleMesh fixed;
  std::vector<std::uint16_t> instances;  ///< one a triangle of `fixed`; parked cars have ids
  std::vector<MovingObject> moving;
};

struct StreetOptions {
  std::uint64_t seed = 1;
  double length_m = 100;           ///< of the road
};

Street make_street(const StreetOptions& options);

/// How the street is scanned. Defaults are the embedded demo.
struct StreetScanOptions {
  std::uint64_t seed = 1;
  std::size_t points = 300'000;       ///< about as many points in the mapping cloud
  double range_noise_m = 0.01;        ///< standard deviation
  double pose_error_m = 0.01;         ///< standard deviation of each pass's offset
  double pose_error_rad = 0.0002;     ///< standard deviation of each pass's rotation
  int passes = 2;                     ///< drives along the street, there and back
  double speed_m_per_s = 8;
};

/// The two recordings of one street.
struct StreetRecording {
  PointCloud mapping;                 ///< HDL-32 pitched 45 degrees, as Paris-CARLA-3D
  Trajectory mapping_trajectory;      ///< true world_from_sensor of its revolutions
  Trajectory driving_trajectory;      ///< of the HDL-64 in AV configuration, as measured
};

/// Scans the street. `on_driving_scan` receives every HDL-64 scan (index, scan) in order as it is
/// made; the mapping cloud is returned.
StreetRecording scan_street(const Street& street, const StreetScanOptions& options,
                            const std::function<void(std::size_t, const Scan&)>& on_driving_scan,
                            const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
