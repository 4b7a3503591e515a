// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/pandaset_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/cloud/load/court_test.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/pickle/data_frame.h"
#include "adasplats/io/pickle/gzip.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

constexpr double kPandaSweep_s = 0.1;
/// The PandarGT from the Pandar64: pandaset-devkit, docs/static_extrinsic_calibration.yaml.
constexpr Vec3d kPandarGtAt = {0.000451, 0.605646, -0.301525};
const RigidTransform kPandaMount = {rotation_from_yaw_pitch_roll(0, 0.01, 0.02), {0.1, 1.1, 1.9}};

nlohmann::json panda_pose(const RigidTransform& pose) {
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  const Vec3d t = pose.translation;
  return {{"position", {{"x", t.x}, {"y", t.y}, {"z", t.z}}},
          {"heading", {{"w", q.w}, {"x", q.x}, {"y", q.y}, {"z", q.z}}}};
}

/// A sequence of a Pandar64 in the court; one point a frame is of the other LiDAR, in the sky. Or
/// with both LiDARs.
class PandaCourt {
 public:
  explicit PandaCourt(std::size_t scans = 5, bool is_mounted = true, bool has_both = false)
      : has_both_(has_both) {
    const LidarModel sensor = load_lidar_model("hesai-pandar64");
    const std::vector<Firing> firings = firings_of(sensor);
    nlohmann::json poses = nlohmann::json::array(), times = poses;
    for (std::size_t scan = 0; scan < scans; ++scan) {
      write_scan(sensor, firings, scan);
      scan_ends.push_back(world.size());
      // In the middle of the sweep, so that the first and the last reach beyond the poses.
      const double pose_s = kPandaSweep_s * (static_cast<double>(scan) + 0.5);
      const RigidTransform mount = is_mounted ? kPandaMount : RigidTransform{};
      poses.push_back(panda_pose(sensor_at(pose_s) * mount.inverse()));
      times.push_back(pose_s);
    }
    put("lidar/poses.json", poses.dump());
    put("lidar/timestamps.json", times.dump());
    put("annotations/semseg/classes.json", R"({"7": "Road", "41": "Building"})");
  }

  const std::filesystem::path& path() const { return folder_.path(); }
  void put(const std::string& name, const std::string& content) const {
    folder_.write(name, content);
  }
  void put_frame(const std::string& name, const std::vector<FrameColumn>& columns) const {
    put(name, gzipped(pickled_data_frame(columns)));
  }
  std::pair<PointCloud, LoadReport> load(LoadOptions options = {}) const {
    options.own_body_m = 0;
    options.driven_path_m = 0;
    ProgressSink quiet;
    return load_cloud(std::span(&folder_.path(), 1), options, Executor(2), quiet);
  }

  std::vector<Vec3d> world, origins;        ///< of the Pandar64
  std::vector<std::size_t> scan_ends;       ///< in `world`
  std::vector<Vec3d> gt_world, gt_origins;  ///< of the PandarGT

 private:
  void write_scan(const LidarModel& sensor, const std::vector<Firing>& firings, std::size_t scan) {
    std::vector<double> x, y, z, intensities, times;
    std::vector<std::int64_t> sensors, classes;
    const auto add = [&](Vec3d p, double time_s, std::int64_t number) {
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
      times.push_back(time_s);
      intensities.push_back(p.z < 0.1 ? 51 : 102);
      sensors.push_back(number);
      classes.push_back(p.z < 0.1 ? 7 : 41);
    };
    for (std::size_t i = 0; i < firings.size(); i += 5) {
      const double time_s =
          kPandaSweep_s * (static_cast<double>(scan) + static_cast<double>(firings[i].column) /
                                                           static_cast<double>(sensor.columns));
      const RigidTransform pose = sensor_at(time_s);
      const Vec3d way = pose.rotation * vec_cast<double>(firings[i].direction);
      const auto range_m = range_in_court(pose.translation, way);
      if (!range_m) continue;
      world.push_back(pose.translation + *range_m * way);
      origins.push_back(pose.translation);
      add(world.back(), time_s, 0);
      if (!has_both_ && (i == 0 || x.size() == 1)) add({0, 0, 50}, time_s, 1);
      const Vec3d gt_origin = pose * kPandarGtAt;
      const auto gt_range_m = range_in_court(gt_origin, way);
      if (!has_both_ || !gt_range_m || i % 2 != 0) continue;
      gt_world.push_back(gt_origin + *gt_range_m * way);
      gt_origins.push_back(gt_origin);
      add(gt_world.back(), time_s, 1);
    }
    const std::string name = "0" + std::to_string(scan) + ".pkl.gz";
    put_frame("annotations/semseg/" + name, {{"class", std::move(classes)}});
    put_frame("lidar/" + name, {{"x", std::move(x)},
                                {"y", std::move(y)},
                                {"z", std::move(z)},
                                {"i", std::move(intensities)},
                                {"t", std::move(times)},
                                {"d", std::move(sensors)}});
  }

  bool has_both_;
  TemporaryFolder folder_;
};

// Annotators draw a cuboid around the points of a frame, whenever they were measured. Oracle: the
// points of each frame in its own cuboid.
TEST(PandaSetDrive, CuboidsAreThoseOfTheFrameOfAPoint) {
  const PandaCourt court(5, false);
  const Vec3d size = {3, 1, 3}, margin = {0.2, 0.2, 0.2};
  std::size_t expected = 0, i = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const Vec3d middle = {-6 + 3.0 * static_cast<double>(k), 12, 1.5};  // along a wall at 30 m/s
    const auto one = [](double value) { return std::vector<double>{value}; };
    court.put_frame("annotations/cuboids/0" + std::to_string(k) + ".pkl.gz",
                    {{"uuid", std::vector<std::string>{"a"}},
                     {"label", std::vector<std::string>{"Bus"}},
                     {"yaw", one(0)},
                     {"stationary", std::vector<bool>{false}},
                     {"position.x", one(middle.x)},
                     {"position.y", one(middle.y)},
                     {"position.z", one(middle.z)},
                     {"dimensions.x", one(size.x)},
                     {"dimensions.y", one(size.y)},
                     {"dimensions.z", one(size.z)}});
    for (const Vec3d reach = 0.5 * size + margin; i < court.scan_ends[k]; ++i) {
      const Vec3d away = court.world[i] - middle;
      expected += std::fabs(away.x) <= reach.x && std::fabs(away.y) <= reach.y &&
                  std::fabs(away.z) <= reach.z;
    }
  }
  LoadOptions options;
  options.boxes = court.path();
  const auto [cloud, report] = court.load(options);
  ASSERT_GT(expected, 100U);
  EXPECT_EQ(report.in_boxes, expected);
  EXPECT_EQ(cloud.size() + expected, court.world.size());
}

// Oracle: where the beams of the court began. Mounts that differ are recognize_sensor_test's.
TEST(PandaSetDrive, PointsOriginsClassesAndIntensities) {
  const PandaCourt court(5, false);
  const auto [cloud, report] = court.load();
  ASSERT_EQ(cloud.size(), court.world.size());
  ASSERT_EQ(cloud.scan_poses.size(), 5U);
  ASSERT_TRUE(cloud.has_beams());
  for (std::size_t i = 0; i < cloud.size(); i += 11) {
    EXPECT_LT(length(cloud.world(i) - court.world[i]), 1e-4);
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    EXPECT_LT(length(origin - court.origins[i]), 0.05);
    const bool is_road = court.world[i].z < 0.1;
    EXPECT_EQ(cloud.classes[i], is_road ? 7 : 41);
    EXPECT_EQ(cloud.intensities[i], is_road ? 51.0F / 255 : 102.0F / 255);
  }
  ASSERT_EQ(report.drives.size(), 1U);
  EXPECT_EQ(report.drives[0].sensor, "hesai-pandar64");
  EXPECT_NE(report.drives[0].facts.left_out.find("5 points of the PandarGT"), std::string::npos);
  EXPECT_NE(report.drives[0].facts.intensities.find("divided by 255"), std::string::npos);
}

// Oracle: the drive in one piece.
TEST(PandaSetDrive, ScansCanBeLoadedPieceByPiece) {
  const PandaCourt court(5);
  const auto [whole, whole_report] = court.load();
  LoadOptions options;
  options.own_body_m = 0;
  options.driven_path_m = 0;
  ProgressSink quiet;
  const OpenInputs inputs(std::span(&court.path(), 1), options, Executor(2), quiet);
  ASSERT_TRUE(inputs.are_drives());
  ASSERT_EQ(inputs.chosen_scans(0), 5U);
  std::size_t points = 0;
  for (const InputPiece& piece : {InputPiece{0, 0, 2}, InputPiece{0, 2, 2}, InputPiece{0, 4, 2}}) {
    const auto [part, report] = inputs.load(piece, Executor(2), quiet);
    EXPECT_EQ(part.scan_poses.size(), piece.first == 4 ? 1U : 2U);
    EXPECT_EQ(report.drives.at(0).sensor, whole_report.drives.at(0).sensor);
    ASSERT_LE(points + part.size(), whole.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::size_t k = points + i;
      ASSERT_EQ(part.world(i), whole.world(k)) << k;
      ASSERT_EQ(part.sensor_positions[i], whole.sensor_positions[k]) << k;
      ASSERT_EQ(part.classes[i], whole.classes[k]) << k;
      ASSERT_EQ(part.scan_indices[i] + piece.first, whole.scan_indices[k]) << k;
    }
    points += part.size();
  }
  EXPECT_EQ(points, whole.size());
}

// Oracle: by hand: a single pose stands for the whole scan.
TEST(PandaSetDrive, ASingleScanIsADrive) {
  const PandaCourt court(1, false);
  const auto [cloud, report] = court.load();
  EXPECT_EQ(cloud.size(), court.world.size());
  EXPECT_EQ(cloud.scan_poses.size(), 1U);
  EXPECT_TRUE(cloud.has_beams());
}

TEST(PandaSetDrive, StatedMount) {
  const PandaCourt court(2);
  LoadOptions options;
  options.mount = kPandaMount.translation;
  const auto [cloud, report] = court.load(options);
  EXPECT_TRUE(report.drives[0].sensor.empty());
  const std::size_t last = cloud.size() - 1;
  const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[last]);
  EXPECT_LT(length(origin - court.origins[last]), 0.05);
}

void expect_beams(const PointCloud& cloud, std::size_t begin, const std::vector<Vec3d>& world,
                  const std::vector<Vec3d>& origins) {
  ASSERT_LE(begin + world.size(), cloud.size());
  for (std::size_t k = 0; k < world.size(); k += 11) {
    const std::size_t i = begin + k;
    EXPECT_LT(length(cloud.world(i) - world[k]), 1e-4) << k;
    const Vec3d origin = cloud.origin + vec_cast<double>(cloud.sensor_positions[i]);
    EXPECT_LT(length(origin - origins[k]), 0.05) << k;
    EXPECT_EQ(cloud.classes[i], world[k].z < 0.1 ? 7 : 41) << k;
  }
}

// Oracle: the origins of the beams that were cast, with the published mount on the Pandar64.
TEST(PandaSetDrive, BothLidarsAreARig) {
  const PandaCourt court(5, false, true);
  ASSERT_TRUE(is_pandaset_rig(court.path()));
  const auto [cloud, report] = court.load();
  ASSERT_EQ(cloud.size(), court.world.size() + court.gt_world.size());
  ASSERT_EQ(cloud.sensors.size(), 2U);
  EXPECT_EQ(cloud.sensors[0].name, "pandar64");
  EXPECT_EQ(cloud.sensors[1].name, "pandargt");
  EXPECT_EQ(cloud.scan_poses.size(), 10U);
  expect_beams(cloud, 0, court.world, court.origins);
  expect_beams(cloud, court.world.size(), court.gt_world, court.gt_origins);
  ASSERT_EQ(report.drives.size(), 2U);
  EXPECT_EQ(report.drives[0].sensor, "hesai-pandar64");
  EXPECT_TRUE(report.drives[1].sensor.empty());
  EXPECT_TRUE(report.drives[0].facts.left_out.empty());
}

TEST(PandaSetDrive, ATopicIsOneLidar) {
  const PandaCourt court(5, false, true);
  LoadOptions options;
  options.topic = "pandargt";
  const auto [forward, report] = court.load(options);
  ASSERT_EQ(forward.size(), court.gt_world.size());
  EXPECT_TRUE(forward.sensors.empty());
  expect_beams(forward, 0, court.gt_world, court.gt_origins);
  options.topic = "pandar64";
  const auto [spinning, other] = court.load(options);
  ASSERT_EQ(spinning.size(), court.world.size());
  expect_beams(spinning, 0, court.world, court.origins);
  options.topic = "front";
  expect_error(ErrorKind::usage, {"no sensor 'front'", "pandar64 or pandargt"},
               [&] { court.load(options); });
}

// A mount is that of one sensor: of the chosen one, or of the Pandar64.
TEST(PandaSetDrive, StatedMountOfOneLidar) {
  const PandaCourt court(2, true, true);
  LoadOptions options;
  options.mount = kPandaMount.translation;
  const auto [spinning, report] = court.load(options);
  EXPECT_EQ(spinning.size(), court.world.size());
  EXPECT_NE(report.drives[0].facts.left_out.find("points of the PandarGT"), std::string::npos);
  options.topic = "pandargt";
  options.mount = kPandaMount * kPandarGtAt;
  const auto [forward, other] = court.load(options);
  ASSERT_EQ(forward.size(), court.gt_world.size());
  expect_beams(forward, 0, court.gt_world, court.gt_origins);
}

TEST(PandaSetDrive, FewPointsOfALidarAreNoRig) {
  const PandaCourt few(2), both(2, true, true);
  EXPECT_FALSE(is_pandaset_rig(few.path()));
  EXPECT_FALSE(is_pandaset_rig(few.path() / "lidar"));
  const std::vector<double> one = {1.0};
  both.put_frame("lidar/01.pkl.gz", {{"x", one},
                                     {"y", one},
                                     {"z", one},
                                     {"i", one},
                                     {"t", one},
                                     {"d", std::vector<std::int64_t>{1}}});
  EXPECT_FALSE(is_pandaset_rig(both.path()));
  LoadOptions options;
  options.topic = "pandargt";
  const PandaCourt alone(1);
  alone.put_frame("annotations/semseg/00.pkl.gz", {{"class", std::vector<std::int64_t>{7}}});
  alone.put_frame("lidar/00.pkl.gz", {{"x", one},
                                      {"y", one},
                                      {"z", one},
                                      {"i", one},
                                      {"t", one},
                                      {"d", std::vector<std::int64_t>{0}}});
  expect_error(ErrorKind::data, {"scans are empty", "1 points of the Pandar64 (d = 0)"},
               [&] { alone.load(options); });
}

TEST(PandaSetDrive, LabelSchemeIsThatOfTheNames) {
  const PandaCourt court(1, false);
  const auto scheme = labels_of_tree(court.path());
  ASSERT_TRUE(scheme);
  EXPECT_EQ(scheme->name(), "pandaset");
  EXPECT_EQ(scheme->find(7)->group, SemanticGroup::ground);
  expect_error(ErrorKind::usage, {"class 41 is 'Building'", "semantickitti"},
               [&] { require_labels_of_tree(court.path(), semantickitti_labels()); });
  require_labels_of_tree(court.path(), *scheme);
  court.put("annotations/semseg/classes.json", R"({"40": "road", "50": "building"})");
  EXPECT_EQ(labels_of_tree(court.path())->name(), "semantickitti");
}

// nlohmann throws another exception for a number beyond double's range than for what is no JSON.
TEST(PandaSetDrive, DamagedClassNamesAreErrors) {
  const PandaCourt court(1, false);
  const auto expect_broken = [&](const std::string& text, const std::string& expected) {
    court.put("annotations/semseg/classes.json", text);
    expect_error(ErrorKind::data, {"classes.json", expected},
                 [&] { labels_of_tree(court.path()); });
  };
  expect_broken("[[5555555555555e5555555", "beyond the range of a double");
  expect_broken(R"({"7": -1e400})", "beyond the range of a double");
  expect_broken(R"({"7": "Road")", "byte");
  expect_broken(R"({"7": 1})", "expected a text");
  expect_broken("[]", "expected an object");
}

using Damage = std::function<void(const PandaCourt&)>;

void expect_damage(const std::vector<std::string>& parts, const Damage& damage,
                   ErrorKind kind = ErrorKind::data) {
  const PandaCourt court(2);
  damage(court);
  expect_error(kind, parts, [&] { court.load(); });
}

TEST(PandaSetDrive, DamagedTreesNameTheFile) {
  namespace fs = std::filesystem;
  expect_damage({"lidar/01.pkl.gz", "missing", "2 poses"},
                [](const auto& c) { fs::remove(c.path() / "lidar/01.pkl.gz"); });
  expect_damage({"lidar/02.pkl.gz", "no pose"}, [](const auto& c) {
    fs::copy(c.path() / "lidar/01.pkl.gz", c.path() / "lidar/02.pkl.gz");
  });
  expect_damage({"semseg/01.pkl.gz", "1 labels"}, [](const auto& c) {
    c.put_frame("annotations/semseg/01.pkl.gz", {{"class", std::vector<std::int64_t>{7}}});
  });
  expect_damage({"semseg/01.pkl.gz", "missing"},
                [](const auto& c) { fs::remove(c.path() / "annotations/semseg/01.pkl.gz"); });
  expect_damage({"timestamps.json", "1 times", "2 poses"},
                [](const auto& c) { c.put("lidar/timestamps.json", "[0.1]"); });
  expect_damage({"timestamps.json", "element 1", "after"},
                [](const auto& c) { c.put("lidar/timestamps.json", "[0.1, 0.1]"); });
  expect_damage({"poses.json", "element 0", "heading", "length"}, [](const auto& c) {
    c.put("lidar/poses.json",
          R"([{"position": {"x":0,"y":0,"z":0}, "heading": {"w":2,"x":0,"y":0,"z":0}}])");
  });
  expect_damage({"poses.json", "element 0", "'heading'"}, [](const auto& c) {
    c.put("lidar/poses.json", R"([{"position": {"x":0,"y":0,"z":0}}])");
  });
  expect_damage({"poses.json", "byte"}, [](const auto& c) { c.put("lidar/poses.json", "[{"); });
  expect_damage({"timestamps.json", "beyond the range"},
                [](const auto& c) { c.put("lidar/timestamps.json", "[0.1, 1e999]"); });
  expect_damage({"poses.json", "array"}, [](const auto& c) { c.put("lidar/poses.json", "{}"); });
  expect_damage(
      {"poses.json", "no such file"},
      [](const auto& c) { fs::remove(c.path() / "lidar/poses.json"); }, ErrorKind::no_input);
  expect_damage({"lidar/01.pkl.gz"}, [](const auto& c) {
    const fs::path file = c.path() / "lidar/01.pkl.gz";
    fs::resize_file(file, fs::file_size(file) / 2);
  });
  expect_damage({"lidar/01.pkl.gz", "'d'", "expected 0"}, [](const auto& c) {
    const std::vector<double> one = {1.0};
    c.put_frame("lidar/01.pkl.gz", {{"x", one},
                                    {"y", one},
                                    {"z", one},
                                    {"i", one},
                                    {"t", one},
                                    {"d", std::vector<std::int64_t>{2}}});
  });
  expect_damage({"lidar/01.pkl.gz", "no column", "'t'"}, [](const auto& c) {
    const std::vector<double> one = {1.0};
    c.put_frame("lidar/01.pkl.gz", {{"x", one}, {"y", one}, {"z", one}, {"i", one}});
  });
}

TEST(PandaSetDrive, SettingsOfOtherDrives) {
  const PandaCourt court(1);
  LoadOptions options;
  options.topic = "/points";
  expect_error(ErrorKind::usage, {"PandaSet sequence", "`topic`"}, [&] { court.load(options); });
}

}  // namespace
}  // namespace adasplats
