// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

inline constexpr int kDropFeatures = 8;
/// Maximum number of beams lost at one range edge.
inline constexpr std::uint32_t kMaxEdgeRun = 6;

/// Directions that the sensor's own vehicle blocks: no return, or one that is too near to be
/// reported. No model of a scene contains the vehicle.
struct BlockedSector {
  float elevation_rad = 0;      ///< of the measured beam
  float azimuth_begin_rad = 0;  ///< counter-clockwise from +x; -pi <= begin < end <= pi
  float azimuth_end_rad = 0;
};

/// Probability that a real sensor reports no return although its beam hits a surface: directions
/// that its vehicle blocks, and a logistic model of the others. Both are fitted to beams without
/// return (evaluate/echoes, evaluate/unit). drop_rules() applies it.
struct RayDropModel {
  /// Of 1, r, r^2, log(r), 1 - cos, (1 - cos)^2, log(reflectance), r * log(reflectance), with r in
  /// units of 10 m; see drop_features().
  std::array<double, kDropFeatures> weights = {};
  /// Replaces an unknown reflectance.
  double usual_reflectance = 0.3;
  /// Share of range edges (edge_runs.h) at which k + 1 consecutive beams are lost; `weights` then
  /// describe the other beams only. Empty: edges are treated like any surface.
  std::vector<double> edge_runs;
  std::string fitted_to;  ///< sensor and recording, for the reader of the file
  /// By elevation, then azimuth.
  std::vector<BlockedSector> blocked;

  /// Whether a sector of the nearest blocked elevation, within 0.3 degrees, contains the direction
  /// (in the sensor's frame; zero means unknown and is in none).
  bool blocks(Vec3f direction) const;
};

/// The keys of a TOML file: fitted_to, usual_reflectance, weights, edge_runs, and [[blocked]] with
/// elevation_deg and azimuths_deg, a list of [begin, end]. `prefix` precedes the name of that table
/// ("drop." if the keys are a table of another file).
std::string ray_drop_toml(const RayDropModel& model, const std::string& prefix = "");

/// A file with only these keys. Errors of reading: no_input, config with the line.
void save_ray_drop(const std::filesystem::path& path, const RayDropModel& model);
RayDropModel load_ray_drop(const std::filesystem::path& path);

}  // namespace adasplats
