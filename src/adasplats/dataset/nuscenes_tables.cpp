// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/nuscenes_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/dataset/nuscenes_categories.h"
#include "adasplats/dataset/oxts_records.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/tree_names.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

using Rows = nlohmann::ordered_json;

// Position of LIDAR_TOP in the frame of nuScenes' cars (calibrated_sensor.json), without its tilt.
constexpr Vec3d kLidarOnEgo_m = {0.943713, 0, 1.84023};
constexpr const char* kVisible = "4";

std::string numbered_token(const char* table, std::size_t number) {
  return token_of(std::string(table) + " " + std::to_string(number));
}

Rows numbers_of(Vec3d v) { return Rows::array({v.x, v.y, v.z}); }

Rows quaternion_of(const Mat3d& rotation) {
  const Quaternion q = quaternion_from_rotation(rotation);
  return Rows::array({q.w, q.x, q.y, q.z});
}

std::int64_t microseconds_of(double time_s) {
  date_and_time(time_s, "nuScenes");  // throws if the time is not a date
  return std::llround(1e6 * time_s);
}

/// The nuScenes attribute of an object; empty: none.
std::string attribute_of(const TreeBox& box) {
  if (box.type == "Pedestrian") return box.moves ? "pedestrian.moving" : "pedestrian.standing";
  if (box.type == "Cyclist") return "cycle.with_rider";
  return box.moves ? "vehicle.moving" : "vehicle.parked";
}

/// The tables of one scene.
class SceneTables {
 public:
  SceneTables(std::span<const NuscenesFrame> frames, const LabelScheme* labels)
      : frames_(frames), labels_(labels) {
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (frames[i].is_key) samples_.push_back(i);
  }

  /// Tables by name.
  std::map<std::string, Rows> all() {
    put_constants();
    put_samples();
    put_sample_data();
    put_annotations();
    return std::move(tables_);
  }

 private:
  void add(const char* table, Rows row) { tables_[table].push_back(std::move(row)); }

  void put_constants() {
    for (const char* table : {"instance", "sample_annotation", "scene", "log", "map", "sample",
                              "sample_data", "ego_pose"})
      tables_[table] = Rows::array();
    for (std::size_t k = 0; k < nuscenes_categories().size(); ++k)
      add("category", {{"token", numbered_token("category", k)},
                       {"name", nuscenes_categories()[k]},
                       {"description", ""},
                       {"index", k}});
    for (const char* name : {"vehicle.moving", "vehicle.parked", "pedestrian.moving",
                             "pedestrian.standing", "cycle.with_rider"})
      add("attribute", {{"token", token_of(std::string("attribute ") + name)},
                        {"name", name},
                        {"description", ""}});
    const std::pair<const char*, const char*> levels[] = {
        {"1", "v0-40"}, {"2", "v40-60"}, {"3", "v60-80"}, {kVisible, "v80-100"}};
    for (const auto& [token, level] : levels)
      add("visibility", {{"token", token}, {"level", level}, {"description", ""}});
    add("sensor", {{"token", token_of("sensor")}, {"channel", "LIDAR_TOP"}, {"modality", "lidar"}});
    add("calibrated_sensor", {{"token", token_of("calibrated_sensor")},
                              {"sensor_token", token_of("sensor")},
                              {"translation", numbers_of(kLidarOnEgo_m)},
                              {"rotation", quaternion_of(kSensorFromRightForward.rotation)},
                              {"camera_intrinsic", Rows::array()}});
  }

  void put_samples() {
    if (samples_.empty()) return;
    add("log", {{"token", token_of("log")},
                {"logfile", "simulated"},
                {"vehicle", "simulated"},
                {"date_captured", date_and_time(frames_[0].pose.time_s, "nuScenes").substr(0, 10)},
                {"location", "simulated"}});
    add("map", {{"token", token_of("map")},
                {"log_tokens", {token_of("log")}},
                {"category", "semantic_prior"},
                {"filename", kNuscenesMap}});
    add("scene", {{"token", token_of("scene")},
                  {"log_token", token_of("log")},
                  {"nbr_samples", samples_.size()},
                  {"first_sample_token", numbered_token("sample", 0)},
                  {"last_sample_token", numbered_token("sample", samples_.size() - 1)},
                  {"name", "scene-0001"},
                  {"description", "simulated by adasplats"}});
    for (std::size_t k = 0; k < samples_.size(); ++k)
      add("sample", {{"token", numbered_token("sample", k)},
                     {"timestamp", microseconds_of(frames_[samples_[k]].pose.time_s)},
                     {"prev", neighbour("sample", k, -1, samples_.size())},
                     {"next", neighbour("sample", k, 1, samples_.size())},
                     {"scene_token", token_of("scene")}});
  }

  /// The token before or after number `k` of a chain; empty at its ends.
  static std::string neighbour(const char* table, std::size_t k, int step, std::size_t count) {
    if (step < 0) return k == 0 ? "" : numbered_token(table, k - 1);
    return k + 1 == count ? "" : numbered_token(table, k + 1);
  }

  std::size_t nearest_sample(std::size_t frame) const {
    const auto behind = std::ranges::lower_bound(samples_, frame);
    const auto k = static_cast<std::size_t>(behind - samples_.begin());
    if (k == samples_.size()) return k - 1;
    return k > 0 && frame - samples_[k - 1] < samples_[k] - frame ? k - 1 : k;
  }

  void put_sample_data() {
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const NuscenesFrame& frame = frames_[i];
      const RigidTransform sensor_from_ego = {{}, -kLidarOnEgo_m};
      const RigidTransform ego = frame.pose.world_from_sensor * sensor_from_ego;
      const std::int64_t time = microseconds_of(frame.pose.time_s);
      add("ego_pose", {{"token", numbered_token("ego_pose", i)},
                       {"timestamp", time},
                       {"rotation", quaternion_of(ego.rotation)},
                       {"translation", numbers_of(ego.translation)}});
      add("sample_data", {{"token", numbered_token("sample_data", i)},
                          {"sample_token", numbered_token("sample", nearest_sample(i))},
                          {"ego_pose_token", numbered_token("ego_pose", i)},
                          {"calibrated_sensor_token", token_of("calibrated_sensor")},
                          {"timestamp", time},
                          {"fileformat", "pcd"},
                          {"is_key_frame", frame.is_key},
                          {"height", 0},
                          {"width", 0},
                          {"filename", frame.points_file},
                          {"prev", neighbour("sample_data", i, -1, frames_.size())},
                          {"next", neighbour("sample_data", i, 1, frames_.size())}});
      if (frame.classes_file.empty()) continue;
      // The devkit looks labels up by the token of their scan.
      add("lidarseg", {{"token", numbered_token("sample_data", i)},
                       {"sample_data_token", numbered_token("sample_data", i)},
                       {"filename", frame.classes_file}});
    }
  }

  /// Adds the annotations of each object, identified by its instance, in the samples that see it.
  void put_annotations() {
    std::map<std::uint16_t, std::vector<std::pair<std::size_t, const TreeBox*>>> tracks;
    for (std::size_t k = 0; k < samples_.size(); ++k)
      for (const TreeBox& box : frames_[samples_[k]].boxes)
        tracks[box.box.instance].emplace_back(k, &box);
    for (const auto& [instance, track] : tracks) {
      const auto token = [number = instance](std::size_t place) {
        return token_of("annotation " + std::to_string(number) + " " + std::to_string(place));
      };
      const SemanticClass* const known =
          labels_ == nullptr ? nullptr : labels_->find(track.front().second->box.class_id);
      const std::uint8_t category = nuscenes_category(known == nullptr ? "" : known->name);
      add("instance", {{"token", numbered_token("instance", instance)},
                       {"category_token", numbered_token("category", category)},
                       {"nbr_annotations", track.size()},
                       {"first_annotation_token", token(0)},
                       {"last_annotation_token", token(track.size() - 1)}});
      for (std::size_t place = 0; place < track.size(); ++place) {
        const auto& [sample, box] = track[place];
        const Vec3d size = box->box.size_m;
        add("sample_annotation",
            {{"token", token(place)},
             {"sample_token", numbered_token("sample", sample)},
             {"instance_token", numbered_token("instance", instance)},
             {"visibility_token", kVisible},
             {"attribute_tokens", {token_of("attribute " + attribute_of(*box))}},
             {"translation", numbers_of(box->box.world_from_box.translation)},
             {"size", numbers_of({size.y, size.x, size.z})},  // width, length, height
             {"rotation", quaternion_of(box->box.world_from_box.rotation)},
             {"prev", place == 0 ? "" : token(place - 1)},
             {"next", place + 1 == track.size() ? "" : token(place + 1)},
             {"num_lidar_pts", box->points},
             {"num_radar_pts", 0}});
      }
    }
  }

  std::span<const NuscenesFrame> frames_;
  const LabelScheme* labels_;
  std::vector<std::size_t> samples_;  ///< frames of the samples
  std::map<std::string, Rows> tables_;
};

}  // namespace

void write_nuscenes_tables(const std::filesystem::path& folder,
                           std::span<const NuscenesFrame> frames, const LabelScheme* labels) {
  const std::filesystem::path tables = folder / kNuscenesVersion;
  create_folder(tables);
  for (const auto& [name, rows] : SceneTables(frames, labels).all())
    write_file(tables / (name + ".json"), rows.dump(0));
}

}  // namespace adasplats
