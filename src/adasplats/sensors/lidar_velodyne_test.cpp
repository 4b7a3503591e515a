// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

constexpr double kPi = std::numbers::pi;

class VelodyneYaml : public testing::Test {
 protected:
  LidarModel load(const std::string& text, const std::string& name = "mine.yaml") const {
    return load_lidar_model(folder_.write(name, text).string());
  }
  void expect_data_error(const std::string& text, const std::string& says) const {
    expect_error(ErrorKind::data, {"mine.yaml", says}, [&] { load(text); });
  }
  TemporaryFolder folder_;
};

/// Two lasers, one in braces over two lines, one key by key.
const char* const kTwo =
    "# mine\nlasers:\n"
    "- {dist_correction: 1.5, laser_id: 0, rot_correction: 0.1,\n"
    "  vert_correction: -0.2, vert_offset_correction: 0.19, horiz_offset_correction: 0.026}\n"
    "- laser_id: 1\n  rot_correction: -0.05\n  two_pt_correction_available: true\n"
    "  vert_correction: 0.03 # up\n  vert_offset_correction: 0.2\n"
    "num_lasers: 2\ndistance_resolution: 0.002\n";

TEST_F(VelodyneYaml, BothWaysOfWritingALaserAreRead) {
  const LidarModel model = load(kTwo);
  EXPECT_EQ(model.name, "mine");
  ASSERT_EQ(model.elevations_rad.size(), 2U);
  EXPECT_EQ(model.elevations_rad[0], 0.03);  // topmost first
  EXPECT_EQ(model.azimuth_offsets_rad[0], -0.05);
  EXPECT_EQ(model.elevations_rad[1], -0.2);
  EXPECT_EQ(model.azimuth_offsets_rad[1], 0.1);
  EXPECT_EQ(model.range_resolution_m, 0.002);
  EXPECT_TRUE(model.clockwise);
  EXPECT_EQ(model.columns, 1800U);  // of no sensor that is known
  EXPECT_TRUE(model.firing_times_s.empty());
}

/// Where velodyne_pointcloud (RawData::unpack) puts a return: the driver's frame, x right, y
/// forward, turned to x forward, y left.
Vec3d driver_point(double rotation_rad, double range_m, double vert, double rot, double vert_offset,
                   double horiz_offset) {
  const double cos_rot = std::cos(rotation_rad - rot);
  const double sin_rot = std::sin(rotation_rad - rot);
  const double xy_m = range_m * std::cos(vert) - vert_offset * std::sin(vert);
  const double right = xy_m * sin_rot - horiz_offset * cos_rot;
  const double ahead = xy_m * cos_rot + horiz_offset * sin_rot;
  return {ahead, -right, range_m * std::sin(vert) + vert_offset * std::cos(vert)};
}

// Oracle: the driver's formula for the coordinates of a return.
TEST_F(VelodyneYaml, AReturnLiesWhereTheDriverPutsIt) {
  const auto firings = firings_of(load(kTwo));
  for (const std::uint32_t column : {0U, 100U, 450U, 1799U}) {
    const double rotation_rad = column / 1800.0 * 2 * kPi;
    for (const double range_m : {0.0, 1.0, 50.0}) {
      const auto expect_at = [&](const Firing& firing, Vec3d expected) {
        const Vec3d found =
            vec_cast<double>(firing.origin) + range_m * vec_cast<double>(firing.direction);
        EXPECT_LT(length(found - expected), 1e-5) << column << " " << range_m;
      };
      expect_at(firings[column], driver_point(rotation_rad, range_m, 0.03, -0.05, 0.2, 0));
      expect_at(firings[1800 + column],
                driver_point(rotation_rad, range_m, -0.2, 0.1, 0.19, 0.026));
    }
  }
}

std::string lasers(int count, double rot_correction) {
  std::string text = "lasers:\n";
  for (int id = 0; id < count; ++id)
    text += "- {laser_id: " + std::to_string(id) +
            ", rot_correction: " + std::to_string(rot_correction) +
            ", vert_correction: " + std::to_string(-0.001 * id) + "}\n";
  return text;
}

// Oracle: the manuals' firing times (sensors/velodyne-*.toml).
TEST_F(VelodyneYaml, TimesAreThoseOfTheSensorWithAsManyLasers) {
  const auto last_us = [&](int count, double rot, const std::string& name = "mine.yml") {
    return 1e6 * load(lasers(count, rot), name).firing_times_s.back();
  };
  EXPECT_NEAR(last_us(16, 0), 15 * 2.304, 1e-9);
  EXPECT_NEAR(last_us(32, 0), 31 * 1.152, 1e-9);
  EXPECT_NEAR(last_us(32, 0.02), 15 * 2.304, 1e-9);
  EXPECT_NEAR(last_us(64, 0.02), 42 + 3.66, 1e-9);
  EXPECT_NEAR(last_us(64, 0.02, "64e_S3.yaml"), 50.4 + 3.7, 1e-9);
  EXPECT_NEAR(last_us(128, 0.02), 16 * 2.665, 1e-9);
  EXPECT_TRUE(load(lasers(1, 0) + "num_lasers: 1\n").firing_times_s.empty());
  EXPECT_TRUE(load(lasers(17, 0) + "num_lasers: 17\n").firing_times_s.empty());
}

TEST_F(VelodyneYaml, WrongFilesAreRefusedWithTheLine) {
  expect_data_error("", "no list 'lasers'");
  expect_data_error("a: 1\n", "no list 'lasers'");
  expect_data_error("lasers:\n", "no lasers");
  expect_data_error("lasers:\n- {laser_id: 0}\n", "mine.yaml:2: a laser without vert_correction");
  expect_data_error("lasers:\n- {vert_corection: 0}\n", "did you mean 'vert_correction'");
  expect_data_error("lasers:\n- {vert_correction: nan}\n", "mine.yaml:2: vert_correction is 'nan'");
  expect_data_error("lasers:\n- {vert_correction: 15.0}\n", "expected radians");
  expect_data_error("lasers:\n- {vert_correction: 0.1\n", "without a '}'");
  expect_data_error("lasers:\n- {vert_correction: 0.1\n- {vert_correction: 0.1}\n", "mine.yaml:3");
  expect_data_error("lasers:\n- {vert_correction: 0, vert_correction: 0}\n", "two values");
  expect_data_error("lasers:\n- {vert_correction}\n", "expected 'key: value'");
  expect_data_error("lasers:\n- {vert_correction: 0}\nnum_lasers: 2\n", "num_lasers");
  expect_data_error("lasers:\n  vert_correction: 0\n", "no lasers");
  for (const char* key : {"vert_offset_correction", "horiz_offset_correction"})
    expect_data_error("lasers:\n- {vert_correction: 0, " + std::string(key) + ": -1e300}\n",
                      "mine.yaml:2: " + std::string(key) + " is -1e+300 m");
  expect_data_error("lasers:\n- {vert_correction: 0}\ndistance_resolution: 1e9\n",
                    "distance_resolution");
  expect_data_error("lasers:\n- {vert_correction: 0}\ndistance_resolution: -1\n",
                    "distance_resolution");
  expect_data_error(lasers(13, 0), "13 lasers and no num_lasers");
  std::string far = lasers(16, 0);
  far.replace(far.find("laser_id: 7"), 11, "laser_id: 7, dist_correction: 1e7");
  expect_data_error(far, "mine.yaml:9: dist_correction");
  std::string twice = lasers(16, 0);
  twice.replace(twice.find("laser_id: 7"), 11, "laser_id: 6");
  expect_data_error(twice, "mine.yaml:9: laser_id");
}

TEST_F(VelodyneYaml, AnglesThatAreNotThoseOfBeamsAreErrors) {
  std::string same = lasers(16, 0), zero = "lasers:\n";
  same.replace(same.find("-0.003"), 6, "-0.002");
  expect_data_error(same, "beams 2 and 3 (from 0) have the same angles");
  for (int id = 0; id < 16; ++id) zero += "- {vert_correction: 0, rot_correction: 0}\n";
  expect_data_error(zero, "all 16 beams have the elevation 0");
  std::string gap = lasers(17, 0);
  gap.replace(gap.find("laser_id: 7"), 11, "laser_id: 17");
  expect_data_error(gap, "laser_id is not a unique whole number from 0 to 16");
  std::string radians = "<b><DB><points_>";
  for (int id = 0; id < 16; ++id)
    radians += "<item><px><vertCorrection_>" + std::to_string(0.26 - 0.035 * id) +
               "</vertCorrection_></px></item>";
  expect_error(ErrorKind::data, {"db.xml", "are they in radians?"},
               [&] { load(radians + "</points_></DB></b>", "db.xml"); });
}

TEST_F(VelodyneYaml, HostileFilesAreErrorsNotCrashes) {
  expect_data_error("lasers:\n" + std::string(100'000, '-'), "mine.yaml:2");
  expect_data_error("lasers:\n- " + std::string(100'000, '{'), "mine.yaml:2");
  std::string many = "lasers:\n";
  for (int i = 0; i < 70'000; ++i) many += "- vert_correction: 0\n";
  expect_data_error(many, "more than 65536");
}

/// What VeloView and the ROS driver's generator read as db.xml: degrees, centimetres, and lasers
/// that are switched off.
TEST_F(VelodyneYaml, TheMakersXmlIsTheSame) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n<boost_serialization version=\"9\">\n<DB>\n"
      "<distLSB_>0.2</distLSB_>\n<enabled_><count>17</count>";
  std::string points = "<points_><count>17</count>";
  std::string yaml = "lasers:\n";
  for (int id = 0; id < 17; ++id) {
    xml += id == 16 ? "<item>0</item>" : "<item>1</item>";
    const std::string k = std::to_string(id);
    points += "<item><px><id_>" + k + "</id_><rotCorrection_>-" + k + ".5</rotCorrection_>" +
              "<vertCorrection_>" + k + ".25</vertCorrection_><distCorrection_>1" + k +
              "</distCorrection_><vertOffsetCorrection_>2" + k +
              "</vertOffsetCorrection_><horizOffsetCorrection_>-2.6</horizOffsetCorrection_>" +
              "<focalDistance_>0</focalDistance_></px></item>\n";
    if (id == 16) continue;
    std::ostringstream laser;
    laser.precision(17);
    laser << "- {laser_id: " << id << ", rot_correction: " << -(id + 0.5) * kPi / 180
          << ", vert_correction: " << (id + 0.25) * kPi / 180
          << ", dist_correction: " << 0.01 * std::stod("1" + k)
          << ", vert_offset_correction: " << 0.01 * std::stod("2" + k)
          << ", horiz_offset_correction: -0.026}\n";
    yaml += laser.str();
  }
  xml += "</enabled_>\n" + points + "</points_>\n</DB>\n</boost_serialization>\n";
  const LidarModel a = load(xml, "db.xml"), b = load(yaml + "distance_resolution: 0.002\n");
  ASSERT_EQ(a.elevations_rad.size(), 16U);
  ASSERT_TRUE(a.packets && b.packets);
  EXPECT_EQ(a.packets->laser_ids, b.packets->laser_ids);
  EXPECT_EQ(a.firing_times_s, b.firing_times_s);
  EXPECT_NEAR(a.range_resolution_m, 0.002, 1e-12);
  for (std::size_t ring = 0; ring < 16; ++ring) {
    EXPECT_NEAR(a.elevations_rad[ring], b.elevations_rad[ring], 1e-12);
    EXPECT_NEAR(a.azimuth_offsets_rad[ring], b.azimuth_offsets_rad[ring], 1e-12);
    EXPECT_NEAR(a.packets->range_offsets_m[ring], b.packets->range_offsets_m[ring], 1e-12);
    EXPECT_LT(length(a.beam_origins_m[ring] - b.beam_origins_m[ring]), 1e-12);
  }
  for (const char* broken : {"<a/>", "<DB></DB>", "no xml", "<b><DB><points_/></DB></b>",
                             "<b><DB><points_><item><px><vertCorrection_>x</vertCorrection_></px>"
                             "</item></points_></DB></b>"})
    expect_error(ErrorKind::data, {"bad.xml"}, [&] { load(broken, "bad.xml"); });
}

}  // namespace
}  // namespace adasplats
