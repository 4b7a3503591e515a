// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/drive.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

TEST(DriveAlong, PosesThatStandOrLieOnTheirSideAreReported) {
  class Listener : public ProgressSink {
   public:
    void warn(std::string_view message) override { warnings += message; }
    std::string warnings;
  };
  const TemporaryFolder folder;
  const LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  const auto warnings_of = [&](double step_m, const char* rotation, Vec3d mount_deg = {}) {
    std::string text = "time,x,y,z,qw,qx,qy,qz\n";
    for (int k = 0; k < 12; ++k)
      text += std::to_string(k) + "," + std::to_string(step_m * k) + ",0,0," + rotation + "\n";
    DriveOptions drive;
    drive.trajectory = folder.write("poses.csv", text);
    drive.mount = MountSettings{{}, mount_deg}.transform();
    Listener listener;
    EXPECT_EQ(scans_along(drive, sensor, listener).size(), 12U);
    return listener.warnings;
  };
  EXPECT_EQ(warnings_of(1, "1,0,0,0"), "");
  EXPECT_NE(warnings_of(0, "1,0,0,0").find("its 12 poses span 0.000 m"), std::string::npos);
  EXPECT_NE(warnings_of(1, "0.70710678,0.70710678,0,0").find("is 90 deg from up"),
            std::string::npos);
  // A stated mount: upside down on upright poses; upright on poses of a camera; still on its side.
  EXPECT_EQ(warnings_of(1, "1,0,0,0", {0, 5, 180}), "");
  EXPECT_EQ(warnings_of(1, "0.70710678,0.70710678,0,0", {0, 0, -90}), "");
  EXPECT_NE(warnings_of(1, "0.70710678,0.70710678,0,0", {90, 0, 0}).find("deg from up"),
            std::string::npos);
}

TEST(DriveAlong, JumpsBetweenInterpolatedPosesAreReported) {
  class Listener : public ProgressSink {
   public:
    void warn(std::string_view message) override { warnings += message; }
    std::string warnings;
  };
  const TemporaryFolder folder;
  DriveOptions drive;
  drive.trajectory = folder.write("poses.csv",
                                  "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.1,1,0,0,1,0,0,0\n"
                                  "0.2,2,0,0,1,0,0,0\n0.3,56,0,0,1,0,0,0\n");
  Listener listener;
  scans_along(drive, load_lidar_model("velodyne-vlp-16"), listener);
  EXPECT_EQ(listener.warnings, "");  // nothing is between the poses
  drive.rate_hz = 20;
  scans_along(drive, load_lidar_model("velodyne-vlp-16"), listener);
  EXPECT_NE(listener.warnings.find("between 0.200 and 0.300 s the poses jump by 54.0 m within "
                                   "0.1 s (540 m/s"),
            std::string::npos)
      << listener.warnings;
}

}  // namespace
}  // namespace adasplats
