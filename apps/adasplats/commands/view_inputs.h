// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/jobs/scene/city_scene.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/view/city_picker.h"
#include "adasplats/view/view_scene.h"
#include "cli/session.h"

namespace adasplats::app {

/// The inputs of a view, and the address of its page.
struct ViewJob {
  /// A splat model, a mesh, a world file, a point cloud, a sequence, or a folder with a model and a
  /// sequence in it.
  std::filesystem::path input;
  std::vector<std::filesystem::path> layers;        ///< other models, meshes and clouds
  std::vector<std::filesystem::path> clouds;        ///< points shown with the model
  std::vector<std::filesystem::path> errors;        ///< points with errors, written by `evaluate`
  std::vector<std::filesystem::path> sequences;     ///< recorded scans with poses
  std::vector<std::filesystem::path> trajectories;  ///< poses
  std::string labels;                               ///< argument of label_scheme_for
  std::string sensor = kDefaultSensor;              ///< of the library
  double mount_height_m = 1.8;  ///< of the sensor above the ground, without poses
  LoadOptions load;             ///< of clouds and sequences
  std::string cloud_option;     ///< a given option that applies to these only; empty: none
  bool sensor_is_asked = false;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  ///< 0: any free one
  std::string token;       ///< empty: a random one
  bool browser = true;     ///< opens it
};

/// The content of the page, and the model that it simulates in.
struct LoadedView {
  std::unique_ptr<ModelScene> model;   ///< null: a city, or points alone
  std::unique_ptr<CityScene> city;     ///< null: no city with tiles on disk
  std::unique_ptr<CityPicker> picker;  ///< null: no city
  ViewScene scene;                     ///< refers to these
};

/// Identifies the inputs and loads them. Errors: usage (a folder with several models or
/// nothing to show, a world file as a layer), those of loading.
LoadedView load_view(const ViewJob& job, Session& session);

}  // namespace adasplats::app
