// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"
#include "adasplats/splats/consistent/global_context.h"
#include "adasplats/splats/method_options.h"
#include "adasplats/splats/model/splat_model.h"

namespace adasplats {

struct BuildOptions {
  MethodOptions recipe;  ///< by default the consistent method
  DynamicRemoval remove = DynamicRemoval::movable;
  /// Convert intensities to reflectances with the sensor's response, if points have beams and
  /// intensities (ReflectancesOn); else keep them as measured.
  bool reflectances = true;
  /// Accept the sensor positions without a check.
  bool trust_origins = false;
  /// Facts about the city that the cloud is a tile of (method consistent only), whose sensor
  /// positions were checked; nullptr: the cloud is the whole scene.
  const GlobalContext* whole = nullptr;
};

/// Duration of one step.
struct StepTime {
  std::string name;
  double seconds;
};

struct BuildReport {
  std::size_t points_in = 0;
  std::size_t points_dynamic = 0;                       ///< removed by label
  std::vector<RemovedPoints::OfClass> removed_classes;  ///< those points, by class
  std::size_t points_noise = 0;  ///< removed by denoising; consistent: out of range of the cells
  std::size_t points_used = 0;   ///< input of the (last) generation
  std::size_t points_resampled = 0;  ///< new points from resampling
  std::size_t primitives = 0;
  double radius_m = 0;                         ///< the paper's methods: R of the last generation
  double error_m = 0;                          ///< the paper's methods: E of the last generation
  std::optional<ConsistentReport> consistent;  ///< of the consistent method
  bool ray_checked = false;           ///< consistent: splats were checked against measured rays
  bool reflectance_measured = false;  ///< enough rays to measure reflectances
  bool drop_measured = false;         ///< lost beams were found, so splats have log odds of them
  OriginCounts origins{};             ///< of the points, by OriginKind
  bool oriented = true;  ///< normals face the sensors; false: some sensor positions are unknown
  std::vector<StepTime> steps;
};

class ModelEngine;

/// Builds a splat model from a point cloud. The result depends only on the set of points, not on
/// their order, the threads or the machine. The semantic method needs `labels` and cloud.classes;
/// without them dynamic objects are not removed. `engine` runs the steps (model_engine.h; nullptr:
/// on the threads of `executor`); all engines give the same bytes. Errors: data (no points; no
/// labels for `semantic`; an id that the scheme lacks; origin_objection()), usage (options out of
/// range).
std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress,
                                               const ModelEngine* engine = nullptr);

}  // namespace adasplats
