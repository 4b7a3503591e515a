// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/box_files.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/arrow/arrow_writer_test.h"
#include "adasplats/io/pickle/data_frame.h"
#include "adasplats/io/pickle/gzip.h"

namespace adasplats {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRightAngle_rad = std::numbers::pi / 2;

BoxTrack track_along(const std::vector<std::pair<double, double>>& times_and_places) {
  BoxTrack track;
  for (const auto& [time_s, x] : times_and_places)
    track.boxes.push_back({time_s, {x, 0, 0}, {2, 1, 1}, 0});
  return track;
}

TEST(BoxFiles, AnObjectMovesByMoreThanAMetreFasterThanHalfAMetreASecond) {
  EXPECT_FALSE(moves_by_boxes(track_along({{0, 5}})));
  EXPECT_FALSE(moves_by_boxes(track_along({{0, 0}, {1, 0.9}})));
  EXPECT_TRUE(moves_by_boxes(track_along({{0, 0}, {1, 1.1}})));
  EXPECT_FALSE(moves_by_boxes(track_along({{0, 0}, {1, 0.9}, {2, 0}, {3, 0.9}})));
  EXPECT_FALSE(moves_by_boxes(track_along({{0, 0}, {10, 1}, {20, 2}, {30, 3}})));  // drift
  EXPECT_TRUE(moves_by_boxes(track_along({{0, 0}, {60, 0}, {61, 1.5}})));  // at a traffic light
}

// PandaSet

struct TestCuboid {
  std::string uuid = "a";
  Vec3d at;
  bool is_stationary = false;
  std::int64_t lidar = -1;
  std::string sibling;
  double yaw = 0;
  Vec3d size = {2, 5, 1.5};
};

std::string cuboid_file(const std::vector<TestCuboid>& cuboids) {
  std::vector<std::string> uuids, labels, siblings;
  std::vector<double> yaws, x, y, z, width, length, height;
  std::vector<bool> stationary;
  std::vector<std::int64_t> lidars;
  for (const TestCuboid& one : cuboids) {
    uuids.push_back(one.uuid);
    labels.emplace_back("Car");
    siblings.push_back(one.sibling);
    yaws.push_back(one.yaw);
    x.push_back(one.at.x), y.push_back(one.at.y), z.push_back(one.at.z);
    width.push_back(one.size.x), length.push_back(one.size.y), height.push_back(one.size.z);
    stationary.push_back(one.is_stationary);
    lidars.push_back(one.lidar);
  }
  const std::vector<FrameColumn> columns = {{"uuid", uuids},
                                            {"label", labels},
                                            {"yaw", yaws},
                                            {"stationary", stationary},
                                            {"position.x", x},
                                            {"position.y", y},
                                            {"position.z", z},
                                            {"dimensions.x", width},
                                            {"dimensions.y", length},
                                            {"dimensions.z", height},
                                            {"cuboids.sibling_id", siblings},
                                            {"cuboids.sensor_id", lidars}};
  return gzipped(pickled_data_frame(columns));
}

/// A PandaSet sequence of cuboids alone, 0.1 s apart.
class CuboidFolder {
 public:
  explicit CuboidFolder(const std::vector<std::vector<TestCuboid>>& frames,
                        const std::string& times = "") {
    nlohmann::json stamps = nlohmann::json::array();
    for (std::size_t k = 0; k < frames.size(); ++k) {
      folder_.write("annotations/cuboids/0" + std::to_string(k) + ".pkl.gz",
                    cuboid_file(frames[k]));
      stamps.push_back(10 + 0.1 * static_cast<double>(k));
    }
    folder_.write("lidar/timestamps.json", times.empty() ? stamps.dump() : times);
  }

  const TemporaryFolder& folder() const { return folder_; }
  const std::filesystem::path& path() const { return folder_.path(); }
  MovingBoxes read(const std::string& lidar = "") const {
    return MovingBoxes(read_box_file(folder_.path(), {{}, {}, lidar, ""}));
  }

 private:
  TemporaryFolder folder_;
};

// Oracle: pandaset-devkit: "0 radians is equivalent to the direction of the vector (0, 1, 0). The
// vector points at the length-side. ... PI/2 is pointing in the same direction as (-1, 0, 0)."
TEST(BoxFiles, CuboidsOfPandaSetHaveTheirLengthAlongTheTurnedYAxis) {
  const CuboidFolder straight({{{.at = {7, 8, 9}}}});
  const MovingBoxes boxes = straight.read();
  ASSERT_EQ(boxes.tracks().size(), 1U);
  EXPECT_EQ(boxes.tracks()[0].label, "Car");
  EXPECT_EQ(boxes.object_at(10, {7, 10.4, 9}), 1);
  EXPECT_EQ(boxes.object_at(10, {9.4, 8, 9}), 0);
  EXPECT_EQ(boxes.object_at(10, {7, 8, 9.8}), 1);
  EXPECT_EQ(boxes.object_at(10, {7, 8, 10.1}), 0);
  const CuboidFolder turned({{{.at = {7, 8, 9}, .yaw = kRightAngle_rad}}});
  EXPECT_EQ(turned.read().object_at(10, {4.6, 8, 9}), 1);
  EXPECT_EQ(turned.read().object_at(10, {7, 10.4, 9}), 0);
  const CuboidFolder oblique({{{.at = {0, 0, 0}, .yaw = kRightAngle_rad / 2}}});
  EXPECT_EQ(oblique.read().object_at(10, {-1.7, 1.7, 0}), 1);
  EXPECT_EQ(oblique.read().object_at(10, {1.7, 1.7, 0}), 0);
}

TEST(BoxFiles, ObjectsOfPandaSetAreNumberedByTheirFirstAppearance) {
  const CuboidFolder court(
      {{{.uuid = "z", .at = {0, 0, 0}, .is_stationary = true}, {.uuid = "y", .at = {10, 0, 0}}},
       {{.uuid = "b", .at = {20, 0, 0}}, {.uuid = "y", .at = {12, 0, 0}}}});
  for (const char* part : {"", "annotations", "annotations/cuboids", "annotations/cuboids/"}) {
    const MovingBoxes boxes(read_box_file(court.path() / part, {}));
    ASSERT_EQ(boxes.tracks().size(), 2U);
    EXPECT_EQ(boxes.tracks()[0].id, 2U);
    EXPECT_EQ(boxes.tracks()[1].id, 3U);
    ASSERT_EQ(boxes.tracks()[0].boxes.size(), 2U);
    EXPECT_EQ(boxes.tracks()[0].boxes[1].time_s, 10.1);
    EXPECT_EQ(boxes.tracks()[0].boxes[1].middle.x, 12);
    EXPECT_TRUE(boxes.overlaps(10.05, 20));
    EXPECT_FALSE(boxes.overlaps(10.2, 20));
    EXPECT_TRUE(boxes.are_of_scans());
  }
}

// Frame 0: the Pandar64 alone; frame 1: both; frame 2: the PandarGT alone.
TEST(BoxFiles, SiblingsOfPandaSetAreOneObject) {
  const CuboidFolder court({{{.uuid = "a", .at = {0, 0, 0}}},
                            {{.uuid = "b", .at = {3, 0, 0}, .lidar = 1, .sibling = "a"},
                             {.uuid = "a", .at = {2, 0, 0}, .lidar = 0, .sibling = "b"}},
                            {{.uuid = "b", .at = {5, 0, 0}}}});
  const auto places = [&](const std::string& lidar) {
    const MovingBoxes boxes = court.read(lidar);
    std::vector<double> x;
    EXPECT_EQ(boxes.tracks().size(), 1U);
    for (const TimedBox& box : boxes.tracks()[0].boxes) x.push_back(box.middle.x);
    return x;
  };
  EXPECT_EQ(places(""), (std::vector<double>{0, 2, 5}));
  EXPECT_EQ(places("pandar64"), (std::vector<double>{0, 2, 5}));
  EXPECT_EQ(places("pandargt"), (std::vector<double>{0, 3, 5}));
}

TEST(BoxFiles, TwoCuboidsOfOneLidarInAFrameAreTwoObjects) {
  const CuboidFolder court({{{.uuid = "a", .at = {0, 0, 0}, .lidar = 0, .sibling = "b"},
                             {.uuid = "b", .at = {0, 0, 0}, .lidar = 1, .sibling = "a"}},
                            {{.uuid = "a", .at = {2, 0, 0}}, {.uuid = "b", .at = {9, 0, 0}}}});
  EXPECT_EQ(court.read().tracks().size(), 2U);
}

TEST(BoxFiles, TimesOfPandaSetMayBeThoseOfMeta) {
  const CuboidFolder court({{{.at = {7, 8, 9}}}});
  std::filesystem::remove(court.path() / "lidar/timestamps.json");
  expect_error(ErrorKind::no_input, {"timestamps.json"}, [&] { court.read(); });
  court.folder().write("meta/timestamps.json", "[44.5]");
  EXPECT_EQ(court.read().tracks()[0].boxes[0].time_s, 44.5);
}

TEST(BoxFiles, WrongCuboidsAreNamed) {
  const auto reject = [](const std::vector<TestCuboid>& frame, const std::string& part) {
    const CuboidFolder court({{{}}, frame});
    expect_error(ErrorKind::data, {"01.pkl.gz: cuboid ", part}, [&] { court.read(); });
  };
  reject({{.at = {kNan, 0, 0}}}, "not finite");
  reject({{.yaw = kNan}}, "not finite");
  reject({{.size = {2, 0, 1}}}, "uuid a: the size");
  reject({{.lidar = 5}}, "cuboids.sensor_id is 5");
  reject({{.uuid = ""}}, "has no uuid");
  reject({{.at = {1, 0, 0}}, {.at = {2, 0, 0}}}, "cuboid 1 (from 0), uuid a: object 1 has two");
  const CuboidFolder few({{{}}, {{}}}, "[0]");
  expect_error(ErrorKind::data, {"01.pkl.gz: this frame has no time", "has 1 times"},
               [&] { few.read(); });
  const CuboidFolder many({{{}}, {{}}}, "[0, 1, 2]");
  expect_error(ErrorKind::data, {"frame 2 is missing"}, [&] { many.read(); });
  const CuboidFolder none(std::vector<std::vector<TestCuboid>>(2));
  expect_error(ErrorKind::data, {"has no boxes"}, [&] { none.read(); });
  expect_error(ErrorKind::data, {"one frame of PandaSet"}, [&] {
    MovingBoxes(read_box_file(many.path() / "annotations/cuboids/00.pkl.gz", {}));
  });
  const std::vector<FrameColumn> columns = {{"uuid", std::vector<std::string>{"a"}}};
  many.folder().write("annotations/cuboids/02.pkl.gz", gzipped(pickled_data_frame(columns)));
  expect_error(ErrorKind::data, {"02.pkl.gz: has no column of texts 'label'"},
               [&] { many.read(); });
}

// Argoverse 2

struct Av2Rows {
  std::vector<std::int64_t> stamps;
  std::vector<std::string> tracks;
  std::vector<double> qw, qx, qy, qz, x, y, z, length, width, height;

  void add(std::int64_t stamp, const std::string& track, const RigidTransform& pose,
           Vec3d size = {4, 2, 1.5}) {
    stamps.push_back(stamp), tracks.push_back(track);
    const Quaternion q = quaternion_from_rotation(pose.rotation);
    qw.push_back(q.w), qx.push_back(q.x), qy.push_back(q.y), qz.push_back(q.z);
    const Vec3d at = pose.translation;
    x.push_back(at.x), y.push_back(at.y), z.push_back(at.z);
    length.push_back(size.x), width.push_back(size.y), height.push_back(size.z);
  }
  std::string file(bool is_boxes) const {
    using arrow_test::numbers;
    std::vector<arrow_test::ArrowColumn> columns = {
        numbers("timestamp_ns", stamps),
        numbers("qw", qw),
        numbers("qx", qx),
        numbers("qy", qy),
        numbers("qz", qz),
        numbers("tx_m", x),
        numbers("ty_m", y),
        numbers("tz_m", z),
    };
    if (is_boxes) {
      columns.push_back(arrow_test::texts("track_uuid", tracks));
      columns.push_back(
          arrow_test::texts("category", std::vector<std::string>(tracks.size(), "BUS")));
      columns.push_back(numbers("length_m", length));
      columns.push_back(numbers("width_m", width));
      columns.push_back(numbers("height_m", height));
    }
    return arrow_test::arrow_file({columns});
  }
};

constexpr std::int64_t kStamp_ns = 315'966'265'259'836'000, kTenth_ns = 100'000'000;

/// The vehicle drives at 20 m/s to the north; its x axis points there.
RigidTransform av2_vehicle(int k) {
  return {rotation_from_yaw_pitch_roll(kRightAngle_rad, 0, 0), {100, 2.0 * k, 5}};
}

/// A log of poses and boxes alone.
class Av2Log {
 public:
  explicit Av2Log(const Av2Rows& boxes) {
    Av2Rows vehicle;
    for (int k = 0; k < 3; ++k) vehicle.add(kStamp_ns + k * kTenth_ns, "", av2_vehicle(k));
    folder.write("city_SE3_egovehicle.feather", vehicle.file(false));
    folder.write("annotations.feather", boxes.file(true));
  }

  TemporaryFolder folder;
};

// Oracle: where the objects are in the city. One stands there, one drives with the vehicle, and one
// is ahead of the others in the file but later.
TEST(BoxFiles, BoxesOfArgoverseAreBroughtToTheCity) {
  const RigidTransform standing = {rotation_from_yaw_pitch_roll(0.3, 0, 0), {110, 20, 5.5}};
  const RigidTransform ahead = {rotation_from_yaw_pitch_roll(0, 0, 0), {10, 3, 0.5}};
  Av2Rows rows;
  rows.add(kStamp_ns + 2 * kTenth_ns, "late", ahead);
  for (int k = 0; k < 3; ++k) {
    rows.add(kStamp_ns + k * kTenth_ns, "parked", av2_vehicle(k).inverse() * standing);
    rows.add(kStamp_ns + k * kTenth_ns, "driving", ahead);
  }
  const Av2Log log(rows);
  for (const char* part : {"", "annotations.feather"}) {
    const MovingBoxes boxes(read_box_file(log.folder.path() / part, {}));
    ASSERT_EQ(boxes.tracks().size(), 1U);  // "late" has one box
    const BoxTrack& driving = boxes.tracks()[0];
    EXPECT_EQ(driving.id, 2U);
    EXPECT_EQ(driving.label, "BUS");
    ASSERT_EQ(driving.boxes.size(), 3U);
    EXPECT_EQ(driving.boxes[1].time_s, 1e-9 * static_cast<double>(kStamp_ns + kTenth_ns));
    EXPECT_LT(length(driving.boxes[1].middle - Vec3d{97, 12, 5.5}), 1e-9);
    EXPECT_NEAR(driving.boxes[1].yaw_rad, kRightAngle_rad, 1e-9);
    EXPECT_EQ(boxes.object_at(driving.boxes[1].time_s, {97, 13.9, 5.5}), 1);
    EXPECT_EQ(boxes.object_at(driving.boxes[1].time_s, {98.9, 12, 5.5}), 0);
  }
}

TEST(BoxFiles, WrongBoxesOfArgoverseAreNamed) {
  const RigidTransform ahead = {{}, {10, 3, 0.5}};
  const auto reject = [&](std::int64_t stamp, Vec3d size, const std::string& part) {
    Av2Rows rows;
    rows.add(kStamp_ns, "t1", ahead);
    rows.add(stamp, "t1", ahead, size);
    const Av2Log log(rows);
    expect_error(ErrorKind::data, {"annotations.feather: row 1 (from 0), track t1", part}, [&] {
      MovingBoxes(read_box_file(log.folder.path() / "annotations.feather", {}));
    });
  };
  reject(kStamp_ns, {4, 2, 1}, "object 1 has two boxes");
  reject(kStamp_ns + 1, {4, 2, 1}, "has no pose at its stamp 315966265259836001");
  reject(kStamp_ns + kTenth_ns, {4, -2, 1}, "the size of the box is not positive");
  reject(kStamp_ns + kTenth_ns, {4, kNan, 1}, "the size of the box is not positive");
  Av2Rows rows;
  rows.add(kStamp_ns, "t1", ahead);
  const Av2Log log(rows);
  std::filesystem::remove(log.folder.path() / "city_SE3_egovehicle.feather");
  expect_error(ErrorKind::no_input, {"city_SE3_egovehicle.feather: is missing"},
               [&] { MovingBoxes(read_box_file(log.folder.path(), {})); });
  log.folder.write("annotations.feather", rows.file(false));
  expect_error(ErrorKind::data, {"no column of numbers 'length_m'"},
               [&] { MovingBoxes(read_box_file(log.folder.path(), {})); });
}

// KITTI

std::string tracklet_pose(Vec3d foot, double rz) {
  std::array<char, 400> text{};
  std::snprintf(
      text.data(), text.size(),
      "\t\t\t<item>\n<tx>%.9f</tx>\n<ty>%.9f</ty>\n<tz>%.9f</tz>\n<rx>0</rx>\n<ry>0</ry>\n"
      "<rz>%.9f</rz>\n<state>2</state>\n<occlusion>0</occlusion>\n</item>\n",
      foot.x, foot.y, foot.z, rz);
  return text.data();
}

/// As boost writes it.
std::string tracklet(const std::vector<std::string>& poses, int first_frame,
                     const std::string& size = "<h>1.5</h>\n<w>2</w>\n<l>4</l>\n") {
  std::string text =
      "\t<item class_id=\"1\" tracking_level=\"0\" version=\"1\">\n" +
      std::string("\t\t<objectType>Van</objectType>\n") + size + "\t\t<first_frame>" +
      std::to_string(first_frame) + "</first_frame>\n" +
      "\t\t<poses class_id=\"2\" tracking_level=\"0\" version=\"0\">\n\t\t\t<count>" +
      std::to_string(poses.size()) + "</count>\n<item_version>2</item_version>\n";
  for (const std::string& pose : poses) text += pose;
  return text + "\t\t</poses>\n\t\t<finished>1</finished>\n\t</item>\n";
}

std::string tracklet_file(const std::vector<std::string>& tracklets) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"9\">\n"
      "<tracklets class_id=\"0\" tracking_level=\"0\" version=\"0\">\n\t<count>" +
      std::to_string(tracklets.size()) + "</count>\n\t<item_version>1</item_version>\n";
  for (const std::string& one : tracklets) text += one;
  return text + "</tracklets>\n</boost_serialization>\n";
}

/// Scans 0, 1 and 3 of a drive to the north at 10 m/s.
BoxDrive drive_of_tracklets() {
  BoxDrive drive;
  for (const int k : {0, 1, 3}) {
    drive.scans.push_back("data/000000000" + std::to_string(k) + ".bin");
    drive.poses.push_back(
        {100 + 0.1 * k,
         {rotation_from_yaw_pitch_roll(kRightAngle_rad, 0, 0), {1000, 1.0 * k, 50}}});
  }
  return drive;
}

// Oracle: the devkit's corners: x is +-l/2, y +-w/2 and z 0 to h, turned by rz, and moved to t, in
// the frame of the LiDAR.
TEST(BoxFiles, TrackletsStandOnTheirPositions) {
  const TemporaryFolder folder;
  // Ahead, 12 m and later 12.6 m away: it drives at 13 m/s; the other one stands.
  std::vector<std::string> ahead, parked;
  for (int k = 0; k < 4; ++k) {
    ahead.push_back(tracklet_pose({12 + 0.3 * k, 0, -1.7}, 0));
    parked.push_back(tracklet_pose({20 - 1.0 * k, 5, -1.7}, 0.2));
  }
  folder.write("tracklet_labels.xml", tracklet_file({tracklet(parked, 0), tracklet(ahead, 0)}));
  for (const char* part : {"", "tracklet_labels.xml"}) {
    const MovingBoxes boxes(read_box_file(folder.path() / part, drive_of_tracklets()));
    ASSERT_EQ(boxes.tracks().size(), 1U);
    const BoxTrack& track = boxes.tracks()[0];
    EXPECT_EQ(track.id, 2U);
    EXPECT_EQ(track.label, "Van");
    ASSERT_EQ(track.boxes.size(), 3U);  // scan 2 is missing
    EXPECT_EQ(track.boxes[2].time_s, 100 + 0.1 * 3);
    EXPECT_LT(length(track.boxes[2].middle - Vec3d{1000, 3 + 12.9, 50 - 1.7 + 0.75}), 1e-9);
    EXPECT_EQ(boxes.object_at(100.1, {1000, 15.2, 48.4}), 1);
    EXPECT_EQ(boxes.object_at(100.1, {1001.9, 13.3, 48.4}), 0);
    EXPECT_EQ(boxes.object_at(100.1, {1000, 13.3, 48.0}), 0);
    EXPECT_TRUE(is_of_numbered_scans(folder.path() / part));
  }
}

TEST(BoxFiles, WrongTrackletsAreNamed) {
  const TemporaryFolder folder;
  const std::string pose = tracklet_pose({12, 0, -1.7}, 0);
  const auto reject = [&](const std::string& text, const std::vector<std::string>& parts) {
    const auto file = folder.write("t.xml", text);
    expect_error(ErrorKind::data, parts,
                 [&] { MovingBoxes(read_box_file(file, drive_of_tracklets())); });
  };
  std::string nan = pose;
  nan.replace(nan.find("<ty>") + 4, 3, "nan ");
  reject(tracklet_file({tracklet({pose, nan}, 0)}),
         {"t.xml:26: tracklet 1: <ty> is 'nan 00000000', expected a finite number"});
  reject(tracklet_file({tracklet({pose}, 0), tracklet({pose, pose}, 3)}),
         {"tracklet 2: is in frame 4, but the drive has the scans 0 to 3"});
  reject(tracklet_file({tracklet({pose}, 0, "<h>1</h><w>0</w><l>4</l>")}),
         {"tracklet 1: the size of the box is not positive"});
  reject(tracklet_file({tracklet({pose}, 0, "<h>1</h><l>4</l>")}), {"tracklet 1: <w> is ''"});
  reject(tracklet_file({tracklet({pose}, -1)}), {"tracklet 1: <first_frame> is '-1'"});
  std::string lacking = tracklet_file({tracklet({pose, pose}, 0)});
  lacking.erase(lacking.find(pose), pose.size());
  reject(lacking, {"<count> is 2, but <poses> has 1 items"});
  reject(lacking.substr(0, lacking.size() - 30), {"t.xml:", "no well-formed XML"});
  reject("<annotation/>", {"has no <tracklets>"});
  reject(tracklet_file({}), {"t.xml: has no boxes"});
  const auto file = folder.write("t.xml", tracklet_file({tracklet({pose}, 0)}));
  expect_error(ErrorKind::data, {"KITTI raw drive"},
               [&] { MovingBoxes boxes(read_box_file(file, {})); });
  BoxDrive extracted = drive_of_tracklets();
  for (std::filesystem::path& scan : extracted.scans) scan.replace_extension(".txt");
  expect_error(ErrorKind::data, {"synchronised", "0.txt"},
               [&] { MovingBoxes(read_box_file(file, extracted)); });
}

/// A KITTI raw drive at rest with two points a scan: one 12 m ahead, one to the left.
KittiSequence with_boxes(KittiSequence drive, const DriveSettings& settings) {
  ProgressSink quiet;
  add_boxes(settings, {}, drive, Executor(1), quiet);
  return drive;
}

void write_raw_drive(const TemporaryFolder& folder, const std::string& name) {
  std::string stamps;
  for (int k = 0; k < 4; ++k) {
    const std::string number = "000000000" + std::to_string(k);
    stamps += "2011-09-26 13:02:2" + std::to_string(k) + ".000000000\n";
    folder.write(name + "/velodyne_points/data/" + number + ".bin",
                 std::vector<float>{12, 0, -1, 0.25F, 0, 7, -1, 0.5F});
    folder.write(name + "/oxts/data/" + number + ".txt",
                 "49 8.4000" + std::to_string(k) + " 115.5 0 0 0 -1 0 0 0\n");
  }
  folder.write(name + "/velodyne_points/timestamps.txt", stamps);
  folder.write(name + "/oxts/timestamps.txt", stamps);
  folder.write("calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  std::vector<std::string> ahead(4, tracklet_pose({12, 0, -1.7}, 0));
  folder.write(name + "/tracklet_labels.xml", tracklet_file({tracklet(ahead, 0)}));
}

TEST(BoxFiles, ScansOfKittiRawLeaveOutWhatIsInTracklets) {
  const TemporaryFolder folder;
  write_raw_drive(folder, "drive");
  DriveSettings settings;
  const KittiSequence plain = with_boxes(open_kitti_sequence(folder.path() / "drive"), settings);
  EXPECT_EQ(plain.boxes, nullptr);
  settings.boxes = folder.path() / "drive";
  const KittiSequence sequence = with_boxes(open_kitti_sequence(folder.path() / "drive"), settings);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(read_all_returns(sequence, k).in_boxes, (std::vector<std::uint16_t>{1, 0}));
    const KittiScan left = read_kitti_points(sequence, k);
    ASSERT_EQ(left.positions.size(), 1U);
    EXPECT_EQ(left.positions[0], (Vec3f{0, 7, -1}));
    EXPECT_EQ(left.intensities, (std::vector<float>{0.5F}));
  }
}

TEST(BoxFiles, LoadingAKittiRawDriveCountsThePointsInTracklets) {
  const TemporaryFolder folder;
  write_raw_drive(folder, "drive");
  LoadOptions options;
  options.own_body_m = options.driven_path_m = 0;
  options.boxes = folder.path() / "drive/tracklet_labels.xml";
  ProgressSink quiet;
  const std::vector<std::filesystem::path> inputs = {folder.path() / "drive"};
  const auto [cloud, report] = load_cloud(inputs, options, Executor(1), quiet);
  EXPECT_EQ(cloud.size(), 4U);
  EXPECT_EQ(report.in_boxes, 4U);
  const std::vector<std::filesystem::path> files = {folder.write("a.xyz", "x y z\n1 2 3\n")};
  expect_error(ErrorKind::usage, {"`boxes` needs a drive"},
               [&] { load_cloud(files, options, Executor(1), quiet); });
}

// The scans of the drive alone, with poses of another file.
TEST(BoxFiles, TrackletsAreOfOneFolderOfScans) {
  const TemporaryFolder folder;
  write_raw_drive(folder, "drive");
  write_raw_drive(folder, "other");
  LoadOptions options;
  options.own_body_m = options.driven_path_m = 0;
  options.points_in = PointsIn::sensor;
  options.boxes = folder.path() / "drive/tracklet_labels.xml";
  options.trajectory = folder.write("poses.csv",
                                    "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,1,0,0,1,0,0,0\n"
                                    "2,2,0,0,1,0,0,0\n3,3,0,0,1,0,0,0\n");
  ProgressSink quiet;
  std::vector<std::filesystem::path> inputs = {folder.path() / "drive/velodyne_points/data"};
  const auto [cloud, report] = load_cloud(inputs, options, Executor(1), quiet);
  EXPECT_EQ(cloud.size(), 4U);
  EXPECT_EQ(report.in_boxes, 4U);
  inputs.push_back(folder.path() / "other/velodyne_points/data");
  expect_error(ErrorKind::usage, {"tracklets are of one drive"},
               [&] { load_cloud(inputs, options, Executor(1), quiet); });
}

TEST(BoxFiles, BoxesOfAnotherTimeAreAnError) {
  const TemporaryFolder folder;
  write_raw_drive(folder, "drive");
  DriveSettings settings;
  settings.boxes = folder.write(
      "a.csv", "time,id,stationary,x,y,z,size_x,size_y,size_z,yaw\n5,1,0,0,0,0,1,1,1,0\n");
  expect_error(ErrorKind::data, {"a.csv: no box has a time within the scans"},
               [&] { with_boxes(open_kitti_sequence(folder.path() / "drive"), settings); });
}

// nuScenes

using JsonRows = nlohmann::json;

/// Two scenes of two samples each, 0.5 s apart.
class NuscenesBoxFolder {
 public:
  NuscenesBoxFolder() {
    tables_["scene"] = {{{"token", "A"}, {"name", "scene-1"}},
                        {{"token", "B"}, {"name", "scene-2"}}};
    tables_["category"] = {{{"token", "c"}, {"name", "vehicle.car"}}};
    for (const char* table : {"sample", "instance", "sample_annotation"})
      tables_[table] = JsonRows::array();
    for (const std::string scene : {"A", "B"})
      for (int k = 0; k < 2; ++k)
        tables_["sample"].push_back({{"token", scene + std::to_string(k)},
                                     {"timestamp", 1'500'000'000'000'000 + 500'000 * k},
                                     {"scene_token", scene}});
    for (const std::string instance : {"i", "j", "k"})
      tables_["instance"].push_back({{"token", instance}, {"category_token", "c"}});
  }

  JsonRows& operator[](const char* table) { return tables_[table]; }
  void add(const std::string& sample, const std::string& instance, Vec3d at, double yaw = 0) {
    tables_["sample_annotation"].push_back(
        {{"sample_token", sample},
         {"instance_token", instance},
         {"translation", {at.x, at.y, at.z}},
         {"size", {2, 4, 1.5}},
         {"rotation", {std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)}}});
  }
  const std::filesystem::path& write() {
    for (const auto& [name, rows] : tables_.items())
      folder_.write("v1.0-mini/" + name + ".json", rows.dump());
    return folder_.path();
  }

 private:
  JsonRows tables_;
  TemporaryFolder folder_;
};

MovingBoxes boxes_of_scene_1(const std::filesystem::path& path) {
  return MovingBoxes(read_box_file(path, {{}, {}, "", "scene-1"}));
}

// Oracle: the devkit's Box.corners(): length along x, width along y.
TEST(BoxFiles, AnnotationsOfTheChosenNuscenesScene) {
  NuscenesBoxFolder court;
  court.add("B0", "k", {0, 0, 0});
  court.add("A1", "j", {30, 10, 0}, kRightAngle_rad);
  court.add("A0", "i", {90, 10, 0});
  court.add("A0", "j", {30, 5, 0}, kRightAngle_rad);
  court.add("A1", "i", {90.5, 10, 0});
  court.add("B1", "k", {50, 0, 0});
  const std::filesystem::path root = court.write();
  for (const char* part : {"", "v1.0-mini", "v1.0-mini/sample_annotation.json"}) {
    const MovingBoxes boxes = boxes_of_scene_1(root / part);
    ASSERT_EQ(boxes.tracks().size(), 1U);
    const BoxTrack& track = boxes.tracks()[0];
    EXPECT_EQ(track.id, 2U);
    EXPECT_EQ(track.label, "vehicle.car");
    ASSERT_EQ(track.boxes.size(), 2U);
    EXPECT_NEAR(track.boxes[1].time_s, 1.5e9 + 0.5, 1e-6);
    EXPECT_EQ(track.boxes[1].middle, (Vec3d{30, 10, 0}));
    EXPECT_EQ(boxes.object_at(1.5e9 + 0.5, {30, 11.9, 0}), 1);
    EXPECT_EQ(boxes.object_at(1.5e9 + 0.5, {31.9, 10, 0}), 0);
  }
  expect_error(ErrorKind::usage, {"several scenes"},
               [&] { MovingBoxes boxes(read_box_file(root, {})); });
}

TEST(BoxFiles, WrongAnnotationsOfNuscenesAreNamed) {
  const auto reject = [](const std::function<void(NuscenesBoxFolder&)>& change,
                         const std::vector<std::string>& parts) {
    NuscenesBoxFolder court;
    court.add("A0", "i", {0, 0, 0});
    court.add("A1", "i", {5, 0, 0});
    change(court);
    const std::filesystem::path root = court.write();
    expect_error(ErrorKind::data, parts, [&] { boxes_of_scene_1(root); });
  };
  reject(
      [](auto& c) {
        c.add("A1", "i", {6, 0, 0});
      },
      {"sample_annotation.json: element 2 (from 0), instance i: object 1 has two boxes"});
  reject([](auto& c) { c["sample_annotation"][1]["size"][1] = 0; },
         {"element 1 (from 0), instance i: the size of the box is not positive"});
  reject([](auto& c) { c["sample_annotation"][1]["instance_token"] = "x"; },
         {"element 1 (from 0), instance x: instance.json has no such instance"});
  reject([](auto& c) { c["instance"][2]["category_token"] = "x"; },
         {"instance.json: element 2", "no category_token x"});
  reject([](auto& c) { c["sample_annotation"][0]["translation"] = {1, 2}; }, {"'translation'"});
  reject([](auto& c) { c["sample_annotation"] = JsonRows::array(); }, {"has no boxes"});
}

TEST(BoxFiles, OtherFilesAndFoldersAreErrors) {
  const TemporaryFolder folder;
  for (const char* content : {"[]", "{\"boxes\": 1}", "\xef\xbb\xbf[1]"}) {
    const auto json = folder.write("boxes.json", content);
    expect_error(ErrorKind::data, {"boxes.json: is JSON", "sample_annotation.json"},
                 [&] { MovingBoxes boxes(read_box_file(json, {})); });
  }
  std::filesystem::remove(folder.path() / "boxes.json");
  expect_error(ErrorKind::no_input, {"contains no boxes", "tracklet_labels.xml"},
               [&] { MovingBoxes boxes(read_box_file(folder.path(), {})); });
}

}  // namespace
}  // namespace adasplats
