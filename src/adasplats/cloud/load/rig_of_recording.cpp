// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/rig_of_recording.h"

#include <algorithm>
#include <set>
#include <string>

#include "adasplats/cloud/load/recording_drive.h"

namespace adasplats {

std::string sensor_of_topic(const std::string& topic) {
  std::string name = topic;
  for (const std::string_view ending : {"/points", "/point_cloud", "/packets"})
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  std::ranges::replace(name, '/', '_');
  const std::size_t begin = name.find_first_not_of('_');
  return begin == std::string::npos ? topic : name.substr(begin);
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
    RigSensor sensor;
    static_cast<DriveSettings&>(sensor) = settings;
    sensor.folder = path;
    sensor.topic = name;
    sensor.name = sensor_of_topic(name);
    frames.insert(topic.frame);
    names.insert(sensor.name);
    rig.sensors.push_back(std::move(sensor));
  }
  const std::size_t count = rig.sensors.size();
  if (count < 2 || frames.size() < count || names.size() < count) return std::nullopt;
  return rig;
}

}  // namespace adasplats
