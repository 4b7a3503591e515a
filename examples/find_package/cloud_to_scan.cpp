// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Models a point cloud and simulates one scan in it: cloud_to_scan CLOUD POSES MODEL.ply SCAN.ply
#include "adasplats/adasplats.h"

using namespace adasplats;

int main(int, char** argv) {
  OwnSession session;  // all cores, and a GPU if available
  const std::vector<std::filesystem::path> files = {argv[1]};
  const auto [cloud, loaded] = load_cloud(files, {}, session.executor, session.progress);
  const auto [model, built] = make_model(cloud, {}, session);
  save_model(argv[3], model);

  const ModelScene scene(model, {}, session);
  const ScanSettings settings = {.sensor = load_lidar_model("velodyne-vlp-16")};
  ScanSimulator lidar(scene, settings, session.executor);
  const Trajectory poses = read_trajectory(argv[2]);
  write_scan_ply(argv[4], lidar.scan({.reference = poses.front()}, 0));
}
