// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/rig_of_drive.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/io/bags/recording.h"

namespace adasplats {
namespace {

RigSensor sensor_of_drive(const std::filesystem::path& path, const std::string& topic,
                          const DriveSettings& settings) {
  RigSensor sensor;
  static_cast<DriveSettings&>(sensor) = settings;
  sensor.folder = path;
  sensor.topic = topic;
  sensor.name = sensor_of_topic(topic);
  return sensor;
}

std::optional<Rig> rig_of_recording(const std::filesystem::path& path,
                                    const DriveSettings& settings, ProgressSink& progress) {
  const RecordingSurvey survey = survey_recording(path, progress);
  const bool has_clouds = std::ranges::any_of(
      survey.topics, [](const auto& topic) { return topic.second.holds_clouds(); });
  Rig rig{path, {}};
  std::set<std::string> frames, names;
  for (const auto& [name, topic] : survey.topics) {
    if (has_clouds ? !topic.holds_clouds() : topic.packets.empty()) continue;
    rig.sensors.push_back(sensor_of_drive(path, name, settings));
    frames.insert(topic.frame);
    names.insert(rig.sensors.back().name);
  }
  const std::size_t count = rig.sensors.size();
  if (count < 2 || frames.size() < count || names.size() < count) return std::nullopt;
  return rig;
}

std::optional<Rig> rig_of_tree(const DataTree& tree, const std::filesystem::path& path,
                               const DriveSettings& settings) {
  if (settings.given_mount() || tree.is_rig == nullptr || !tree.is_rig(path)) return std::nullopt;
  Rig rig{path, {}};
  for (const std::string_view name : tree.sensors)
    rig.sensors.push_back(sensor_of_drive(path, std::string(name), settings));
  return rig;
}

}  // namespace

std::string sensor_of_topic(const std::string& topic) {
  std::string name = topic;
  for (const std::string_view ending : {"/points", "/point_cloud", "/packets"})
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  std::ranges::replace(name, '/', '_');
  const std::size_t begin = name.find_first_not_of('_');
  return begin == std::string::npos ? topic : name.substr(begin);
}

std::optional<Rig> rig_of_drive(const std::filesystem::path& path, const DriveSettings& settings,
                                ProgressSink& progress) {
  if (is_recording(path)) return rig_of_recording(path, settings, progress);
  const DataTree* const tree = data_tree_of(path);
  return tree == nullptr ? std::nullopt : rig_of_tree(*tree, path, settings);
}

}  // namespace adasplats
