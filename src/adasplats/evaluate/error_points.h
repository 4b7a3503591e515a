// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/evaluate/resimulate.h"

namespace adasplats {

/// Points with the error that an evaluation found at each.
struct ErrorPoints {
  PointCloud cloud;             ///< positions, and classes and intensities if available
  std::vector<float> errors_m;  ///< one per point; NaN: none (a beam without hit)
  /// The primitive that each beam hit; Hit::kNone: nothing. May be empty.
  std::vector<std::uint32_t> primitives;
  std::size_t primitive_count = 0;  ///< of the model, if `primitives` are given
  std::size_t dropped = 0;  ///< points of the file that are not finite or far from all others
};

/// The simulated points with their distances to the nearest original point, which C2C is the mean
/// of. Errors: those of distances_to.
ErrorPoints distance_points(PointCloud simulated, const PointCloud& original,
                            const Executor& executor);

/// The measured points of all scans, in world coordinates, with predicted minus measured range.
/// `scans`: single beams kept by resimulate(); `trajectory`: the pose that each scan was cast with;
/// `primitive_count`: of the model. Throws std::logic_error if there are not as many poses as
/// scans.
ErrorPoints beam_points(std::vector<ScanErrors> scans, const Trajectory& trajectory,
                        std::size_t primitive_count);

/// Writes a PLY: x y z error_m [intensity] [label] [splat] (x y z as doubles if the origin is not
/// zero; splat: the primitive, -1 for none; a comment gives the number of primitives). load_cloud
/// can read it, too. Atomic. Throws std::logic_error if an attribute has another size than the
/// points.
void write_error_points(const std::filesystem::path& path, const ErrorPoints& points);

/// Whether a file is a PLY of points with errors, by its name and header. Errors: those of read_ply
/// for headers.
bool has_error_points(const std::filesystem::path& path);

/// Reads any file of points with x, y, z and error_m (or CloudCompare's scalar_error_m and
/// scalar_C2C_absolute_distances), and optionally intensity, label or class, and splat. Drops and
/// counts points that are not finite or farther than 100 km from the median of all; errors that are
/// not finite become NaN. Of classes the low 16 bits count. Memory: the reader's, and 48 bytes per
/// point. Errors: those of read_points; data (a missing column; a class that is not a whole number
/// from 0 to 2^32 - 1).
ErrorPoints read_error_points(const std::filesystem::path& path);

/// Whether a file of errors contains the splat that each beam hit. Distances of clouds and files of
/// other programs do not.
inline bool has_splat_hits(const ErrorPoints& points) { return !points.primitives.empty(); }

/// The mean error of each splat of a model over the beams that hit it.
class SplatErrors {
 public:
  explicit SplatErrors(std::size_t splats) : sums_m_(splats, 0), counts_(splats, 0) {}

  /// Adds the beams of a file, with errors clamped to half a metre. `path`: for messages. Errors:
  /// data (no splats, or splats of another model); then nothing is added.
  void add(const ErrorPoints& points, const std::filesystem::path& path);

  /// One per splat, m, negative: early; NaN if no beam hit it.
  std::vector<float> means_m() const;

 private:
  std::vector<double> sums_m_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace adasplats
