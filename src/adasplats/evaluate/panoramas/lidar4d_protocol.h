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

/// What LiDAR4D (Zheng et al., CVPR 2024) reports of held-out scans, but for LPIPS, which needs a
/// network of its own. Means over scans.
struct Lidar4dResult {
  PanoramaLayout layout;
  std::size_t scans = 0;
  ImageError depth;                     ///< m
  std::optional<ImageError> intensity;  ///< 0..1; nothing where model or scans have none
  /// What one is in the unit of the scans' intensities: 1, 255 or 65535, the least that none of
  /// them exceeds.
  double intensity_scale = 1;
  DropError drop;
  /// Of the points that the images stand for; scans of which the model predicts no point are left
  /// out, NaN where that is all of them.
  double chamfer_m2 = 0;  ///< sum of the means of squared distances
  /// As the code of LiDAR4D has it: it holds squared distances against 0.05, so within 22.4 cm.
  double f_score_224mm = 0;
  double f_score_5cm = 0;  ///< within 5 cm
};

/// Casts a ray for every pixel of each scan's range image, from where the scan's frame has its
/// origin, and compares with the image of the points that were measured, as they stand in the
/// file. A pixel is said to return where its ray hits. `attributes` are those of the scene.
/// Errors: data (a scan without points in the image), those of read_kitti_points.
Lidar4dResult evaluate_lidar4d(const Tracer& tracer, const PrimitiveAttributes& attributes,
                               Vec3d scene_origin, const KittiSequence& sequence,
                               const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
