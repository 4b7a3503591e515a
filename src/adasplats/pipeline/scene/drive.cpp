// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/scene/drive.h"

#include "adasplats/core/error.h"
#include "adasplats/pipeline/session/inputs.h"

namespace adasplats {

Trajectory sensor_poses(const DriveOptions& drive) {
  check_settings(drive);
  if (drive.rate_hz && drive.spacing_m)
    throw Error(ErrorKind::usage, "`rate` and `spacing` cannot stand together");
  Trajectory all = load_trajectory(drive.trajectory);
  if (drive.rate_hz) all = resampled_by_time(all, *drive.rate_hz);
  if (drive.spacing_m) all = resampled_by_distance(all, *drive.spacing_m);
  Trajectory taken;
  for (std::size_t i = 0; i < all.size(); i += drive.every) taken.push_back(all[i]);
  if (taken.empty()) throw Error(ErrorKind::data, drive.trajectory.string() + ": no poses");
  return shifted(mounted(std::move(taken), drive.mount), drive.offset_m);
}

std::vector<ScanMotion> scans_along(const DriveOptions& drive, const LidarModel& sensor) {
  const Trajectory poses = sensor_poses(drive);
  if (!drive.rolling_shutter) {
    if (!drive.motion.empty())
      throw Error(ErrorKind::usage, "`motion` is of use with `rolling_shutter` alone");
    return still_scans(poses);
  }
  const Trajectory motion = load_trajectory(drive.motion.empty() ? drive.trajectory : drive.motion);
  if (motion.size() < 2)
    throw Error(ErrorKind::data, "a rolling shutter needs at least two poses to know the motion");
  return moving_scans(poses, mounted(motion, drive.mount), 1 / sensor.rotation_hz);
}

}  // namespace adasplats
