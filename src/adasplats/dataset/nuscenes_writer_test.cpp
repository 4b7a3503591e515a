// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/nuscenes_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/dataset/driver_order.h"
#include "adasplats/dataset/numbered_scan_test.h"
#include "adasplats/dataset/nuscenes_categories.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

using Tables = std::map<std::string, nlohmann::json>;

constexpr std::size_t kScans = 13;

/// An object that is seen in the scans from 5 on, with one point of each in its box.
std::vector<ObjectBox> one_box(std::size_t index, double time_s) {
  if (index < 5) return {};
  RigidTransform pose = scan_number(index, 1).world_from_sensor;
  pose.translation = pose.translation + Vec3d{time_s, 0, 0};
  return {{10, 7, pose, {400, 200, 150}}};
}

/// Thirteen scans a tenth of a second apart, the last without returns.
void write_scene(const std::filesystem::path& folder, bool with_boxes = true) {
  ScanWriterOptions options;
  options.labels = &semantickitti_labels();
  options.image_size = {64, 2};
  options.drive = {kScans, [](std::size_t i) { return scan_number(i, 0).time_s; }};
  if (with_boxes) options.boxes = &one_box;
  const auto writer = make_scan_writer(folder, ScanFormat::nuscenes, options);
  for (std::size_t i = 0; i < kScans; ++i) {
    Scan scan = scan_number(i, i == 10 ? 0 : 70);
    for (std::uint16_t& id : scan.classes) id = 40;
    if (i == 10) scan.classes.clear();
    writer->write(i, scan);
  }
  writer->finish();
}

Tables tables_in(const std::filesystem::path& folder) {
  Tables tables;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "v1.0-mini"))
    tables[entry.path().stem().string()] = nlohmann::json::parse(read_file(entry.path()));
  return tables;
}

/// The rows of a table by their tokens, each of which is there once.
std::map<std::string, nlohmann::json> by_token(const nlohmann::json& table) {
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : table) rows[row["token"]] = row;
  EXPECT_EQ(rows.size(), table.size());
  return rows;
}

// Oracle: the devkit's schema: which table each kind of token is of; "" ends chains alone.
TEST(NuscenesWriter, TokensReferToRows) {
  const TemporaryFolder folder;
  write_scene(folder.path());
  const Tables tables = tables_in(folder.path());
  for (const char* name : {"category", "attribute", "visibility", "instance", "sensor",
                           "calibrated_sensor", "ego_pose", "log", "scene", "sample", "sample_data",
                           "sample_annotation", "map", "lidarseg"})
    ASSERT_TRUE(tables.contains(name)) << name;
  std::map<std::string, std::set<std::string>> tokens;
  for (const auto& [name, rows] : tables)
    for (const auto& [token, row] : by_token(rows)) tokens[name].insert(token);
  const auto table_of = [](const std::string& key, const std::string& table) -> std::string {
    if (key == "prev" || key == "next") return table;
    if (key == "first_sample_token" || key == "last_sample_token") return "sample";
    if (key.ends_with("_annotation_token")) return "sample_annotation";
    if (key == "attribute_tokens" || key == "log_tokens") return key.substr(0, key.size() - 7);
    return key.ends_with("_token") ? key.substr(0, key.size() - 6) : "";
  };
  for (const auto& [name, rows] : tables) {
    for (const auto& row : rows) {
      for (const auto& [key, value] : row.items()) {
        const std::string of = table_of(key, name);
        if (of.empty()) continue;
        const bool is_end = (key == "prev" || key == "next") && value == "";
        for (const auto& token : value.is_array() ? value : nlohmann::json::array({value}))
          EXPECT_TRUE(is_end || tokens[of].contains(token)) << name << "." << key << " " << token;
      }
    }
  }
}

TEST(NuscenesWriter, SamplesSweepsAndChains) {
  const TemporaryFolder folder;
  write_scene(folder.path());
  const Tables tables = tables_in(folder.path());
  auto samples = by_token(tables.at("sample"));
  std::size_t keys = 0, index = 0;
  for (const auto& row : tables.at("sample_data")) {
    const bool is_key = index % 5 == 0;
    keys += is_key ? 1 : 0;
    EXPECT_EQ(row["is_key_frame"], is_key);
    EXPECT_EQ(std::string(row["filename"]).starts_with(is_key ? "samples/" : "sweeps/"), true);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / std::string(row["filename"])));
    // The nearest sample is at most two scans away.
    const double apart_us =
        std::fabs(double{samples[row["sample_token"]]["timestamp"]} - double{row["timestamp"]});
    EXPECT_LE(apart_us, 200'001);
    ++index;
  }
  EXPECT_EQ(index, kScans);
  EXPECT_EQ(keys, 3U);
  std::size_t length = 0;
  for (std::string token = tables.at("scene")[0]["first_sample_token"]; !token.empty(); ++length)
    token = samples[token]["next"];
  EXPECT_EQ(length, tables.at("scene")[0]["nbr_samples"]);
  EXPECT_EQ(length, 3U);
}

// Oracle: the scan: points through calibrated_sensor and ego_pose are where it has them in the
// world, as the devkit brings them there.
TEST(NuscenesWriter, PointsPosesAndLabels) {
  const TemporaryFolder folder;
  write_scene(folder.path());
  const Tables tables = tables_in(folder.path());
  const auto transform = [](const nlohmann::json& row) {
    const auto& q = row["rotation"];
    const auto& t = row["translation"];
    return RigidTransform{rotation_from_quaternion(q[0], q[1], q[2], q[3]), {t[0], t[1], t[2]}};
  };
  const Scan scan = scan_number(5, 70);
  const RigidTransform world_from_lidar =
      transform(tables.at("ego_pose")[5]) * transform(tables.at("calibrated_sensor")[0]);
  const Table points = read_bin(folder.path() / "samples/LIDAR_TOP/000005.pcd.bin");
  const auto order = driver_order(scan, FirstRing::bottom);
  ASSERT_EQ(points.rows, 70U);
  for (std::size_t k = 0; k < 70; ++k) {
    const std::uint32_t i = order[k];
    const auto value = [&](std::size_t column) { return points.columns[column].as_double(k); };
    const Vec3d world = world_from_lidar * Vec3d{value(0), value(1), value(2)};
    const Vec3d expected = scan.world_from_sensor * vec_cast<double>(scan.positions[i]);
    EXPECT_LT(length(world - expected), 1e-6);
    EXPECT_EQ(value(3), double{scan.intensities[i]});
    EXPECT_EQ(value(4), 63 - scan.rings[i]);
  }
  EXPECT_EQ(tables.at("ego_pose")[5]["timestamp"], std::llround(1e6 * scan.time_s));
  const std::string labels = read_file(folder.path() / "lidarseg/v1.0-mini/000005_lidarseg.bin");
  EXPECT_EQ(labels, std::string(70, '\x18'));  // 24, flat.driveable_surface
  EXPECT_EQ(read_file(folder.path() / "lidarseg/v1.0-mini/000010_lidarseg.bin"), "");
  EXPECT_EQ(tables.at("lidarseg").size(), 3U);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "lidarseg/v1.0-mini/000004_lidarseg.bin"));
}

// Oracle: by hand: of three samples the middle one sees the object; the last one has no points.
TEST(NuscenesWriter, Annotations) {
  const TemporaryFolder folder;
  write_scene(folder.path());
  const Tables tables = tables_in(folder.path());
  ASSERT_EQ(tables.at("sample_annotation").size(), 1U);
  const auto& box = tables.at("sample_annotation")[0];
  EXPECT_EQ(box["size"], nlohmann::json({200, 400, 150}));  // width, length, height
  EXPECT_EQ(box["sample_token"], tables.at("sample")[1]["token"]);
  EXPECT_GT(box["num_lidar_pts"], 0);
  const auto categories = by_token(tables.at("category"));
  EXPECT_EQ(categories.at(tables.at("instance")[0]["category_token"])["name"], "vehicle.car");
  const auto attributes = by_token(tables.at("attribute"));
  EXPECT_EQ(attributes.at(box["attribute_tokens"][0])["name"], "vehicle.moving");
  const TemporaryFolder empty;
  write_scene(empty.path(), false);
  EXPECT_TRUE(tables_in(empty.path()).at("instance").empty());
}

// Oracle: the names of nuScenes' own lidarseg categories.
TEST(NuscenesCategories, OfOurSchemes) {
  const auto name = [](const char* word) { return nuscenes_categories()[nuscenes_category(word)]; };
  EXPECT_EQ(nuscenes_categories().size(), 32U);
  EXPECT_EQ(nuscenes_category("unlabeled"), 0);
  EXPECT_EQ(name("road"), "flat.driveable_surface");
  EXPECT_EQ(name("moving-car"), "vehicle.car");
  EXPECT_EQ(name("motorcyclist"), "vehicle.motorcycle");
  EXPECT_EQ(name("bicycle"), "vehicle.bicycle");
  EXPECT_EQ(name("sidewalk"), "flat.sidewalk");
  EXPECT_EQ(name("traffic-sign"), "static.manmade");
  EXPECT_EQ(name("trunk"), "static.vegetation");
  EXPECT_EQ(name("anything"), "static.other");
}

}  // namespace
}  // namespace adasplats
