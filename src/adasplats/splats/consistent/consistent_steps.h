// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/consistent/global_context.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// The result of the consistent method, with the attributes of the points in each disk's cell.
struct ConsistentSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;  ///< class of most points in the cell; empty without labels
  std::vector<float> intensities;      ///< mean over the cell's points; empty if they have none
  std::vector<float> opacities;        ///< of soft disks; empty: disks are opaque
};

/// Numbers of elements after the last step.
struct ConsistentCounts {
  std::size_t points = 0;  ///< loaded
  std::size_t cells = 0;
  std::size_t seeds = 0;  ///< with a radius
  std::size_t rays = 0;   ///< measured rays; 0 before order_rays()
  std::size_t empty = 0;  ///< beams without return; 0 before order_rays()
  std::size_t disks = 0;  ///< chosen disks
};

/// The steps of the consistent method on one device; consistent_disks() calls them in this order.
/// All implementations give the same splats to the last bit.
class ConsistentSteps {
 public:
  virtual ~ConsistentSteps() = default;

  /// Loads the cloud in canonical order (of all points), without points of removed classes.
  /// `whole`: facts about the scene that the cloud is a tile of; nullptr: the cloud is the whole
  /// scene. Returns the number of points kept.
  virtual std::size_t load(PointCloud cloud, const ClassTables& tables,
                           const GlobalContext* whole = nullptr) = 0;

  /// Averages the points of each cell.
  virtual void fuse(const ConsistentOptions& options) = 0;
  /// Spacing of every cell, for GlobalContext::typical. Only valid between fuse() and fit_seeds().
  virtual std::vector<CellSpacing> spacings(const ConsistentOptions& options) = 0;
  /// Splits cells where the surface is not flat, fits planes, orients normals, makes seeds.
  virtual void fit_seeds(const ConsistentOptions& options) = 0;
  /// Evidence for the sensor positions, for each part of the scene; needs beams. Changes nothing.
  virtual std::vector<MovedEvidence> check_origins(const ConsistentOptions& options) = 0;
  /// Sorts the measured rays; needs beams. The steps below must follow it.
  virtual void order_rays(const ConsistentOptions& options) = 0;
  /// Shrinks and removes seeds that more rays contradict than confirm: one round.
  virtual void balance_seeds(int round, const ConsistentOptions& options) = 0;
  /// Grows every seed over its neighbours. `checked`: rays show where surfaces end.
  virtual void cover(bool checked, const ConsistentOptions& options) = 0;
  /// Chooses disks and shrinks those that overhang edges: one round.
  virtual void limit_overhangs(int round, const ConsistentOptions& options) = 0;
  /// Limits the disks that the last round did not choose to the size of their seeds.
  virtual void limit_unchosen() = 0;
  /// Chooses the disks of the model.
  virtual void choose() = 0;
  /// Moves chosen disks to the surface that the rays show: one round.
  virtual void settle(const ConsistentOptions& options) = 0;
  /// Restores seeds where rays pass between disks.
  virtual void fill_gaps(const ConsistentOptions& options) = 0;
  /// Estimates opacities and radii of chosen disks from the rays that cross them: one round.
  virtual void refine_extents(int round, const ConsistentOptions& options) = 0;
  /// Makes chosen disks soft ones with the extents of refine_extents().
  virtual void soften(const ConsistentOptions& options) = 0;

  virtual ConsistentCounts counts() const = 0;
  /// Chosen disks whose centres were moved by the maximum and are not on the surface.
  virtual std::size_t count_limited() const = 0;
  /// TypicalSpacing::is_sparse() of the cloud or its city; valid after fit_seeds().
  virtual bool is_sparse() const = 0;

  /// The chosen disks, on the host. Only measure_reflectances() may follow.
  virtual ConsistentSplats take_splats() = 0;

  /// Reflectances of the splats of take_splats(); needs beams. See ReflectancesOn.
  virtual Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                            const std::vector<float>& fallback,
                                            const ConsistentOptions& options) = 0;
};

std::unique_ptr<ConsistentSteps> make_cpu_consistent_steps(const Executor& executor);

}  // namespace adasplats
