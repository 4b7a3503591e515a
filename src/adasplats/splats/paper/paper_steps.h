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
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/paper/generation.h"

namespace adasplats {

/// The splats of a generation, with the attributes of their seed points.
struct PaperSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;  ///< one per splat; empty without
  std::vector<SemanticGroup> groups;   ///< one per splat; empty for basic splats
  std::vector<float> intensities;      ///< one per splat; empty without
  double radius_m = 0;                 ///< R
  double error_m = 0;                  ///< E
};

/// The steps of the paper's methods on one device. build_model calls them in this order; the cloud
/// stays in the memory of the device. All implementations give the same cloud and splats to the
/// last bit.
class PaperSteps {
 public:
  virtual ~PaperSteps() = default;

  /// Loads the cloud in canonical order (of all points), without points of removed classes. With
  /// `tables.groups` every point gets the group of its class. Returns the number of points kept.
  virtual std::size_t load(const PointCloud& cloud, const ClassTables& tables) = 0;

  /// Paper section "Splat-Based Resampling and Denoising", first paragraph. Returns the
  /// number of points kept.
  virtual std::size_t denoise(const PaperOptions& options) = 0;

  /// Makes one generation of splats from the current cloud; returns their number. Calls `step` as
  /// generate_splats() does.
  virtual std::size_t generate(const PaperOptions& options, StepSink step) = 0;

  /// Size of the new cloud and its number of new points.
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
