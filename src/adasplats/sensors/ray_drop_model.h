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
/// Beams lost at one range edge, at most.
inline constexpr std::uint32_t kMaxEdgeRun = 6;

/// Directions in which the sensor's own carrier is in the way: nothing comes back, or from too
/// near to be reported. No model of a place knows it.
struct BlockedSector {
  float elevation_rad = 0;      ///< of the beam that was measured
  float azimuth_begin_rad = 0;  ///< counter-clockwise from +x; -pi <= begin < end <= pi
  float azimuth_end_rad = 0;
};

/// How likely a real sensor reports nothing though its beam met something: directions that its
/// carrier blocks, and a logistic model of the others, both fitted to where real beams found
/// nothing (evaluate/echoes, evaluate/unit). drop_rules() applies it.
struct RayDropModel {
  /// Of 1, r, r^2, log(r), 1 - cos, (1 - cos)^2, log(reflectance), r * log(reflectance), with r in
  /// units of 10 m; see drop_features().
  std::array<double, kDropFeatures> weights = {};
  /// Stands for the reflectance where it is not known.
  double usual_reflectance = 0.3;
  /// Of range edges (edge_runs.h), the share at which k + 1 beams one after the other are lost;
  /// `weights` are of the other beams then. Empty: edges are as other places.
  std::vector<double> edge_runs;
  std::string fitted_to;  ///< sensor, recording: for the reader of the file
  /// By elevation, then azimuth.
  std::vector<BlockedSector> blocked;

  /// Whether the sector of the nearest blocked elevation, within 0.3 degrees, holds the direction
  /// (in the sensor's frame; zero: unknown, held by none).
  bool blocks(Vec3f direction) const;
};

/// The keys of a TOML file: fitted_to, usual_reflectance, weights, edge_runs, and [[blocked]] with
/// elevation_deg and azimuths_deg, a list of [begin, end]. `prefix` stands before the name of that
/// table ("drop." where the keys are a table of another file).
std::string ray_drop_toml(const RayDropModel& model, const std::string& prefix = "");

/// As a file of its own. Errors of reading: no_input, config with the line.
void save_ray_drop(const std::filesystem::path& path, const RayDropModel& model);
RayDropModel load_ray_drop(const std::filesystem::path& path);

}  // namespace adasplats
