// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"

namespace adasplats {

/// What the implicit function of IMLS is evaluated with; defaults are those of the paper's section
/// on experiments.
struct ImlsOptions {
  double voxel_m = 0.07;
  double sigma_voxels = 2;       ///< of the Gaussian weight, in voxels
  double truncation_voxels = 3;  ///< values only this near to a point; N_x are the points within
};

template <class Visit>
void visit_settings(ImlsOptions& imls, Visit&& visit) {
  constexpr const char* kGroup = "IMLS";
  visit(Setting{.name = "voxel",
                .help = "Voxel size, m",
                .key = "voxel_m",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        imls.voxel_m);
  visit(Setting{.name = "sigma",
                .help = "Standard deviation of the Gaussian weight, voxels",
                .key = "sigma_voxels",
                .group = kGroup,
                .min = 0,
                .max = 1000,
                .exclusive_min = true},
        imls.sigma_voxels);
  visit(Setting{.name = "truncation",
                .help = "Distance to the nearest point up to which voxels have values, voxels",
                .key = "truncation_voxels",
                .group = kGroup,
                .min = 1,
                .max = 8},
        imls.truncation_voxels);
}

/// What imls_surface is made from: the IMLS function of oriented points in the voxels near them,
/// block by block. Paper eq. IMLS with the weight exp(-d^2 / sigma^2):
///     IMLS(x) = sum_k n_k . (x - p_k) w_k(x)  /  sum_k w_k(x),  p_k within the truncation of x.
/// Voxel (i, j, k) stands for the point x = voxel_m * (i, j, k) of the cloud's local frame. Values
/// are the same bytes for every number of threads.
class ImlsField {
 public:
  static constexpr int kSide = 8;  ///< voxels along a block: those of an OpenVDB leaf

  struct Block {
    std::array<std::int32_t, 3> corner;  ///< lowest voxel, multiples of kSide
    /// In m, positive on the side that normals point to; index (x * 8 + y) * 8 + z from `corner`.
    std::array<float, kSide * kSide * kSide> values;
    /// Bit 8 y + z of word x: the voxel has a value.
    std::array<std::uint64_t, kSide> known;
  };

  /// Points and as many unit normals; both must outlive the field.
  /// Errors: usage (options out of range, voxels too small for the extents).
  ImlsField(std::span<const Vec3f> points, std::span<const Vec3f> normals,
            const ImlsOptions& options, const Executor& executor);

  /// Number of blocks that may hold values.
  std::size_t size() const { return blocks_.size(); }
  /// Evaluates one of them; may be called from several threads.
  Block block(std::size_t i) const;

 private:
  struct Run {
    std::uint64_t key;
    std::uint32_t begin, end;  ///< in `order_`
  };
  void find_blocks(const Executor& executor);
  Vec3d in_voxels(std::size_t point) const;

  std::span<const Vec3f> points_;
  std::span<const Vec3f> normals_;
  ImlsOptions options_;
  std::vector<std::uint32_t> order_;   ///< points by block, in the order given within one
  std::vector<Run> runs_;              ///< the points of each block that has some, by key
  std::vector<std::uint64_t> blocks_;  ///< keys of the blocks that may hold values, ascending
};

}  // namespace adasplats
