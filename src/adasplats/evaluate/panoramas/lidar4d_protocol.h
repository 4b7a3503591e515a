// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/evaluate/panoramas/image_error.h"
#include "adasplats/evaluate/panoramas/panorama.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// The metrics of LiDAR4D (Zheng et al., CVPR 2024) for held-out scans, without LPIPS, which needs
/// a network. Means over scans.
struct Lidar4dResult {
  PanoramaLayout layout;
  std::size_t scans = 0;
  ImageError depth;                     ///< m
  std::optional<ImageError> intensity;  ///< 0..1; nothing if model or scans have none
  /// Full scale of the scans' intensities: the smallest of 1, 255 and 65535 that none exceeds.
  double intensity_scale = 1;
  DropError drop;
  /// Of the points of the images. Scans without a predicted point are left out; NaN if all are.
  double chamfer_m2 = 0;  ///< sum of the means of squared distances
  /// As in the code of LiDAR4D: squared distances below 0.05 m2, so within 22.4 cm.
  double f_score_224mm = 0;
  double f_score_5cm = 0;  ///< within 5 cm
};

/// Casts a ray for every pixel of each scan's range image, from the origin of the scan's frame, and
/// compares the result with the image of the measured points as in the file. A pixel has a
/// predicted return if its ray hits. `attributes` are those of the scene. Errors: data (a scan
/// without points in the image), those of read_kitti_points.
Lidar4dResult evaluate_lidar4d(const Tracer& tracer, const PrimitiveAttributes& attributes,
                               Vec3d scene_origin, const KittiSequence& sequence,
                               const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
