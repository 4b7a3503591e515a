// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/city/city_levels.h"
#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/levels/level_tree.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/splats/model/any_model.h"
#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "adasplats/view/city_picker.h"
#include "adasplats/view/mesh_tree.h"

namespace adasplats {

/// One layer of the page, relative to the view's origin.
struct ViewLayer {
  std::string name;
  bool is_splats = false;
  bool has_classes = false;      ///< other classes than 0
  bool has_intensities = false;  ///< different values
  bool has_errors = false;
  LevelTree tree;                ///< splats or points
  std::optional<MeshTree> mesh;  ///< triangles, instead of `tree`
  std::string part;  ///< part of the beams with errors (error_layers.h); empty: all, or no errors
  std::shared_ptr<const CityLevels> city = nullptr;  ///< a city on disk, instead of `tree`
};

/// The nodes of the tree of a layer of any kind.
std::span<const LevelNode> nodes_of(const ViewLayer& layer);
/// Errors: those of CityLevels::node_bytes().
std::string node_bytes(const ViewLayer& layer, std::size_t node);
std::size_t size_of(const ViewLayer& layer);
ByteRange intensity_range_of(const ViewLayer& layer);

/// A layer of a city on disk. The view must have the city's origin.
ViewLayer city_layer(std::string name, std::shared_ptr<const CityLevels> levels);

/// A layer of triangles.
ViewLayer mesh_layer(std::string name, const MeshModel& model, std::span<const float> intensities,
                     Vec3d origin);
/// A layer of splats or triangles.
ViewLayer model_layer(std::string name, const AnyModel& model, Vec3d origin,
                      const Executor& executor);

/// `errors_m`: empty, or one per splat.
ViewLayer splat_layer(std::string name, const SplatModel& model, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor);
/// `errors_m`: empty, or one per point.
ViewLayer point_layer(std::string name, const PointCloud& cloud, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor);

/// An object of a world file that is in all scans.
struct ViewObject {
  std::string name;
  std::size_t object = 0;    ///< index in the world
  std::size_t geometry = 0;  ///< index in ViewScene::geometries
};

/// Recorded scans, read on demand.
struct ViewSequence {
  std::string name;
  KittiSequence scans;
};

/// The scene that the page shows. Does not change while it is served.
struct ViewScene {
  std::string name;
  Vec3d origin;  ///< of the data sent to the page, world coordinates
  std::vector<ViewLayer> layers;
  std::vector<std::pair<std::string, Trajectory>>
      trajectories;  ///< other than those of `sequences`
  std::vector<ViewSequence> sequences;
  std::optional<LabelScheme> labels;
  std::pair<Vec3d, Vec3d> middle_box;  ///< world coordinates; initial view
  /// Scene for simulated scans; null: none.
  const ScanScene* place = nullptr;
  /// The same scene if it is in memory; pages may move its objects. Else null.
  ModelScene* model = nullptr;
  /// Casts picking rays if the scene is a city on disk; used only by the simulating thread.
  CityPicker* picker = nullptr;
  std::vector<ViewLayer> geometries;  ///< of objects, each in its own frame
  std::vector<ViewObject> objects;
  std::string sensor = kDefaultSensor;  ///< chosen at the start
  RigidTransform start_pose;            ///< of the sensor, world coordinates
  std::string device = "cpu";
  std::vector<std::string> command;  ///< start of the command that the page copies
};

/// Start pose of the driven sensor: the first pose of the scene, else `mount_height_m` above the
/// ground of a street in the first layer (street_pose.h), else above the surface in the middle.
RigidTransform start_pose_of(const ViewScene& scene, double mount_height_m,
                             const Executor& executor);

/// Adds the objects of the model's world that are in all scans, and their geometries.
void add_world(ViewScene& scene, const Executor& executor);

/// "scene.json".
std::string scene_json(const ViewScene& scene);

}  // namespace adasplats
