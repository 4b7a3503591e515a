// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/rig_mounts.h"

#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/calibrate/map_alignment.h"
#include "adasplats/core/constants.h"
#include "adasplats/jobs/calibrate/calibration.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// With six digits behind the point.
double rounded(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }

Vec3d rounded(Vec3d v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

}  // namespace

std::vector<RigMount> rig_mounts(std::span<const CloudSensor> sensors, const Trajectory& corrected,
                                 const CalibrationReport& report) {
  std::vector<RigMount> mounts;
  Trajectory first;
  auto begin = corrected.begin();
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const auto end = std::next(begin, static_cast<std::ptrdiff_t>(sensors[k].scans));
    RigMount mount{sensors[k].name, {}, 0};
    if (k == 0) {
      first = with_extrapolated_ends({begin, end}, 1);
    } else {
      mount.clock_s = report.others[k - 1].aligned->clock_s;
      Trajectory of_first, of_sensor;
      for (auto pose = begin; pose != end; ++pose) {
        const double time_s = pose->time_s + mount.clock_s;
        if (time_s < first.front().time_s || time_s > first.back().time_s) continue;
        of_first.push_back({time_s, interpolate(first, time_s)});
        of_sensor.push_back({time_s, pose->world_from_sensor});
      }
      if (!of_first.empty()) mount.first_from_sensor = mount_between(of_first, of_sensor);
    }
    mounts.push_back(std::move(mount));
    begin = end;
  }
  return mounts;
}

nlohmann::ordered_json to_json(std::span<const RigMount> mounts, const CalibrationReport& report,
                               const Calibration& calibration) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    const RigidTransform& mount = mounts[k].first_from_sensor;
    const Vec3d turn_deg = yaw_pitch_roll_deg(mount.rotation), at = mount.translation;
    nlohmann::ordered_json json = {{"name", mounts[k].name},
                                   {"position_m", {at.x, at.y, at.z}},
                                   {"yaw_pitch_roll_deg", {turn_deg.x, turn_deg.y, turn_deg.z}},
                                   {"clock_s", mounts[k].clock_s}};
    if (k > 0) {
      const CalibrationReport& own = report.others[k - 1];
      const Calibration& found = calibration.others[k - 1];
      json["near_map_given"] = own.aligned->given_share;
      json["near_map"] = own.aligned->share;
      json["correction"] = calibration_json(own, found);
      if (!found.lasers.cells.empty()) json["cells"] = found.lasers.cells.size();
    }
    list.push_back(std::move(json));
  }
  return list;
}

Rig calibrated_rig(Rig given, std::span<const RigMount> mounts, const fs::path& folder) {
  given.file = folder / "rig.toml";
  for (std::size_t k = 0; k < mounts.size(); ++k) {
    RigSensor& sensor = given.sensors[k];
    const RigidTransform& mount = mounts[k].first_from_sensor;
    for (fs::path* const path : {&sensor.folder, &sensor.boxes, &sensor.scan_times})
      if (!path->empty()) *path = fs::absolute(*path).lexically_normal();
    sensor.trajectory = folder / mounts.front().name / "trajectory.csv";
    sensor.mount = rounded(mount.translation);
    sensor.mount_rotation_deg = rounded(yaw_pitch_roll_deg(mount.rotation));
    if (mounts[k].clock_s != 0)
      sensor.time_offset_s = sensor.time_offset_s.value_or(0) + rounded(mounts[k].clock_s);
  }
  return given;
}

}  // namespace adasplats
