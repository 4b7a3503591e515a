// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// Unknowns of a laser: range, elevation, azimuth.
inline constexpr std::size_t kLaserUnknowns = 3;

/// Normal equations of the unknowns of one scan (N = 6: rotation and translation) or laser (N =
/// kLaserUnknowns). Row-major matrices.
template <std::size_t N>
struct UnknownsBlock {
  double full[N * N]{};     ///< with fixed planes
  double reduced[N * N]{};  ///< with the planes eliminated
  double right[N]{};        ///< with the planes eliminated
};
using PoseBlock = UnknownsBlock<6>;
using LaserBlock = UnknownsBlock<kLaserUnknowns>;

struct PlaneBlocks {
  std::vector<PoseBlock> poses;
  std::vector<LaserBlock> lasers;
};

/// A value for every unknown.
struct PlaneStep {
  std::vector<double> poses;   ///< six a scan
  std::vector<double> lasers;  ///< kLaserUnknowns a laser
};

/// A Gauss-Newton step over poses and lasers. The unknowns of each plane are eliminated (Schur
/// complement). Every plane couples all scans that saw it, so the remaining matrix is never stored;
/// conjugate gradients solve it. Memory and time grow with the number of points, not with the
/// square of the number of scans.
class PlaneSystem {
 public:
  /// The product of a step with the matrix without the `full` blocks.
  using PlaneProduct = FunctionRef<PlaneStep(const PlaneStep& x)>;

  explicit PlaneSystem(PlaneBlocks blocks) : blocks_(std::move(blocks)) {}

  /// Adds the prior `value` with `weight`.
  void add_pose_prior(std::size_t scan, std::size_t unknown, double weight, double value);
  /// Adds a prior with `weight` plus `share` of the unknown's diagonal before elimination.
  void add_laser_prior(std::size_t laser, std::size_t unknown, double weight, double share,
                       double value);

  /// Pulls the ranges of all lasers to their common mean, which stays free, with `share` of each
  /// one's diagonal. `ranges_m`: their present values.
  void pull_ranges_to_mean(double share, const std::vector<double>& ranges_m);

  /// Iterates until the residual is below `tolerance` times the right-hand side, at most
  /// `max_iterations` times.
  PlaneStep solve(double tolerance, int max_iterations, PlaneProduct coupled) const;

 private:
  double pulled_mean(const std::vector<double>& values, std::size_t stride) const;

  PlaneBlocks blocks_;
  std::vector<double> pulls_;  ///< weights of the ranges' distances from their mean; empty: none
};

}  // namespace adasplats
