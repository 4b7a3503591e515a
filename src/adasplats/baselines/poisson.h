// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// The program that reconstructs.
enum class PoissonProvider : std::uint8_t {
  automatic,      ///< PoissonRecon if installed, else Open3D
  poisson_recon,  ///< its authors' programs PoissonRecon and SurfaceTrimmer, on PATH
  open3d,         ///< adasplats-poisson next to this program; it links Open3D
};

inline constexpr std::pair<std::string_view, PoissonProvider> kPoissonProviders[] = {
    {"auto", PoissonProvider::automatic},
    {"poissonrecon", PoissonProvider::poisson_recon},
    {"open3d", PoissonProvider::open3d}};
inline Words<PoissonProvider> words_of(PoissonProvider) { return kPoissonProviders; }

/// The fixed value of Open3D.
inline constexpr double kOpen3dSamplesPerNode = 1.5;

/// Screened Poisson reconstruction (Kazhdan and Hoppe 2013); the defaults are from the
/// paper's section on experiments. The boundary condition is always Neumann's.
struct PoissonOptions {
  int depth = 13;  ///< maximum depth of the octree
  /// Minimum number of points in a node; default 2, fixed at 1.5 for Open3D.
  std::optional<double> samples_per_node;
  /// Cut away parts with samples at a lower depth of the octree; default depth - 3, which gives the
  /// paper's 10 at its depth of 13.
  std::optional<double> trim;
  PoissonProvider provider = PoissonProvider::automatic;

  double trim_depth() const { return trim.value_or(depth - 3); }
};

template <class Visit>
void visit_settings(PoissonOptions& poisson, Visit&& visit) {
  constexpr const char* kGroup = "Screened Poisson";
  visit(Setting{.name = "depth",
                .help = "Maximum depth of the octree",
                .group = kGroup,
                .min = 1,
                .max = 16},
        poisson.depth);
  visit(Setting{.name = "samples_per_node",
                .help = "Minimum number of points in an octree node (default: 2; 1.5 with Open3D, "
                        "which allows no other)",
                .group = kGroup,
                .min = 0,
                .max = 1000,
                .exclusive_min = true},
        poisson.samples_per_node);
  visit(Setting{.name = "trim",
                .help = "Remove surface reconstructed at a smaller octree depth than this "
                        "(default: depth minus 3)",
                .group = kGroup},
        poisson.trim);
  visit(Setting{.name = "poisson_program",
                .help = "Reconstruction program (auto: PoissonRecon and SurfaceTrimmer if on PATH, "
                        "else Open3D through adasplats-poisson)",
                .group = kGroup},
        poisson.provider);
}

/// The programs to run.
struct PoissonPrograms {
  PoissonProvider provider = PoissonProvider::automatic;  ///< the one found, not automatic
  std::filesystem::path reconstruct;
  std::filesystem::path trim;  ///< empty: this library trims
};

/// Errors: unavailable, with the packages to install.
PoissonPrograms find_poisson_programs(PoissonProvider wanted);

struct PoissonSurface {
  TriangleMesh mesh;                    ///< without classes
  std::uint64_t peak_memory_bytes = 0;  ///< maximum over the programs
};

/// Reconstructs a surface from points with unit outward normals. Temporary files are in a hidden
/// folder in `folder`, which is always removed.
/// Errors: usage (options), data (no points; an empty surface after trimming), unavailable (a
/// program fails), cannot_create, io.
PoissonSurface poisson_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                               const PoissonOptions& options, const PoissonPrograms& programs,
                               const std::filesystem::path& folder, int threads,
                               ProgressSink& progress);

/// Private to baselines/. Runs a program, with its output in `log`; returns its peak memory in
/// bytes. OpenMP programs use `threads` threads, which sleep while they wait. The program is killed
/// if `progress` throws to cancel or if this process is killed. Errors: unavailable (it does not
/// start or fails; with the last line of its output).
std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress);

/// The part of a mesh where a value, linear between the vertices, is at least `min`; triangles
/// across the bound are cut along it. Like PoissonRecon's SurfaceTrimmer, except that small holes
/// and islands (0.1 % of the area) are not merged with their surroundings. Classes are dropped.
TriangleMesh trimmed(const TriangleMesh& mesh, std::span<const float> values, float min);

}  // namespace adasplats
