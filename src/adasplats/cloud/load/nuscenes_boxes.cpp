// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/box_files.h"
#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/json_table.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// An annotation of the scene.
struct SceneBox {
  std::size_t row = 0;  ///< in sample_annotation.json
  std::string instance;
  TimedBox box;
};

/// The times of the samples of a scene by their tokens.
std::unordered_map<std::string, double> samples_of_scene(const NuscenesSceneRow& scene) {
  constexpr double kMicrosecond = 1e-6;
  std::unordered_map<std::string, double> samples;
  for_each_json_row(scene.tables / "sample.json", [&](const JsonRow& row) {
    if (row.text("scene_token") == scene.token)
      samples.emplace(row.text("token"),
                      kMicrosecond * static_cast<double>(row.integer("timestamp")));
  });
  return samples;
}

/// The annotations of a scene by time, those of a sample in the order of the table.
std::vector<SceneBox> boxes_of_scene(const NuscenesSceneRow& scene) {
  const std::unordered_map<std::string, double> samples = samples_of_scene(scene);
  std::multimap<double, SceneBox> by_time;
  for_each_json_row(scene.tables / "sample_annotation.json", [&](const JsonRow& row) {
    const auto sample = samples.find(row.text("sample_token"));
    if (sample == samples.end()) return;  // of another scene
    const auto [width, length, height] = row.triple("size");
    const RigidTransform pose = row.pose("translation", "rotation");
    by_time.emplace(sample->second, SceneBox{row.number(),
                                             row.text("instance_token"),
                                             {sample->second,
                                              pose.translation,
                                              {length / 2, width / 2, height / 2},
                                              yaw_of_box(pose.rotation)}});
  });
  std::vector<SceneBox> boxes;
  for (auto& [time_s, box] : by_time) boxes.push_back(std::move(box));
  return boxes;
}

/// The category names of instances by their tokens.
std::unordered_map<std::string, std::string> labels_of_instances(const fs::path& tables) {
  std::unordered_map<std::string, std::string> categories, labels;
  for_each_json_row(tables / "category.json", [&](const JsonRow& row) {
    categories.emplace(row.text("token"), row.text("name"));
  });
  for_each_json_row(tables / "instance.json", [&](const JsonRow& row) {
    const auto category = categories.find(row.text("category_token"));
    if (category == categories.end())
      throw row.fault("category.json has no category_token " + row.text("category_token"));
    labels.emplace(row.text("token"), category->second);
  });
  return labels;
}

}  // namespace

BoxContent read_nuscenes_boxes(const fs::path& tables, const std::string& name) {
  const fs::path file = tables / "sample_annotation.json";
  const NuscenesSceneRow scene = find_nuscenes_scene(tables, {tables}, name);
  const std::unordered_map<std::string, std::string> labels = labels_of_instances(tables);
  BoxCollector boxes(file);
  for (const SceneBox& one : boxes_of_scene(scene)) {
    const auto place = [&] {
      return file.string() + ": element " + std::to_string(one.row) + " (from 0), instance " +
             one.instance + ": ";
    };
    const auto label = labels.find(one.instance);
    if (label == labels.end())
      throw Error(ErrorKind::data, place() + "instance.json has no such instance");
    boxes.add(boxes.number_of(one.instance), label->second, one.box, {}, place);
  }
  return boxes.take(true);
}

}  // namespace adasplats
