// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/splats/paper/select.h"

namespace adasplats {

/// The paper's variants, and ours.
enum class SplatMethod : std::uint8_t {
  basic,        ///< section "Basic Splatting"
  descriptors,  ///< section "Adaptive Splatting Using Local Descriptors"
  semantic,     ///< section "Adaptive Splatting"
  consistent,   ///< consistent_model.h: agrees with the rays that were measured
};

/// Factors on K, R and E for one group of points.
struct GroupScale {
  double neighbors = 1;  ///< times K
  double radius = 1;     ///< times R
  double error = 1;      ///< times E
};

struct BuildOptions {
  SplatMethod method = SplatMethod::consistent;
  ConsistentOptions consistent;  ///< of that method, which uses `remove` of what follows

  int neighbors = 40;       ///< K, section "Basic Splatting"
  double alpha = 0.2;       ///< share of a splat's radius within which seeds are discarded
  double smoothness = 0.6;  ///< beta: least dot product of normals, section "Adaptive Splatting"
  std::optional<double> radius_m;  ///< R instead of the mean distance to the K-th neighbour
  std::optional<double> error_m;   ///< E instead of the mean point-to-plane distance

  /// Section "Adaptive Splatting": ground, surface, linear, non-surface.
  std::array<GroupScale, kSemanticGroups> semantic_scales = {
      {{3, 3, 3}, {1, 1, 1}, {0.33, 0.33, 0.33}, {0.25, 0.25, 0.25}}};
  /// Section "Local Descriptors": planar points (ground and surface) have 2; others as above.
  GroupScale planar_scale = {2, 2, 2};
  /// Normals from the group's own neighbourhood (else from the base neighbourhood).
  bool group_normals = true;
  /// The order of the greedy selection.
  SelectionOrder selection = SelectionOrder::most_discards_first;

  DynamicRemoval remove = DynamicRemoval::movable;
  bool denoise = true;         ///< section "Splat-Based Resampling and Denoising"
  double denoise_sigmas = 3;   ///< a neighbourhood votes against points farther than this
  double denoise_votes = 0.5;  ///< share of its neighbourhoods that removes a point
  bool resample = true;        ///< second generation; adaptive methods only, as in the paper
  /// Wanted density of splats, times its mean: a neighbourhood that has less makes new points, as
  /// many as it lacks, rounded a splat. Where it has more than two thirds, that is none.
  double resample_density = 1;
  /// What the second generation starts from, besides the new points. The paper's text says the
  /// points, its figures (fewer points and splats than before) say the splats' centers.
  enum class ResampleBase : std::uint8_t {
    points,   ///< all points
    centers,  ///< centers of all splats
    mixed,    ///< centers on ground and surface, points of thin things (linear, non-surface)
  } resample_base = ResampleBase::mixed;
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
  bool ray_checked = false;  ///< consistent: splats were checked against measured rays
  OriginCounts origins{};    ///< of the points, by OriginKind
  bool oriented = true;      ///< normals face the sensors; false: not all origins are known
  std::vector<StepTime> steps;
};

class ModelEngine;

/// Point cloud in, splat model out. The result depends on the set of points alone: not on their
/// order, the threads or the machine. Semantic needs `labels` and cloud.classes; dynamic removal
/// is skipped without them. `engine` does the steps (model_engine.h; nullptr: `executor`'s
/// threads); engines give the same bytes. Errors: data ("no points"; no labels for `semantic`; an
/// id that the scheme does not know), usage (options out of range).
std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress,
                                               const ModelEngine* engine = nullptr);

}  // namespace adasplats
