// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <nlohmann/json.hpp>

#include "adasplats/sensors/lidar_model.h"
#include "adasplats/view/message_values.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// Version of docs/viewer_protocol.md.
constexpr int kProtocolVersion = 2;

/// A pose in the format of the page: x, y, z relative to `origin`, qx, qy, qz, qw.
std::array<double, 7> pose_json(RigidTransform world_from_sensor, Vec3d origin) {
  world_from_sensor.translation = world_from_sensor.translation - origin;
  return message_numbers(world_from_sensor);
}

Json json_of(Vec3d v) { return {v.x, v.y, v.z}; }
Json json_of(ByteRange range) { return {range.low, range.high}; }

Json box_of(const ViewLayer& layer) {
  const LevelNode& root = nodes_of(layer).front();
  return {json_of(vec_cast<double>(root.low)), json_of(vec_cast<double>(root.high))};
}

Json layer_json(const ViewLayer& layer, std::size_t id) {
  return {{"id", id},
          {"kind", layer.mesh        ? "mesh"
                   : layer.is_splats ? "splats"
                                     : "points"},
          {"name", layer.name},
          {"count", size_of(layer)},
          {"nodes", nodes_of(layer).size()},
          {"has_classes", layer.has_classes},
          {"has_intensities", layer.has_intensities},
          {"has_errors", layer.has_errors},
          {"has_colors", layer.tree.has_colors()},
          {"part", layer.part},
          {"intensity_range", json_of(intensity_range_of(layer))},
          {"error_range_m", json_of(layer.tree.error_range_m())},
          {"box", box_of(layer)}};
}

Json object_json(const ViewScene& scene, const ViewObject& placed) {
  const WorldObject& object = scene.model->world()->object(placed.object);
  Json json = {{"name", placed.name},
               {"geometry", layer_json(scene.geometries[placed.geometry],
                                       scene.layers.size() + placed.geometry)},
               {"class_id", nullptr},
               {"scale", object.scale},
               {"only_during", object.only_during},
               {"poses", Json::array()},
               {"times_s", Json::array()}};
  if (object.class_id) json["class_id"] = *object.class_id;
  for (const TimedPose& pose : object.trajectory) {
    json["poses"].push_back(pose_json(pose.world_from_sensor, scene.origin));
    json["times_s"].push_back(pose.time_s);
  }
  return json;
}

Json trajectory_json(const std::string& name, const Trajectory& poses, Vec3d origin) {
  Json json = {{"name", name}, {"poses", Json::array()}, {"times_s", Json::array()}};
  if (!poses.empty()) json["begin_s"] = poses.front().time_s;
  for (const TimedPose& pose : poses) {
    json["poses"].push_back(pose_json(pose.world_from_sensor, origin));
    json["times_s"].push_back(pose.time_s - poses.front().time_s);
  }
  return json;
}

/// Sequences come first, because recorded scans refer to their trajectory by index.
Json trajectories_json(const ViewScene& scene) {
  Json json = Json::array();
  for (const ViewSequence& sequence : scene.sequences)
    json.push_back(trajectory_json(sequence.name, sequence.scans.trajectory, scene.origin));
  for (const auto& [name, poses] : scene.trajectories)
    json.push_back(trajectory_json(name, poses, scene.origin));
  return json;
}

Json scans_json(const ViewScene& scene) {
  Json json = Json::array();
  for (std::size_t k = 0; k < scene.sequences.size(); ++k) {
    const KittiSequence& scans = scene.sequences[k].scans;
    const double first_s = scans.trajectory.empty() ? 0 : scans.trajectory.front().time_s;
    for (std::size_t i = 0; i < scans.scans.size(); ++i) {
      json.push_back({{"name", scans.scans[i].stem().string()},
                      {"trajectory", k},
                      {"time_s", scans.trajectory[i].time_s - first_s},
                      {"pose", pose_json(scans.trajectory[i].world_from_sensor, scene.origin)}});
    }
  }
  return json;
}

Json classes_json(const std::optional<LabelScheme>& labels) {
  Json json = Json::array();
  if (!labels) return json;
  for (const SemanticClass& c : labels->classes())
    json.push_back({{"id", c.id}, {"name", c.name}, {"color", c.rgb}});
  return json;
}

Json sensors_json() {
  Json json = Json::array();
  for (const std::string& name : lidar_model_names()) {
    const LidarModel sensor = load_lidar_model(name);
    json.push_back({{"name", name},
                    {"title", sensor.name},
                    {"rings", sensor.rings()},
                    {"rays", sensor.rays_per_scan()},
                    {"rotation_hz", sensor.rotation_hz},
                    {"min_range_m", sensor.min_range_m},
                    {"max_range_m", sensor.max_range_m}});
  }
  return json;
}

}  // namespace

std::string scene_json(const ViewScene& scene) {
  Json json = {
      {"version", kProtocolVersion}, {"name", scene.name}, {"origin_m", json_of(scene.origin)}};
  json["layers"] = Json::array();
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    json["layers"].push_back(layer_json(scene.layers[i], i));
  json["middle_box"] = {json_of(scene.middle_box.first - scene.origin),
                        json_of(scene.middle_box.second - scene.origin)};
  json["classes"] = classes_json(scene.labels);
  json["trajectories"] = trajectories_json(scene);
  json["scans"] = scans_json(scene);
  json["objects"] = Json::array();
  for (const ViewObject& object : scene.objects)
    json["objects"].push_back(object_json(scene, object));
  json["can_simulate"] = scene.place != nullptr;
  json["sensors"] = scene.place != nullptr ? sensors_json() : Json::array();
  json["sensor"] = scene.sensor;
  json["start_pose"] = pose_json(scene.start_pose, scene.origin);
  json["device"] = scene.device;
  json["command"] = scene.command;
  // File names may have invalid UTF-8, which JSON must not.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace adasplats
