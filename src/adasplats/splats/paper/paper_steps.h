// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/model/class_tables.h"
#include "adasplats/splats/paper/generation.h"

namespace adasplats {

/// What a generation made, with the attributes of the seed points.
struct PaperSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;  ///< one a splat; empty without
  std::vector<SemanticGroup> groups;   ///< one a splat; empty for basic splats
  std::vector<float> intensities;      ///< one a splat; empty without
  double radius_m = 0;                 ///< R
  double error_m = 0;                  ///< E
};

/// The steps of the paper's methods on one device. build_model calls them in their order; between
/// two steps the cloud is where the steps are made (host or GPU memory). Every implementation gives
/// the same cloud and splats to the last bit.
class PaperSteps {
 public:
  virtual ~PaperSteps() = default;

  /// Takes the cloud, without the points of removed classes, in canonical order (of all points).
  /// With `tables.groups` every point has the group of its class. Gives the number of points kept.
  virtual std::size_t load(PointCloud cloud, const ClassTables& tables) = 0;

  /// Paper section "Splat-Based Resampling and Denoising", first paragraph. Gives the number of
  /// points kept.
  virtual std::size_t denoise(const PaperOptions& options) = 0;

  /// One generation of splats from the cloud as it is; gives their number. Calls `step` as
  /// generate_splats() does.
  virtual std::size_t generate(const PaperOptions& options, StepSink step) = 0;

  /// What the cloud became: its size and how many of its points are new.
  struct Resampled {
    std::size_t points = 0;
    std::size_t new_points = 0;
  };
  /// Replaces the cloud by the one for the second generation, in canonical order.
  virtual Resampled resample(const PaperOptions& options) = 0;

  /// The splats of the last generation, on the host.
  virtual PaperSplats take_splats() = 0;
};

std::unique_ptr<PaperSteps> make_cpu_paper_steps(const Executor& executor);

}  // namespace adasplats
