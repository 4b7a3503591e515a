// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/cloud/load/recording_poses.h"
#include "adasplats/cloud/poses/openscenario.h"
#include "adasplats/cloud/poses/pose_jump.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

void require_effect(bool is_given, bool has_effect, const char* setting, const char* where) {
  if (is_given && !has_effect)
    throw Error(ErrorKind::usage, std::string("`") + setting + "` has no effect without " + where);
}

void require_finite(const DriveOptions& drive) {
  bool good = true;
  for (const SensorPlace& place : drive.at)
    good = good && std::isfinite(place.x_m) && std::isfinite(place.y_m) &&
           std::isfinite(place.z_m.value_or(0)) && std::isfinite(place.yaw_deg);
  for (const PathCorner& corner : drive.path)
    good = good && std::isfinite(corner.x_m) && std::isfinite(corner.y_m);
  if (!good) throw Error(ErrorKind::usage, "the numbers of `at` and `path` must be finite");
}

/// Warns of a sensor that does not move, and of one that lies on its side.
void warn_of_poses(const DriveOptions& drive, const Trajectory& poses, ProgressSink& progress) {
  constexpr std::size_t kMinPoses = 10;
  constexpr double kStands_m = 0.05, kTilted_deg = 45;
  if (drive.trajectory.empty() || poses.size() < kMinPoses) return;
  double reach_m = 0;
  std::vector<double> tilts_deg;
  // A stated mount may turn the sensor over, if the poses as given are upright.
  const Vec3d vehicle_axis = drive.mount.rotation.transposed() * Vec3d{0, 0, 1};
  for (const TimedPose& pose : poses) {
    reach_m = std::max(reach_m, length(pose.world_from_sensor.translation -
                                       poses.front().world_from_sensor.translation));
    const Mat3d& turn = pose.world_from_sensor.rotation;
    const double up = std::max((turn * Vec3d{0, 0, 1}).z, (turn * vehicle_axis).z);
    tilts_deg.push_back(std::acos(std::clamp(up, -1.0, 1.0)) / kDegree);
  }
  std::array<char, 300> text{};
  if (reach_m < kStands_m) {
    std::snprintf(text.data(), text.size(),
                  ": the sensor stands still: its %zu poses span %.3f m; check that the file has "
                  "the positions",
                  poses.size(), reach_m);
    progress.warn(drive.trajectory.string() + text.data());
  }
  const double tilt_deg = upper_median_of(tilts_deg);
  if (tilt_deg > kTilted_deg) {
    std::snprintf(
        text.data(), text.size(),
        ": the axis of the sensor (its z) is %.0f deg from up in the median; if the poses "
        "are not those of the sensor, give `mount` and `mount_rotation`",
        tilt_deg);
    progress.warn(drive.trajectory.string() + text.data());
  }
}

/// Warns of a motion that no vehicle makes, between poses that are interpolated.
void warn_of_jump(const std::filesystem::path& file, const Trajectory& motion,
                  ProgressSink& progress) {
  std::error_code ignored;
  const bool has_no_times =
      std::filesystem::is_regular_file(file, ignored) && !is_recording(file) && !has_times(file);
  const auto jump = find_pose_jump(motion, !has_no_times);
  if (!jump) return;
  std::array<char, 100> times{};
  std::snprintf(times.data(), times.size(), ": between %.3f and %.3f s",
                motion[jump->later - 1].time_s, motion[jump->later].time_s);
  progress.warn(file.string() + times.data() + " the poses jump by " + jump->text() +
                "; scans there are simulated on the way; check that all poses are of one drive");
}

Trajectory every_nth(const Trajectory& all, const DriveOptions& drive) {
  Trajectory chosen;
  for (std::size_t i = 0; i < all.size(); i += drive.every) chosen.push_back(all[i]);
  if (chosen.empty()) throw Error(ErrorKind::data, drive.trajectory.string() + ": no poses");
  return chosen;
}

}  // namespace

std::vector<ScanMotion> scans_at(const DriveOptions& drive, const LidarModel& sensor,
                                 const DrivenPoses& driven, ProgressSink& progress) {
  const Trajectory poses = shifted(mounted(driven.poses, drive.mount), drive.offset_m);
  warn_of_poses(drive, poses, progress);
  if (!drive.rolling_shutter || fires_at_once(sensor)) return still_scans(poses);
  if (driven.motion.size() < 2)
    throw Error(ErrorKind::data,
                "a rolling shutter needs at least two poses, which define the motion");
  const double duration_s = 1 / sensor.rotation_hz;
  if (!drive.trajectory.empty())
    if (const std::string note = motion_ends_note(poses, driven.motion, duration_s); !note.empty())
      progress.warn((drive.motion.empty() ? drive.trajectory : drive.motion).string() + ": " +
                    note);
  return moving_scans(poses, mounted(driven.motion, drive.mount), duration_s);
}

void check_drive(const DriveOptions& drive) {
  check_settings(drive);
  const bool has_file = !drive.trajectory.empty(), has_path = !drive.path.empty();
  if (has_file + has_path + !drive.at.empty() != 1)
    throw Error(ErrorKind::usage, "give exactly one of `trajectory`, `at` or `path`");
  if (drive.rate_hz && drive.spacing_m)
    throw Error(ErrorKind::usage, "give `rate` or `spacing`, not both");
  if (!drive.motion.empty() && !drive.rolling_shutter)
    throw Error(ErrorKind::usage, "`motion` has no effect without `rolling_shutter`");
  const bool is_recorded = has_file && is_recording(drive.trajectory);
  require_effect(!drive.topic.empty(), is_recorded, "topic", "a recording as `trajectory`");
  require_effect(!drive.poses_topic.empty(), is_recorded, "poses_topic",
                 "a recording as `trajectory`");
  require_effect(!drive.motion.empty(), has_file, "motion", "`trajectory`");
  require_effect(drive.speed_mps.has_value(), has_path, "speed", "`path`");
  require_effect(drive.height_m.has_value(), !has_file, "height", "`at` or `path`");
  require_effect(drive.rate_hz.has_value(), drive.at.empty(), "rate", "`trajectory` or `path`");
  require_effect(drive.spacing_m.has_value(), drive.at.empty(), "spacing",
                 "`trajectory` or `path`");
  require_effect(drive.rolling_shutter, drive.at.empty(), "rolling_shutter",
                 "`trajectory` or `path`: with `at` the sensor is at rest");
  require_finite(drive);
}

DrivenPoses driven_poses(const DriveOptions& drive, ProgressSink& progress) {
  DrivenPoses driven;
  const std::optional<ScenarioPath> scenario = scenario_path(drive.trajectory);
  require_input(scenario ? scenario->file : drive.trajectory);
  if (is_recording(drive.trajectory)) {
    RecordedTrajectory recorded =
        trajectory_of_recording(drive.trajectory, drive.topic, drive.poses_topic, progress);
    progress.warn(drive.trajectory.string() + ": " + std::to_string(recorded.poses.size()) +
                  " poses " + recorded.by);
    driven = {std::move(recorded.poses), std::move(recorded.motion)};
  } else {
    driven.poses = driven.motion = load_trajectory(drive.trajectory);
  }
  if (!drive.motion.empty()) driven.motion = load_trajectory(drive.motion);
  return driven;
}

DrivenPoses poses_along(const DriveOptions& drive, ProgressSink& progress) {
  check_drive(drive);
  if (drive.trajectory.empty()) throw std::logic_error("poses_along: a path needs a model");
  DrivenPoses driven = driven_poses(drive, progress);
  if (drive.rate_hz || drive.spacing_m || drive.rolling_shutter)
    warn_of_jump(drive.motion.empty() ? drive.trajectory : drive.motion, driven.motion, progress);
  if (drive.rate_hz) driven.poses = resampled_by_time(driven.poses, *drive.rate_hz);
  if (drive.spacing_m) driven.poses = resampled_by_distance(driven.poses, *drive.spacing_m);
  driven.poses = every_nth(driven.poses, drive);
  return driven;
}

DrivenPoses poses_along(const DriveOptions& drive, const ModelScene& scene,
                        const Executor& executor, ProgressSink& progress) {
  if (!drive.trajectory.empty()) return poses_along(drive, progress);
  check_drive(drive);
  PathDrive path_drive;
  path_drive.height_m = drive.height_m.value_or(kRoofHeight_m);
  if (!drive.at.empty())
    return {every_nth(poses_at(scene, drive.at, path_drive.height_m, executor, progress), drive),
            {}};
  path_drive.speed_mps = drive.speed_mps.value_or(kTownSpeed_mps);
  path_drive.rate_hz = drive.rate_hz.value_or(kUsualRate_hz);
  path_drive.spacing_m = drive.spacing_m;
  const Trajectory poses = poses_on_path(scene, drive.path, path_drive, executor, progress);
  return {every_nth(poses, drive), poses};
}

}  // namespace adasplats
