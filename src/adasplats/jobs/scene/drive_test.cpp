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
  const auto warnings_of = [&](double step_m, const char* rotation) {
    std::string text = "time,x,y,z,qw,qx,qy,qz\n";
    for (int k = 0; k < 12; ++k)
      text += std::to_string(k) + "," + std::to_string(step_m * k) + ",0,0," + rotation + "\n";
    DriveOptions drive;
    drive.trajectory = folder.write("poses.csv", text);
    Listener listener;
    EXPECT_EQ(scans_along(drive, sensor, listener).size(), 12U);
    return listener.warnings;
  };
  EXPECT_EQ(warnings_of(1, "1,0,0,0"), "");
  EXPECT_NE(warnings_of(0, "1,0,0,0").find("its 12 poses span 0.000 m"), std::string::npos);
  EXPECT_NE(warnings_of(1, "0.70710678,0.70710678,0,0").find("is 90 deg from up"),
            std::string::npos);
}

}  // namespace
}  // namespace adasplats
