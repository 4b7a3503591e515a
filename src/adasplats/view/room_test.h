// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "adasplats/view/view_scene.h"

namespace adasplats {

/// A floor of 20 m x 20 m at height 0 with a wall at x = 8 m, far from the world's origin, of disks
/// 0.1 m apart; and a layer of their centers with errors.
struct Room {
  Executor executor{1};
  ProgressSink progress;
  DeviceChoice device;
  Session session{executor, progress, 1, device};
  ModelScene model{splats(), std::nullopt, session};
  ViewScene view = make_view();

  static SplatModel splats() {
    SplatModel room;
    room.origin = {5000, 6000, 0};
    room.label_scheme = "semantickitti";
    const auto add = [&room](Vec3f center, Vec3f normal, std::uint16_t class_id) {
      room.disks.push_back({center, 0.09F, normal});
      room.classes.push_back(class_id);
      room.intensities.push_back(class_id == 40 ? 0.2F : 0.6F);
    };
    for (int i = -100; i < 100; ++i) {
      const float along = 0.1F * static_cast<float>(i) + 0.05F;
      for (int k = -100; k < 100; ++k)
        add({along, 0.1F * static_cast<float>(k) + 0.05F, 0}, {0, 0, 1}, 40);
      for (int k = 0; k < 40; ++k) add({8, along, 0.1F * static_cast<float>(k)}, {1, 0, 0}, 50);
    }
    return room;
  }

 private:
  ViewScene make_view() {
    ViewScene scene;
    scene.name = "room";
    scene.origin = model.origin();
    scene.place = &model;
    scene.model = &model;
    scene.labels = *model.labels();
    scene.middle_box = model.middle_box();
    scene.layers.push_back(splat_layer("room", *model.splats(), {}, scene.origin, executor));
    PointCloud cloud;
    cloud.origin = {4000, 6000, 0};
    std::vector<float> errors_m;
    for (const Disk& disk : model.splats()->disks) {
      cloud.positions.push_back(disk.center + Vec3f{1000, 0, 0});
      errors_m.push_back(0.01F);
    }
    scene.layers.push_back(point_layer("points", cloud, errors_m, scene.origin, executor));
    TimedPose pose;
    pose.world_from_sensor.translation = {5001.5, 6000, 1.7};
    scene.trajectories.push_back({"drive", {pose}});
    scene.start_pose = start_pose_of(scene, 1.8, executor);
    return scene;
  }
};

}  // namespace adasplats
