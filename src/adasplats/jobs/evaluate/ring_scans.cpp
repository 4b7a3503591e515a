// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/ring_scans.h"

#include <algorithm>
#include <utility>

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/realism/features.h"
#include "adasplats/evaluate/realism/ring_scan.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

constexpr std::size_t kStepScans = 8;  // for the azimuth step: they agree to 1 %

}  // namespace

bool needs_trajectory(const std::filesystem::path& given) {
  return !is_self_contained_drive(given) && !is_kitti_sequence(resolve_cloud_input(given)) &&
         !std::filesystem::exists(given / "poses.csv");
}

KittiSequence open_ring_scans(const std::filesystem::path& given,
                              const std::filesystem::path& trajectory, Session& session) {
  require_input(given);
  if (is_self_contained_drive(given)) {
    DriveInput drive;
    drive.folder = given;
    drive.trajectory = trajectory;
    drive.with_classes = false;
    return open_drive(drive, session.executor, session.progress).value();
  }
  if (!std::filesystem::is_directory(given))
    throw Error(ErrorKind::usage,
                given.string() + ": is a file, expected a sequence or a folder of scans");
  const std::filesystem::path folder = resolve_cloud_input(given);
  if (is_kitti_sequence(folder) && (trajectory.empty() || !lacks_poses(folder))) {
    KittiSequence sequence = open_kitti_sequence(folder);
    sequence.beams = recognize_beams(sequence, session.executor);
    return sequence;
  }
  const std::filesystem::path own = given / "poses.csv";
  DriveInput drive;
  drive.folder = given;
  drive.trajectory = std::filesystem::exists(own) ? own : trajectory;
  drive.with_classes = false;
  if (drive.trajectory.empty())
    throw Error(ErrorKind::usage, given.string() +
                                      ": the scans have no poses; add a poses.csv to the folder or "
                                      "give a `trajectory`");
  auto opened = open_drive(drive, session.executor, session.progress);
  if (!opened)
    throw Error(ErrorKind::data,
                given.string() +
                    ": is not a folder of scans with a pose each, so points cannot be "
                    "assigned to beams");
  return std::move(*opened);
}

std::vector<double> laser_heights_m(const LidarModel& sensor) {
  std::vector<double> heights_m(sensor.rings(), 0);
  for (std::size_t ring = 0; ring < std::min(heights_m.size(), sensor.beam_origins_m.size());
       ++ring)
    heights_m[ring] = sensor.beam_origins_m[ring].z;
  return heights_m;
}

double firing_step_rad(const KittiSequence& sequence, std::span<const std::size_t> chosen,
                       std::span<const double> heights_m, const std::string& name) {
  std::vector<double> steps_rad;
  const std::size_t scans = std::min(kStepScans, chosen.size());
  for (std::size_t k = 0; k < scans; ++k) {
    const std::size_t index = chosen[k * chosen.size() / scans];
    const RingScan scan =
        arrange_in_rings(sequence, index, read_all_returns(sequence, index), heights_m);
    const double step_rad = azimuth_step_rad(scan);
    if (step_rad > 0) steps_rad.push_back(step_rad);
  }
  const double step_rad = median_of_known(std::move(steps_rad));
  // A turn of fewer than 64 steps has no patch; no LiDAR has steps below 0.01 degrees.
  if (step_rad > 0.01 * kDegree && step_rad < 360 * kDegree / static_cast<double>(kPatchColumns))
    return step_rad;
  throw Error(ErrorKind::data, name + ", " + sequence.folder.string() +
                                   ": the azimuth step between a ring's firings cannot be "
                                   "estimated");
}

}  // namespace adasplats
