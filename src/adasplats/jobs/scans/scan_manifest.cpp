// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/scan_manifest.h"

#include <array>
#include <nlohmann/json.hpp>

#include "adasplats/core/words.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/scene/scene_files.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/jobs/session/settings_json.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// The numbers of a trajectory as they were read, whatever files they came from.
Json trajectory_content(const Trajectory& trajectory) {
  Sha256 hash;
  for (const TimedPose& pose : trajectory) {
    const auto& [rotation, place] = pose.world_from_sensor;
    const Vec3d(&r)[3] = rotation.rows;
    const double numbers[] = {pose.time_s, r[0].x, r[0].y, r[0].z,  r[1].x,  r[1].y, r[1].z,
                              r[2].x,      r[2].y, r[2].z, place.x, place.y, place.z};
    hash.add(numbers, sizeof(numbers));
  }
  return {{"poses", trajectory.size()}, {"sha256", hash.digest()}};
}

Json file_content(const std::filesystem::path& file) {
  return {{"name", file.filename().string()}, {"sha256", sha256_of_file(file)}};
}

/// What the classes mean: it colours pictures and names boxes.
Json labels_content(const LabelScheme& labels) {
  Sha256 hash;
  for (const SemanticClass& each : labels.classes()) {
    hash.add(std::to_string(each.id) + "\n" + each.name + "\n");
    hash.add(each.rgb.data(), each.rgb.size());
  }
  return {{"name", labels.name()}, {"sha256", hash.digest()}};
}

Json matrix_content(const RigidTransform& transform) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    const Vec3d& r = transform.rotation.rows[row];
    rows.push_back({r.x, r.y, r.z, transform.translation[row]});
  }
  return rows;
}

/// A trajectory, or the options that replace it.
Json where_content(const DriveOptions& drive, const DrivenPoses& driven) {
  if (!drive.trajectory.empty()) return {{"trajectory", trajectory_content(driven.poses)}};
  Json json = {{"height_m", drive.height_m.value_or(kRoofHeight_m)}};
  Json& places = json[drive.path.empty() ? "at" : "path"] = Json::array();
  for (const SensorPlace& place : drive.at)
    places.push_back({place.x_m, place.y_m, place.z_m ? Json(*place.z_m) : Json(), place.yaw_deg});
  for (const PathCorner& corner : drive.path) places.push_back({corner.x_m, corner.y_m});
  if (!drive.path.empty()) json["speed_mps"] = drive.speed_mps.value_or(kTownSpeed_mps);
  return json;
}

Json drive_content(const DriveOptions& drive) {
  const auto given = [](std::optional<double> value) { return value ? Json(*value) : Json(); };
  DrivenPoses driven;
  ProgressSink silent;  // scans_along() has reported the warnings
  if (!drive.trajectory.empty()) driven = driven_poses(drive, silent);
  Json json = where_content(drive, driven);
  json.update(Json{{"offset_m", {drive.offset_m.x, drive.offset_m.y, drive.offset_m.z}},
                   {"mount", matrix_content(drive.mount)},
                   {"every", drive.every},
                   {"rate_hz", given(drive.rate_hz)},
                   {"spacing_m", given(drive.spacing_m)},
                   {"rolling_shutter", drive.rolling_shutter}});
  const bool has_motion = !drive.trajectory.empty() && drive.rolling_shutter &&
                          (!drive.motion.empty() || is_recording(drive.trajectory));
  if (has_motion) json["motion"] = trajectory_content(driven.motion);
  return json;
}

template <class Settings>
Json content_of(const Settings& settings) {
  Json json;
  put_settings(settings, json);
  return json;
}

}  // namespace

/// SHA-256 of all that decides the intensities of a unit.
std::string digest_of(const SensorIntensity& unit) {
  Sha256 hash;
  const auto add = [&](const auto& values) {
    hash.add(values.data(), values.size() * sizeof(values[0]));
  };
  const std::array scalars = {unit.step, unit.highest, static_cast<double>(unit.ring_nodes)};
  add(scalars);
  for (const auto* table :
       {&unit.ring_expected, &unit.ring_level, &unit.levels, &unit.zero_share, &unit.reported})
    add(*table);
  return hash.digest();
}

std::string digest_of(const SensorFields& fields) {
  Sha256 hash;
  const std::array sizes = {fields.turns, fields.rings, fields.columns};
  hash.add(sizes.data(), sizes.size() * sizeof(sizes[0]));
  hash.add(fields.bytes.data(), fields.bytes.size());
  return hash.digest();
}

std::string digest_of(const std::string& text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.digest();
}

Json sensor_content(const LidarModel& sensor) {
  Json json = {{"name", sensor.name},
               {"rings", sensor.rings()},
               {"rays", sensor.rays_per_scan()},
               {"rotation_hz", sensor.rotation_hz},
               {"min_range_m", sensor.min_range_m},
               {"max_range_m", sensor.max_range_m},
               {"range_noise_m", sensor.range_noise_m},
               {"angular_noise_rad", sensor.angular_noise_rad},
               {"range_resolution_m", sensor.range_resolution_m},
               {"divergence_rad", {sensor.divergence_rad[0], sensor.divergence_rad[1]}},
               {"divergence_kind", word_of(sensor.divergence_kind, kDivergenceKinds)}};
  if (!sensor.ring_noise_m.empty()) json["ring_noise_m"] = sensor.ring_noise_m;
  if (sensor.intensity) json["intensity"] = digest_of(*sensor.intensity);
  if (sensor.fields) json["fields"] = digest_of(*sensor.fields);
  if (sensor.drop) json["drop"] = digest_of(ray_drop_toml(*sensor.drop));
  if (sensor.body) json["body"] = digest_of(vehicle_body_toml(*sensor.body));
  Sha256 hash;
  for (const Firing& firing : firings_of(sensor)) {
    const float numbers[] = {firing.direction.x, firing.direction.y, firing.direction.z,
                             firing.time_s,      firing.origin.x,    firing.origin.y,
                             firing.origin.z};
    hash.add(numbers, sizeof(numbers));
    hash.add(&firing.ring, sizeof(firing.ring));
    hash.add(&firing.column, sizeof(firing.column));
  }
  json["pattern"] = hash.digest();
  return json;
}

namespace {

Json rig_content(const Rig& rig, std::span<const MountedSensor> sensors) {
  const auto boxes_content = [](const std::vector<RigBox>& boxes) {
    Json list = Json::array();
    for (const auto& [center, size] : boxes)
      list.push_back({center.x, center.y, center.z, size.x, size.y, size.z});
    return list;
  };
  Json json = {{"body", boxes_content(rig.body)}, {"sensors", Json::array()}};
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const MountedSensor& sensor = sensors[k];
    Json content = sensor_content(sensor.settings.sensor);
    if (sensor.settings.sensor_offsets)
      content["range_offsets_m"] = sensor.settings.sensor.range_offsets_m;
    json["sensors"].push_back({{"name", sensor.name},
                               {"sensor", content},
                               {"mount", matrix_content(sensor.mount)},
                               {"time_offset_s", sensor.time_offset_s},
                               {"topic", rig.sensors[k].topic},
                               {"in_model", rig.sensors[k].is_in_model},
                               {"body", boxes_content(rig.sensors[k].body)}});
  }
  return json;
}

}  // namespace

Json simulate_content(const SimulateJob& job, std::span<const MountedSensor> sensors,
                      const std::optional<Rig>& rig, const ScanScene& scene) {
  const ScanSettings& settings = sensors.front().settings;
  Json model = Json::array();
  for (const std::filesystem::path& file : files_of_scene(job.model))
    model.push_back(file_content(file));
  Json content = {
      {"model", model},
      {rig ? "rig" : "sensor", rig ? rig_content(*rig, sensors) : sensor_content(settings.sensor)},
      {"drive", drive_content(job.drive)},
      {"points", word_of(settings.frame, kPointFrames)},
      {"beam", content_of(settings.beam)},
      {"noise", settings.noise},
      {"weather", content_of(settings.weather)},
      {"seed", settings.seed},
      {"format", word_of(job.format, kScanFormats)},
      {"point_order", word_of(job.point_order, kPointOrders)}};
  if (settings.sensor_offsets && !rig)
    content["sensor"]["range_offsets_m"] = settings.sensor.range_offsets_m;
  if (const LabelScheme* labels = scene.labels()) content["labels"] = labels_content(*labels);
  if (is_ray_drop_file(job.scan.ray_drop_file))
    content["ray_drop"] = file_content(job.scan.ray_drop_file);
  else if (!job.scan.ray_drop_file.empty())
    content["ray_drop"] = job.scan.ray_drop_file.string();
  content["vehicle_body"] = settings.vehicle_body;
  if (job.velocities) content["velocities"] = true;
  if (job.driver != CloudDriver::adasplats) content["driver"] = word_of(job.driver, kCloudDrivers);
  return content;
}

}  // namespace adasplats
