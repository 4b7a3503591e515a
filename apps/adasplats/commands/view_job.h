// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/sensors/lidar_model.h"
#include "cli/session.h"

namespace adasplats::app {

/// What is shown, and where.
struct ViewJob {
  /// A splat model, a mesh, a world file, a point cloud, a sequence, or a folder with a model and a
  /// sequence in it.
  std::filesystem::path input;
  std::vector<std::filesystem::path> layers;        ///< models, meshes and clouds beside it
  std::vector<std::filesystem::path> clouds;        ///< points beside the model
  std::vector<std::filesystem::path> errors;        ///< points with errors, of `evaluate`
  std::vector<std::filesystem::path> sequences;     ///< recorded scans and where they were taken
  std::vector<std::filesystem::path> trajectories;  ///< poses
  std::string labels;                               ///< as label_scheme_for takes it
  std::string sensor = kDefaultSensor;              ///< of the library
  double mount_height_m = 1.8;  ///< of the sensor above the ground, where no pose says
  LoadOptions load;             ///< of clouds and sequences
  std::string cloud_option;     ///< that was given and is for these alone; empty: none
  bool sensor_is_asked = false;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free one
  std::string token;       ///< empty: one nobody can guess
  bool browser = true;     ///< opens it
};

/// Serves until Ctrl-C. Errors: unavailable (no viewer in this build, port taken), those of
/// loading.
void run_view(const ViewJob& job, Session& session);

}  // namespace adasplats::app
