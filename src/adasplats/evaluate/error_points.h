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

/// Points and what an evaluation found wrong at each.
struct ErrorPoints {
  PointCloud cloud;             ///< positions, and classes and intensities where they are known
  std::vector<float> errors_m;  ///< one a point; NaN: not known (a beam that hit nothing)
  /// What each beam hit of the model; Hit::kNone: nothing. Empty where that is not known.
  std::vector<std::uint32_t> primitives;
  std::size_t primitive_count = 0;  ///< that the model had, where `primitives` are known
  std::size_t dropped = 0;  ///< points of the file that are not finite or far from all others
};

/// The simulated points with their distance to the nearest original one: what C2C is the mean of.
/// Errors: as distances_to.
ErrorPoints distance_points(PointCloud simulated, const PointCloud& original,
                            const Executor& executor);

/// The measured points of all scans, in world coordinates, with predicted minus measured range.
/// `scans`: what resimulate() kept of single beams; `trajectory`: one pose a scan, those that they
/// were cast with; `primitive_count`: of the model. Throws std::logic_error where there are not as
/// many poses as scans.
ErrorPoints beam_points(std::vector<ScanErrors> scans, const Trajectory& trajectory,
                        std::size_t primitive_count);

/// Writes a PLY: x y z error_m [intensity] [label] [splat] (x y z as doubles where the origin is
/// not zero; splat: the primitive, -1 for none; how many there were is a comment), which load_cloud
/// reads as a cloud, too. Atomic. Throws std::logic_error where an attribute has another size than
/// the points.
void write_error_points(const std::filesystem::path& path, const ErrorPoints& points);

/// Whether a file is a PLY whose points have errors, by its header alone. Errors: as read_ply's for
/// headers; a file that is no PLY by its name is none.
bool has_error_points(const std::filesystem::path& path);

/// Reads any file of points with x, y, z and error_m (or CloudCompare's scalar_error_m and
/// scalar_C2C_absolute_distances), and where they are there intensity, label or class, and splat.
/// Drops and counts points that are not finite or farther than 100 km from the median of all;
/// errors that are not finite become NaN. Memory: the reader's, and 48 bytes a point. Errors: those
/// of read_points; data (a column is missing; a class that is no whole number from 0 to 2^32 - 1,
/// of which the low 16 bits count).
ErrorPoints read_error_points(const std::filesystem::path& path);

}  // namespace adasplats
