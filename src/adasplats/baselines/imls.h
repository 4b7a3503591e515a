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
#include "adasplats/scene/scene.h"

namespace adasplats {

/// Parameters of the implicit function of IMLS; the defaults are from the paper's section on
/// experiments.
struct ImlsOptions {
  double voxel_m = 0.07;
  double sigma_voxels = 2;       ///< of the Gaussian weight, in voxels
  double truncation_voxels = 3;  ///< maximum distance from points; N_x are the points within it
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
                .help = "Maximum distance of voxels from a point, voxels",
                .key = "truncation_voxels",
                .group = kGroup,
                .min = 1,
                .max = 8},
        imls.truncation_voxels);
}

/// The IMLS function of oriented points in the voxels near them, block by block; the input of
/// imls_surface. Paper eq. IMLS with the weight exp(-d^2 / sigma^2):
///     IMLS(x) = sum_k n_k . (x - p_k) w_k(x)  /  sum_k w_k(x),  p_k within the truncation of x.
/// Voxel (i, j, k) is the point x = voxel_m * (i, j, k) in the cloud's local frame. Values
/// are the same bytes for every number of threads.
class ImlsField {
 public:
  static constexpr int kSide = 8;  ///< voxels along a block: those of an OpenVDB leaf

  struct Block {
    std::array<std::int32_t, 3> corner;  ///< lowest voxel, multiples of kSide
    /// m, positive on the side of the normals; index (x * 8 + y) * 8 + z from `corner`.
    std::array<float, kSide * kSide * kSide> values;
    /// Bit 8 y + z of word x: the voxel has a value.
    std::array<std::uint64_t, kSide> known;
  };

  /// `normals`: unit, one per point. Both spans must outlive the field.
  /// Errors: usage (options out of range, voxels too small for the extents).
  ImlsField(std::span<const Vec3f> points, std::span<const Vec3f> normals,
            const ImlsOptions& options, const Executor& executor);

  /// Number of blocks that may hold values.
  std::size_t size() const { return blocks_.size(); }
  /// Evaluates one block; thread-safe.
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
  std::vector<std::uint32_t> order_;   ///< points by block, in input order within a block
  std::vector<Run> runs_;              ///< the points of each block with points, by key
  std::vector<std::uint64_t> blocks_;  ///< keys of the blocks that may hold values, ascending
};

/// The surface of oriented points by Implicit Moving Least Squares, as in the paper's experiments:
/// values in voxels near points (ImlsField) in a sparse grid, zero surface by OpenVDB. The surface
/// ends with the values: a cell with a corner without a value has no faces. Faces are oriented like
/// the normals and have no classes. Extraction is dual contouring, not marching cubes: half as many
/// vertices in the same cells. The same bytes for every number of threads.
/// Errors: unavailable (built without OpenVDB), usage (options).
TriangleMesh imls_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                          const ImlsOptions& options, const Executor& executor);

}  // namespace adasplats
