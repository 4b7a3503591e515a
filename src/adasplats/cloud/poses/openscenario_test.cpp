// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/openscenario.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

std::string trajectory_of(const std::string& name, const std::string& vertices) {
  return "<Trajectory name=\"" + name + "\" closed=\"false\"><Shape><Polyline>" + vertices +
         "</Polyline></Shape></Trajectory>";
}

std::string vertex(const std::string& time, const std::string& position) {
  return "<Vertex time=\"" + time + "\"><Position><WorldPosition " + position +
         "/></Position></Vertex>\n";
}

std::string scenario(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<OpenSCENARIO><Storyboard><FollowTrajectoryAction>\n" + content +
         "</FollowTrajectoryAction></Storyboard></OpenSCENARIO>\n";
}

std::string message_of(const TemporaryFolder& folder, const std::string& content,
                       const std::string& name = "") {
  folder.write("a.xosc", content);
  try {
    read_scenario({folder.path() / "a.xosc", name});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data);
    const std::string text = error.what();
    return text.substr(text.rfind('/') + 1);
  }
  return "none";
}

TEST(OpenScenario, VerticesArePoses) {
  const TemporaryFolder folder;
  folder.write("a.xosc", scenario("<TrajectoryRef>" +
                                  trajectory_of("cut-in", vertex("0", "x=\"1\" y=\"2\"") +
                                                              vertex("1.5",
                                                                     "x=\"4\" y=\"5\" "
                                                                     "z=\"6\" h=\"1.57\"")) +
                                  "</TrajectoryRef><TimeReference><Timing "
                                  "domainAbsoluteRelative=\"absolute\" scale=\"1.0\" "
                                  "offset=\"0.0\"/></TimeReference>"));
  const Trajectory poses = read_trajectory(folder.path() / "a.xosc");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].time_s, 1.5);
  EXPECT_EQ(poses[0].world_from_sensor.translation, (Vec3d{1, 2, 0}));
  EXPECT_EQ(poses[1].world_from_sensor.translation, (Vec3d{4, 5, 6}));
  const Vec3d ahead = poses[1].world_from_sensor.rotation * Vec3d{1, 0, 0};
  EXPECT_NEAR(ahead.y, 1, 1e-4);
  EXPECT_EQ(poses[0].world_from_sensor.rotation * (Vec3d{1, 0, 0}), (Vec3d{1, 0, 0}));
  EXPECT_TRUE(has_times(folder.path() / "a.xosc"));
}

TEST(OpenScenario, WithoutHeadingsPosesLookWhereTheyGo) {
  const TemporaryFolder folder;
  folder.write("a.xosc", scenario(trajectory_of("a", vertex("0", "x=\"0\" y=\"0\"") +
                                                         vertex("1", "x=\"0\" y=\"3\"") +
                                                         vertex("2", "x=\"0\" y=\"3\""))));
  for (const TimedPose& pose : read_scenario({folder.path() / "a.xosc", ""}))
    EXPECT_NEAR((pose.world_from_sensor.rotation * Vec3d{1, 0, 0}).y, 1, 1e-9);
}

TEST(OpenScenario, OneOfSeveralIsChosenByItsName) {
  const TemporaryFolder folder;
  const std::string both = scenario(trajectory_of("a", vertex("0", "x=\"1\" y=\"0\"")) +
                                    trajectory_of("b", vertex("0", "x=\"2\" y=\"0\"")));
  folder.write("both.xosc", both);
  expect_error(ErrorKind::data, {"both.xosc: has several trajectories, a, b; choose one as "},
               [&] { read_trajectory(folder.path() / "both.xosc"); });
  EXPECT_EQ(message_of(folder, both, "c"), "a.xosc: has no trajectory 'c', but a, b");
  const Trajectory poses = read_trajectory((folder.path() / "a.xosc").string() + ":b");
  EXPECT_EQ(poses.front().world_from_sensor.translation.x, 2);
}

TEST(OpenScenario, FaultsAreErrorsWithTheLine) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of(folder, "<OpenSCENARIO>").substr(0, 30), "a.xosc:1: no well-formed XML: ");
  EXPECT_EQ(message_of(folder, "<a/>"), "a.xosc: has no element OpenSCENARIO");
  EXPECT_EQ(message_of(folder, scenario("")), "a.xosc: has no Trajectory");
  EXPECT_EQ(
      message_of(folder, scenario("<Trajectory name=\"a\"><Shape><Nurbs/></Shape></Trajectory>")),
      "a.xosc:3: Trajectory its shape is no Polyline");
  EXPECT_EQ(message_of(folder, scenario(trajectory_of("a", ""))),
            "a.xosc:3: Polyline has no Vertex");
  EXPECT_EQ(message_of(folder, scenario(trajectory_of("a", vertex("0", "x=\"1\" y=\"$y\"")))),
            "a.xosc:3: WorldPosition y '$y' is no finite number");
  EXPECT_EQ(message_of(folder, scenario(trajectory_of("a", vertex("0", "x=\"1\"")))),
            "a.xosc:3: WorldPosition has no y");
  EXPECT_EQ(message_of(folder, scenario(trajectory_of("a", vertex("1", "x=\"1\" y=\"1\"") +
                                                               vertex("1", "x=\"1\" y=\"1\"")))),
            "a.xosc:4: Vertex its time does not come after the one before");
  EXPECT_EQ(
      message_of(folder,
                 scenario(trajectory_of(
                     "a", "<Vertex time=\"0\"><Position><LanePosition/></Position></Vertex>"))),
      "a.xosc:3: Vertex has no WorldPosition; other positions need a road network");
  EXPECT_EQ(message_of(folder, scenario(trajectory_of("a", vertex("0", "x=\"1\" y=\"1\"")) +
                                        "<TimeReference><Timing scale=\"2\" "
                                        "offset=\"0\"/></TimeReference>"))
                .substr(0, 39),
            "a.xosc:4: Timing scales or shifts times");
}

}  // namespace
}  // namespace adasplats
