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

/// One layer of what the page draws, relative to the view's origin.
struct ViewLayer {
  std::string name;
  bool is_splats = false;
  bool has_classes = false;      ///< more than class 0
  bool has_intensities = false;  ///< not all the same
  bool has_errors = false;
  LevelTree tree;                ///< of splats or points
  std::optional<MeshTree> mesh;  ///< instead, for triangles
  std::string part;  ///< of the beams with errors (error_layers.h); empty: all, or no such layer
  std::shared_ptr<const CityLevels> city = nullptr;  ///< instead of all of these, for a city
};

/// The tree of a layer, whatever it is of.
std::span<const LevelNode> nodes_of(const ViewLayer& layer);
/// Errors: those of CityLevels::node_bytes().
std::string node_bytes(const ViewLayer& layer, std::size_t node);
std::size_t size_of(const ViewLayer& layer);
ByteRange intensity_range_of(const ViewLayer& layer);

/// A city that stays on disk; the view's origin must be the city's.
ViewLayer city_layer(std::string name, std::shared_ptr<const CityLevels> levels);

/// Triangles.
ViewLayer mesh_layer(std::string name, const MeshModel& model, std::span<const float> intensities,
                     Vec3d origin);
/// Splats or triangles.
ViewLayer place_layer(std::string name, const AnyModel& place, Vec3d origin,
                      const Executor& executor);

/// `errors_m`: empty, or one a splat.
ViewLayer splat_layer(std::string name, const SplatModel& model, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor);
/// `errors_m`: empty, or one a point.
ViewLayer point_layer(std::string name, const PointCloud& cloud, std::span<const float> errors_m,
                      Vec3d origin, const Executor& executor);

/// Something of a world file, in all scans.
struct ViewObject {
  std::string name;
  std::size_t object = 0;    ///< of the world
  std::size_t geometry = 0;  ///< of ViewScene::geometries
};

/// Recorded scans; they are read when the page asks for one.
struct ViewSequence {
  std::string name;
  KittiSequence scans;
};

/// What a browser is shown. All of it stays as it is while it is served.
struct ViewScene {
  std::string name;
  Vec3d origin;  ///< of what the page is sent, world coordinates
  std::vector<ViewLayer> layers;
  std::vector<std::pair<std::string, Trajectory>> trajectories;  ///< besides those of `sequences`
  std::vector<ViewSequence> sequences;
  std::optional<LabelScheme> labels;
  std::pair<Vec3d, Vec3d> middle_box;  ///< world coordinates: where to look first
  /// That scans are simulated in; null: none.
  const ScanScene* place = nullptr;
  /// The same where it is in memory, whose objects a page may move; null: it is not.
  ModelScene* model = nullptr;
  /// What rays of a page meet where the place is a city on disk; used by the simulating thread
  /// alone.
  CityPicker* picker = nullptr;
  std::vector<ViewLayer> geometries;  ///< of objects, each in a frame of its own
  std::vector<ViewObject> objects;
  std::string sensor = kDefaultSensor;  ///< chosen at the start
  RigidTransform start_pose;            ///< of the sensor, world coordinates
  std::string device = "cpu";
  std::vector<std::string> command;  ///< that 'copy command line' begins with
};

/// Where a sensor begins to drive: at the first pose that there is, else `mount_height_m` above the
/// ground of a street that is found in the layers (street_pose.h), else above what lies in the
/// middle.
RigidTransform start_pose_of(const ViewScene& scene, double mount_height_m,
                             const Executor& executor);

/// The objects of the model's world that are in all scans, and what they are made of.
void add_world(ViewScene& scene, const Executor& executor);

/// "scene.json".
std::string scene_json(const ViewScene& scene);

}  // namespace adasplats
