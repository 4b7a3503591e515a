// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/nuscenes_drive.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "adasplats/cloud/load/intensity_scale.h"
#include "adasplats/cloud/load/json_rows.h"
#include "adasplats/cloud/load/nuscenes_scene.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/poses/sensor_axes.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
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
                                       " labels (a byte each), " + std::to_string(points) +
                                       " points");
    std::vector<std::uint16_t> classes;
    for (const char byte : bytes) classes.push_back(static_cast<std::uint8_t>(byte));
    return classes;
  }

  std::map<fs::path, fs::path> labels_;
  bool has_labels_;
  std::optional<IntensityScale> scale_;
};

/// Takes the scans whose files are there: all, or the keyframes where no sweep is, as who has
/// fetched those alone. Errors: data that names a file that is missing.
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
  const bool takes_keys = !has_sweeps && !keys.empty() && keys.size() < scene.scans.size();
  const std::vector<NuscenesScan>& taken = takes_keys ? keys : scene.scans;
  const auto lost = std::ranges::find_if_not(taken, is_there);
  if (lost != taken.end())
    throw Error(ErrorKind::data, lost->file.string() + ": this frame of " + scene.name +
                                     " is missing, or is no file");
  if (takes_keys)
    progress.warn(root.string() + ": the sweeps of " + scene.name +
                  " are not there, so its scans are the keyframes alone");
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
      if (!row.has("index")) return;  // of the release without lidarseg
      const std::int64_t id = row.integer("index");
      if (id < 0 || id > 0xff) throw row.fault("'index' is no number of a class (a byte)");
      names.emplace_back(static_cast<std::uint16_t>(id), row.text("name"));
    });
    break;
  }
  return names;
}

KittiSequence open_nuscenes_drive(const FrameDrive& drive, const Executor& executor,
                                  ProgressSink& progress) {
  if (drive.mount || drive.time_offset_s)
    throw Error(ErrorKind::usage, drive.folder.string() +
                                      ": is a data root of nuScenes, whose tables say where the "
                                      "LiDAR sits and when; `mount` and `time_offset` are for "
                                      "other drives");
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
