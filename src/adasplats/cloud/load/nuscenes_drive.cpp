// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/nuscenes_drive.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/poses/quaternion_order.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/json_table.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLidarChannel = "LIDAR_TOP";
constexpr double kMicrosecond_s = 1e-6;

std::vector<NuscenesSceneRow> scenes_of(const std::vector<fs::path>& folders) {
  std::vector<NuscenesSceneRow> scenes;
  for (const fs::path& tables : folders)
    for_each_json_row(tables / "scene.json", [&](const JsonRow& row) {
      scenes.push_back({tables, row.text("token"), row.text("name")});
    });
  return scenes;
}

std::string list_of_scenes(const std::vector<NuscenesSceneRow>& scenes) {
  constexpr std::size_t kMaxListed = 20;
  std::set<std::string> names;
  for (const NuscenesSceneRow& scene : scenes) names.insert(scene.name);
  std::string list;
  std::size_t listed = 0;
  for (const std::string& name : names) {
    if (++listed > kMaxListed) break;
    list += (list.empty() ? "" : ", ") + name;
  }
  if (names.size() > kMaxListed)
    list += ", ... (" + std::to_string(names.size() - kMaxListed) + " more)";
  return list;
}

/// Reads the tables of one scene, in the order of their references.
class SceneReader {
 public:
  SceneReader(fs::path root, NuscenesSceneRow scene)
      : root_(std::move(root)), row_(std::move(scene)) {}

  NuscenesScene read() {
    scene_.name = row_.name;
    read_sensor();
    read_samples();
    read_scans();
    read_ego_poses();
    read_labels();
    std::ranges::sort(scene_.scans, {}, [](const NuscenesScan& s) { return s.pose.time_s; });
    require_sound();
    return std::move(scene_);
  }

 private:
  fs::path table(const char* name) const { return row_.tables / name; }

  /// Mount of LIDAR_TOP by the tokens of its calibrations.
  void read_sensor() {
    std::set<std::string> lidars;
    for_each_json_row(table("sensor.json"), [&](const JsonRow& row) {
      if (row.text("channel") == kLidarChannel) lidars.insert(row.text("token"));
    });
    for_each_json_row(table("calibrated_sensor.json"), [&](const JsonRow& row) {
      if (lidars.contains(row.text("sensor_token")))
        ego_from_sensor_[row.text("token")] = row.pose("translation", "rotation");
    });
  }

  void read_samples() {
    for_each_json_row(table("sample.json"), [&](const JsonRow& row) {
      if (row.text("scene_token") == row_.token) samples_.insert(row.text("token"));
    });
  }

  void read_scans() {
    for_each_json_row(table("sample_data.json"), [&](const JsonRow& row) {
      if (!samples_.contains(row.text("sample_token"))) return;
      const auto sensor = ego_from_sensor_.find(row.text("calibrated_sensor_token"));
      if (sensor == ego_from_sensor_.end()) return;
      NuscenesScan scan;
      scan.file = file_in_root(row);
      scan.is_key = row.boolean("is_key_frame");
      scan.pose.time_s = kMicrosecond_s * static_cast<double>(row.integer("timestamp"));
      scan.pose.world_from_sensor = sensor->second;  // read_ego_poses() multiplies the ego pose
      scans_of_ego_pose_[row.text("ego_pose_token")].push_back(scene_.scans.size());
      const std::string token = row.text("token");
      if (!scan_of_token_.emplace(token, scene_.scans.size()).second)
        throw row.fault("its token " + token + " is also that of another row");
      scene_.scans.push_back(std::move(scan));
    });
  }

  void read_ego_poses() {
    for_each_json_row(table("ego_pose.json"), [&](const JsonRow& row) {
      const auto scans = scans_of_ego_pose_.find(row.text("token"));
      if (scans == scans_of_ego_pose_.end()) return;
      const RigidTransform world_from_ego = row.pose("translation", "rotation");
      for (const std::size_t k : scans->second) {
        RigidTransform& pose = scene_.scans[k].pose.world_from_sensor;
        pose = world_from_ego * pose;
      }
      scans_of_ego_pose_.erase(scans);
    });
    if (scans_of_ego_pose_.empty()) return;
    const std::size_t lost = scans_of_ego_pose_.begin()->second.front();
    throw Error(ErrorKind::data, table("ego_pose.json").string() + ": has no pose with the token " +
                                     scans_of_ego_pose_.begin()->first + ", referenced by " +
                                     scene_.scans[lost].file.string());
  }

  void read_labels() {
    std::error_code ignored;
    scene_.has_labels = fs::exists(table("lidarseg.json"), ignored);
    if (!scene_.has_labels) return;
    for_each_json_row(table("lidarseg.json"), [&](const JsonRow& row) {
      const auto scan = scan_of_token_.find(row.text("sample_data_token"));
      if (scan != scan_of_token_.end()) scene_.scans[scan->second].labels = file_in_root(row);
    });
  }

  fs::path file_in_root(const JsonRow& row) const {
    const fs::path name = row.text("filename");
    const bool leads_out = std::ranges::any_of(name, [](const fs::path& p) { return p == ".."; });
    if (name.empty() || name.is_absolute() || leads_out)
      throw row.fault("'filename' is not a path within the data root");
    return root_ / name;
  }

  void require_sound() const {
    const std::vector<NuscenesScan>& scans = scene_.scans;
    if (scans.empty())
      throw Error(ErrorKind::data, table("sample_data.json").string() + ": has no scan of " +
                                       kLidarChannel + " in " + scene_.name);
    std::vector<PlacedQuaternion> placed;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const RigidTransform& pose = scans[k].pose.world_from_sensor;
      placed.push_back({pose.translation, quaternion_from_rotation(pose.rotation)});
      if (k > 0 && !(scans[k].pose.time_s > scans[k - 1].pose.time_s))
        throw Error(ErrorKind::data, table("sample_data.json").string() + ": " +
                                         scans[k - 1].file.string() + " and " +
                                         scans[k].file.string() + " have the same time");
    }
    const std::string objection = quaternion_order_problem(placed);
    if (!objection.empty())
      throw Error(ErrorKind::data, table("ego_pose.json").string() + ": " + objection);
  }

  fs::path root_;
  NuscenesSceneRow row_;
  NuscenesScene scene_;
  std::unordered_map<std::string, RigidTransform> ego_from_sensor_;
  std::unordered_set<std::string> samples_;
  std::unordered_map<std::string, std::vector<std::size_t>> scans_of_ego_pose_;
  std::unordered_map<std::string, std::size_t> scan_of_token_;
};

}  // namespace

std::vector<fs::path> nuscenes_tables(const fs::path& root) {
  std::vector<fs::path> folders;
  for (const fs::path& folder : list_folder_if_any(root)) {
    std::error_code ignored;
    if (folder.filename().string().starts_with("v1.0-") &&
        (fs::is_regular_file(folder / "scene.json", ignored) ||
         fs::is_regular_file(folder / "sample_data.json", ignored)))
      folders.push_back(folder);
  }
  return folders;
}

NuscenesSceneRow find_nuscenes_scene(const fs::path& root, const std::vector<fs::path>& tables,
                                     const std::string& name) {
  const std::vector<NuscenesSceneRow> scenes = scenes_of(tables);
  if (scenes.empty()) throw Error(ErrorKind::data, root.string() + ": its tables contain no scene");
  const auto found = std::ranges::find(scenes, name, &NuscenesSceneRow::name);
  if (found != scenes.end()) return *found;
  const bool is_one = std::ranges::all_of(
      scenes, [&](const NuscenesSceneRow& scene) { return scene.name == scenes.front().name; });
  if (name.empty() && is_one) return scenes.front();
  throw Error(ErrorKind::usage,
              root.string() +
                  (name.empty() ? ": has several scenes; choose one with `scene`: "
                                : ": has no scene '" + name + "'; it has ") +
                  list_of_scenes(scenes));
}

NuscenesScene read_nuscenes_scene(const fs::path& root, const std::string& name) {
  return SceneReader(root, find_nuscenes_scene(root, nuscenes_tables(root), name)).read();
}

namespace {

namespace fs = std::filesystem;

/// Reads scans in our axes.
class NuscenesFrames final : public ScanSource {
 public:
  NuscenesFrames(std::map<fs::path, fs::path> labels, bool has_labels,
                 std::optional<IntensityScale> scale)
      : labels_(std::move(labels)), has_labels_(has_labels), scale_(scale) {}

  FileScan read(const fs::path& file) const override {
    FileScan scan = read_file_scan(file);
    for (Vec3d& p : scan.positions) p = kSensorFromRightForward.rotation * p;
    if (has_labels_) scan.classes = classes_of(file, scan.size());
    if (scale_) scan.intensities = scale_->scaled(std::move(scan.intensities), file);
    return scan;
  }

 private:
  std::vector<std::uint16_t> classes_of(const fs::path& file, std::size_t points) const {
    const auto labels = labels_.find(file);
    if (labels == labels_.end()) return std::vector<std::uint16_t>(points, kNuscenesUnlabeled);
    const std::string bytes = read_file(labels->second);
    if (bytes.size() != points)
      throw Error(ErrorKind::data, labels->second.string() + ": " + std::to_string(bytes.size()) +
                                       " labels (one byte each) for " + std::to_string(points) +
                                       " points");
    std::vector<std::uint16_t> classes;
    for (const char byte : bytes) classes.push_back(static_cast<std::uint8_t>(byte));
    return classes;
  }

  std::map<fs::path, fs::path> labels_;
  bool has_labels_;
  std::optional<IntensityScale> scale_;
};

/// The scans whose files exist: all, or only the keyframes if no sweep exists (a partial download).
/// Errors: data with a missing file.
std::vector<NuscenesScan> scans_on_disk(const NuscenesScene& scene, const fs::path& root,
                                        ProgressSink& progress) {
  const auto is_there = [](const NuscenesScan& scan) {
    std::error_code ignored;
    return fs::is_regular_file(scan.file, ignored);
  };
  const auto is_key = [](const NuscenesScan& scan) { return scan.is_key; };
  std::vector<NuscenesScan> keys;
  std::ranges::copy_if(scene.scans, std::back_inserter(keys), is_key);
  const bool has_sweeps = std::ranges::any_of(
      scene.scans, [&](const NuscenesScan& scan) { return !scan.is_key && is_there(scan); });
  const bool uses_keys = !has_sweeps && !keys.empty() && keys.size() < scene.scans.size();
  const std::vector<NuscenesScan>& taken = uses_keys ? keys : scene.scans;
  const auto lost = std::ranges::find_if_not(taken, is_there);
  if (lost != taken.end())
    throw Error(ErrorKind::data,
                lost->file.string() + ": this frame of " + scene.name + " is missing");
  if (uses_keys)
    progress.warn(root.string() + ": the sweeps of " + scene.name +
                  " are missing; only the keyframes are used");
  return taken;
}

std::string label_text(const std::vector<NuscenesScan>& scans, std::size_t labelled) {
  const std::string of =
      std::to_string(labelled) + " of " + std::to_string(scans.size()) + " scans";
  return labelled == scans.size() ? "of all scans"
                                  : of + ", points of the others are " +
                                        std::to_string(kNuscenesUnlabeled) + " (unlabeled)";
}

}  // namespace

bool is_nuscenes_root(const fs::path& folder) { return !nuscenes_tables(folder).empty(); }

ClassNames nuscenes_class_names(const fs::path& folder) {
  ClassNames names;
  for (const fs::path& tables : nuscenes_tables(folder)) {
    std::error_code ignored;
    if (!fs::exists(tables / "lidarseg.json", ignored)) continue;
    for_each_json_row(tables / "category.json", [&](const JsonRow& row) {
      if (!row.has("index")) return;  // the release without lidarseg
      const std::int64_t id = row.integer("index");
      if (id < 0 || id > 0xff) throw row.fault("'index' is not a class number from 0 to 255");
      names.emplace_back(static_cast<std::uint16_t>(id), row.text("name"));
    });
    break;
  }
  return names;
}

KittiSequence open_nuscenes_drive(const DriveInput& drive, const Executor& executor,
                                  ProgressSink& progress) {
  if (drive.given_mount() || drive.time_offset_s)
    throw Error(ErrorKind::usage, drive.folder.string() +
                                      ": is a nuScenes data root, whose tables define mount and "
                                      "times; `mount` and `time_offset` do not apply");
  const NuscenesScene scene = read_nuscenes_scene(drive.folder, drive.scene);
  const std::vector<NuscenesScan> scans = scans_on_disk(scene, drive.folder, progress);
  SensorFrames frames;
  std::map<fs::path, fs::path> labels;
  for (const NuscenesScan& scan : scans) {
    frames.files.push_back(scan.file);
    if (!scan.labels.empty()) labels.emplace(scan.file, scan.labels);
    const RigidTransform pose = scan.pose.world_from_sensor * kSensorFromRightForward.inverse();
    frames.poses.of_scans.push_back({scan.pose.time_s, pose});
  }
  frames.poses.track = frames.poses.of_scans;
  frames.poses.by = "of ego_pose and calibrated_sensor of " + scene.name;
  frames.poses.has_times = true;
  const IntensityScale scale = scale_of_scans(NuscenesFrames({}, false, {}), frames.files);
  const std::size_t labelled = labels.size();
  const bool has_labels = drive.with_classes && labelled > 0;
  frames.source = std::make_shared<NuscenesFrames>(std::move(labels), has_labels, scale);
  frames.intensities = scale.description();
  frames.labels = labelled > 0 ? label_text(scans, labelled) : "none";
  return open_sensor_frames(drive, frames, "as nuScenes has them", executor, progress);
}

}  // namespace adasplats
