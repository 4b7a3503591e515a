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
#include "adasplats/splats/model/class_tables.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// What the consistent method made, with the attributes of the points of each disk's cell.
struct ConsistentSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;  ///< that most points of the cell have; empty without
  std::vector<float> intensities;      ///< mean over the cell's points; empty without
};

/// How many of each there are so far.
struct ConsistentCounts {
  std::size_t cells = 0;
  std::size_t seeds = 0;  ///< with a radius
  std::size_t rays = 0;   ///< measured ones; 0 before order_rays()
  std::size_t empty = 0;  ///< beams without return, likewise
  std::size_t disks = 0;  ///< chosen ones
};

/// The steps of the consistent method on one device; consistent_disks() calls them in their order.
/// Every implementation gives the same splats to the last bit.
class ConsistentSteps {
 public:
  virtual ~ConsistentSteps() = default;

  /// Takes the cloud, without the points of removed classes, in canonical order (of all points).
  /// `whole`: the cloud is a piece of a place of which this is known; nullptr: it is all. Gives the
  /// number of points kept.
  virtual std::size_t load(PointCloud cloud, const ClassTables& tables,
                           const GlobalContext* whole = nullptr) = 0;

  /// Points in cells.
  virtual void fuse(const ConsistentOptions& options) = 0;
  /// Of the cells that points were fused in, for GlobalContext::typical. May be called before
  /// fit_seeds() alone.
  virtual std::vector<CellSpacing> spacings(const ConsistentOptions& options) = 0;
  /// Splits cells where nothing is flat, fits planes, turns normals to the sensors, makes seeds.
  virtual void fit_seeds(const ConsistentOptions& options) = 0;
  /// What the measured rays say of where they started, by pieces of the place; needs known beams.
  /// Changes nothing.
  virtual std::vector<MovedEvidence> check_origins(const ConsistentOptions& options) = 0;
  /// Orders the measured rays; needs known beams. Those below come after it.
  virtual void order_rays(const ConsistentOptions& options) = 0;
  /// Shrinks and removes seeds that more rays contradict than confirm: one round.
  virtual void balance_seeds(int round, const ConsistentOptions& options) = 0;
  /// Grows every seed over its neighbours. `checked`: rays say where surfaces end.
  virtual void cover(bool checked, const ConsistentOptions& options) = 0;
  /// Chooses disks and limits those that hang over edges: one round.
  virtual void limit_overhangs(int round, const ConsistentOptions& options) = 0;
  /// Disks that the last round chose not stay at their seed's size.
  virtual void limit_unchosen() = 0;
  /// Chooses the disks of the model.
  virtual void choose() = 0;
  /// Moves chosen disks to where the rays say the surface is: one round.
  virtual void settle(const ConsistentOptions& options) = 0;
  /// Puts seeds back where rays fall between disks.
  virtual void fill_gaps(const ConsistentOptions& options) = 0;

  virtual ConsistentCounts counts() const = 0;

  /// The chosen disks with a radius, on the host. Of the other steps only measure_reflectances()
  /// may come after it.
  virtual ConsistentSplats take_splats() = 0;

  /// Of the splats that were taken; needs known beams. See ReflectancesOn.
  virtual Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                            const std::vector<float>& fallback,
                                            const ConsistentOptions& options) = 0;
};

std::unique_ptr<ConsistentSteps> make_cpu_consistent_steps(const Executor& executor);

}  // namespace adasplats
