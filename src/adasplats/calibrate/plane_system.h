// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"

namespace adasplats {

/// The distance of one point from its plane, and how it depends on the unknowns: of the point's
/// scan (rotation and translation), of its laser (range and elevation), of the plane (offset and
/// two tilts).
struct PlaneResidual {
  static constexpr std::uint32_t kNoLaser = 0xffffffffU;

  double residual_m = 0, weight = 0;
  std::uint32_t scan = 0, laser = kNoLaser;
  std::array<double, 6> by_pose{};
  std::array<double, 2> by_laser{};
  std::array<double, 3> by_plane{};
};

/// A step of Gauss-Newton over poses and lasers. Each plane's own unknowns are eliminated as it is
/// added (Schur complement); what is left is never made as a matrix, since every plane couples all
/// scans that saw it, but solved by conjugate gradients: memory and time grow with the points and
/// not with the square of the scans.
class PlaneSystem {
 public:
  using PoseStep = std::array<double, 6>;
  using LaserStep = std::array<double, 2>;
  struct Step {
    std::vector<PoseStep> poses;
    std::vector<LaserStep> lasers;
  };
  /// Calls the given function with the residuals of plane number `plane`.
  using ResidualsOf = FunctionRef<void(std::size_t plane, std::vector<PlaneResidual>& residuals)>;

  PlaneSystem(std::size_t scans, std::size_t lasers, const Executor& executor);

  /// Sums up all planes. The same bits for every number of threads.
  void add_planes(std::size_t count, ResidualsOf residuals_of);
  /// The unknown is `value` as far as `weight` goes.
  void add_pose_prior(std::size_t scan, std::size_t unknown, double weight, double value);
  /// By `weight` and by `share` of what the points say of the unknown before anything is
  /// eliminated.
  void add_laser_prior(std::size_t laser, std::size_t unknown, double weight, double share,
                       double value);

  /// Until the residual has fallen to `tolerance` of the right side, or `most_iterations`.
  Step solve(double tolerance, int most_iterations) const;

 private:
  template <std::size_t N>
  struct Block {
    std::array<double, N * N> matrix{};
    std::array<double, N> right{};
  };
  /// How a plane's unknowns depend on those of one scan or laser, whitened: what is subtracted is
  /// the product of the transposed with itself.
  template <std::size_t N>
  struct Entry {
    std::uint32_t plane = 0, unknowns = 0;
    std::array<double, 3 * N> values{};
  };
  using Cross = std::array<double, 12>;  ///< of a scan (rows) and a laser (columns)
  struct Part;
  class PlaneSum;

  /// Entries of all planes, and for each scan or laser which are its own.
  template <std::size_t N>
  struct Entries {
    std::vector<Entry<N>> all;                ///< plane by plane
    std::vector<std::uint32_t> plane_begins;  ///< one more than planes
    std::vector<std::uint32_t> of_unknowns;   ///< indices into `all`
    std::vector<std::uint32_t> begins;        ///< into of_unknowns, one more than unknowns
  };
  template <std::size_t N>
  static void index(Entries<N>& entries, std::size_t unknowns);

  Step times(const Step& x) const;

  const Executor& executor_;
  std::size_t scans_, lasers_, planes_ = 0;
  std::vector<Block<6>> pose_blocks_;
  std::vector<Block<2>> laser_blocks_;
  std::vector<Cross> crosses_;  ///< by scan, then laser
  Entries<6> pose_entries_;
  Entries<2> laser_entries_;
  std::vector<std::array<double, 3>> plane_rights_;  ///< whitened
};

}  // namespace adasplats
