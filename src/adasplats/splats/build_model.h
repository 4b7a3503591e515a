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
  MethodOptions recipe;  ///< ours without options, else a method of the paper
  DynamicRemoval remove = DynamicRemoval::movable;
  /// Intensities become reflectances with the sensor's response, where points have known beams and
  /// intensities (ReflectancesOn); else they stay as measured.
  bool reflectances = true;
  /// Beams are taken to have started where they are said to, whatever the points say of it.
  bool trust_origins = false;
  /// The cloud is a piece of this place (method consistent alone), whose origins were checked;
  /// nullptr: it is all there is.
  const GlobalContext* whole = nullptr;
};

/// One step of the work and what it took.
struct StepTime {
  std::string name;
  double seconds;
};

struct BuildReport {
  std::size_t points_in = 0;
  std::size_t points_dynamic = 0;                       ///< removed by label
  std::vector<RemovedPoints::OfClass> removed_classes;  ///< these points by class
  std::size_t points_noise = 0;      ///< removed by denoising; consistent: beyond all cells
  std::size_t points_used = 0;       ///< that the (last) generation started from
  std::size_t points_resampled = 0;  ///< new points from resampling
  std::size_t primitives = 0;
  double radius_m = 0;                         ///< the paper's methods: R of the last generation
  double error_m = 0;                          ///< the paper's methods: E of the last generation
  std::optional<ConsistentReport> consistent;  ///< of that method
  bool ray_checked = false;           ///< consistent: splats were checked against measured rays
  bool reflectance_measured = false;  ///< enough rays show reflectances
  OriginCounts origins{};             ///< of the points, by OriginKind
  bool oriented = true;  ///< normals face the sensors; false: not all origins are known
  std::vector<StepTime> steps;
};

class ModelEngine;

/// Point cloud in, splat model out. The result depends on the set of points alone: not on their
/// order, the threads or the machine. Semantic needs `labels` and cloud.classes; dynamic removal
/// is skipped without them. `engine` does the steps (model_engine.h; nullptr: `executor`'s
/// threads); engines give the same bytes. Errors: data ("no points"; no labels for `semantic`; an
/// id that the scheme does not know; origin_objection()), usage (options out of range).
std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress,
                                               const ModelEngine* engine = nullptr);

}  // namespace adasplats
