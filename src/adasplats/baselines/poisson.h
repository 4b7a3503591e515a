// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "adasplats/core/progress.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// Which program reconstructs.
enum class PoissonProvider : std::uint8_t {
  automatic,      ///< PoissonRecon where it is, else Open3D
  poisson_recon,  ///< its authors' programs PoissonRecon and SurfaceTrimmer, on PATH
  open3d,         ///< adasplats-poisson beside this program, which links Open3D
};

/// Open3D's, which cannot be changed.
inline constexpr double kOpen3dSamplesPerNode = 1.5;

/// Screened Poisson reconstruction (Kazhdan and Hoppe 2013); defaults are those of the paper's
/// section on experiments. The boundary is always Neumann's.
struct PoissonOptions {
  int depth = 13;               ///< of the octree, at most
  double samples_per_node = 2;  ///< for PoissonRecon
  /// Parts whose samples lie at a lesser depth of the octree are cut away; without it depth - 3,
  /// which is the paper's 10 at its depth of 13.
  std::optional<double> trim;
  PoissonProvider provider = PoissonProvider::automatic;

  double trim_depth() const { return trim.value_or(depth - 3); }
};

/// The programs that do the work.
struct PoissonPrograms {
  PoissonProvider provider = PoissonProvider::automatic;  ///< what was found, not automatic
  std::filesystem::path reconstruct;
  std::filesystem::path trim;  ///< empty: trimmed here
};

/// Errors: unavailable, with what to install.
PoissonPrograms find_poisson_programs(PoissonProvider wanted);

struct PoissonSurface {
  TriangleMesh mesh;                    ///< without classes
  std::uint64_t peak_memory_bytes = 0;  ///< the largest of the programs
};

/// Reconstructs from points and as many unit outward normals. Temporary files lie in a hidden
/// folder of `folder`, which goes in any case.
/// Errors: usage (options), data (no points; nothing is left after trimming), unavailable (a
/// program fails), cannot_create, io.
PoissonSurface poisson_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                               const PoissonOptions& options, const PoissonPrograms& programs,
                               const std::filesystem::path& folder, int threads,
                               ProgressSink& progress);

}  // namespace adasplats
