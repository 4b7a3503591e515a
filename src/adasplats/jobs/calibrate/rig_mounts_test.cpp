// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/rig_mounts.h"

#include <gtest/gtest.h>

#include "adasplats/core/error.h"
#include "adasplats/core/recorded_progress_test.h"

namespace adasplats {
namespace {

constexpr const char* kRig = R"(body = [[1.4, 0, 0.75, 4.5, 1.8, 1.5]]
[[sensors]]
name = "top"
input = "top"
trajectory = "vehicle.csv"
mount = [1.2, -0.5, 1.9]
mount_rotation_deg = [90, 5, 180]
[[sensors]]
name = "front"
input = "front"
[[camera]]
name = "wide"
width = 640
height = 480
fx = 300
fy = 300
cx = 320
cy = 240
mount = [1.5, 0.25, 1.75]
mount_rotation_deg = [30, 10, -5]
)";

// Oracle: the place of a camera in the world before and after the calibration.
TEST(CalibratedRig, CamerasStayOnTheVehicle) {
  const Rig given = parse_rig(kRig, "car/rig.toml");
  const RigidTransform world_from_vehicle{rotation_from_yaw_pitch_roll(1, 0.1, 0.2), {50, 60, 7}};
  const MountCorrection correction{{0.01, -0.02, 0.015}, {0.1, 0, -0.05}};
  const RigidTransform world_from_first = world_from_vehicle *
                                          given.sensors[0].given_mount()->transform() *
                                          correction.given_from_mounted();
  RecordedProgress progress;
  const std::vector<RigMount> mounts = {{"top", {}, 0}, {"front", {{}, {2, 0, -1}}, 0.01}};
  const Rig rig = calibrated_rig(given, mounts, correction, "/out", progress);
  const Vec3d point{5, 1, 2};
  EXPECT_LT(length(world_from_first * (rig.cameras.at(0).vehicle_from_camera * point) -
                   world_from_vehicle * (given.cameras[0].vehicle_from_camera * point)),
            1e-9);
  // Boxes are parallel to the axes, and this sensor is turned.
  EXPECT_TRUE(rig.body.empty());
  ASSERT_EQ(progress.warnings.size(), 1U);
  EXPECT_NE(progress.warnings[0].find("has no `body`"), std::string::npos) << progress.warnings[0];
}

TEST(CalibratedRig, NeedsTheFrameOfCameras) {
  Rig rig = parse_rig(kRig, "car/rig.toml");
  require_frame_of_cameras(rig, "world (as stated)");
  rig.sensors[0].mount.reset();
  rig.sensors[0].mount_rotation_deg = {};
  require_frame_of_cameras(rig, "sensor's frame (as stated)");
  expect_error(ErrorKind::config, {"rig.toml", "'top'", "add `mount`"},
               [&] { require_frame_of_cameras(rig, "world (as stated)"); });
  rig.cameras.clear();
  require_frame_of_cameras(rig, "world (as stated)");
}

}  // namespace
}  // namespace adasplats
