// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "adasplats/core/function_ref.h"

namespace adasplats {

/// What the planes say of the unknowns of one scan (N = 6: rotation and translation) or laser (N =
/// 2: range and elevation). Matrices by rows.
template <std::size_t N>
struct UnknownsBlock {
  double full[N * N]{};     ///< were the planes known
  double reduced[N * N]{};  ///< with planes that follow
  double right[N]{};        ///< with planes that follow
};
using PoseBlock = UnknownsBlock<6>;
using LaserBlock = UnknownsBlock<2>;

struct PlaneBlocks {
  std::vector<PoseBlock> poses;
  std::vector<LaserBlock> lasers;
};

/// A value for every unknown.
struct PlaneStep {
  std::vector<double> poses;   ///< six a scan
  std::vector<double> lasers;  ///< two a laser
};

/// A step of Gauss-Newton over poses and lasers. Each plane's own unknowns are eliminated (Schur
/// complement); what is left is never made as a matrix, since every plane couples all scans that
/// saw it, but solved by conjugate gradients: memory and time grow with the points and not with the
/// square of the scans.
class PlaneSystem {
 public:
  /// The product of a step with all of the matrix but the blocks' `full`.
  using PlaneProduct = FunctionRef<PlaneStep(const PlaneStep& x)>;

  explicit PlaneSystem(PlaneBlocks blocks) : blocks_(std::move(blocks)) {}

  /// The unknown is `value` as far as `weight` goes.
  void add_pose_prior(std::size_t scan, std::size_t unknown, double weight, double value);
  /// By `weight` and by `share` of what the points say of the unknown before anything is
  /// eliminated.
  void add_laser_prior(std::size_t laser, std::size_t unknown, double weight, double share,
                       double value);

  /// Until the residual has fallen to `tolerance` of the right side, or `max_iterations`.
  PlaneStep solve(double tolerance, int max_iterations, PlaneProduct coupled) const;

 private:
  PlaneBlocks blocks_;
};

}  // namespace adasplats
