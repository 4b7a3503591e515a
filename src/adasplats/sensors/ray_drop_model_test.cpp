// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/ray_drop_model.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

RayDropModel described_model() {
  RayDropModel model;
  model.weights = {-3, 0.3, 0.05, 0.2, 1, 0.5, -0.6, -0.1};
  return model;
}

/// A file that goes away.
class RayDropFile : public testing::Test {
 protected:
  RayDropFile()
      : path(std::filesystem::temp_directory_path() /
             (std::string("adasplats_") +
              testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml")) {}
  ~RayDropFile() override { std::filesystem::remove(path); }

  std::string error_of(const std::string& text) {
    std::ofstream(path) << text;
    try {
      load_ray_drop(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::config);
      return error.what();
    }
    return {};
  }

  std::filesystem::path path;
};

TEST_F(RayDropFile, RoundTrip) {
  RayDropModel model = described_model();
  model.usual_reflectance = 0.1;
  model.fitted_to = "a \"sensor\" \\ place\n";
  model.edge_runs = {0.25, 0, 0.125};
  const auto sector = [](double elevation_deg, double begin_deg, double end_deg) {
    return BlockedSector{static_cast<float>(elevation_deg * kDegree),
                         static_cast<float>(begin_deg * kDegree),
                         static_cast<float>(end_deg * kDegree)};
  };
  model.blocked = {sector(-20.4, -180, -160), sector(-20.4, 10, 30), sector(-20, 10, 30)};
  ASSERT_EQ(model.blocked.size(), 3U);
  save_ray_drop(path, model);
  const RayDropModel read = load_ray_drop(path);
  EXPECT_EQ(read.weights, model.weights);
  EXPECT_EQ(read.usual_reflectance, 0.1);
  EXPECT_EQ(read.edge_runs, model.edge_runs);
  EXPECT_EQ(read.fitted_to, "a \"sensor\" \\ place ");
  ASSERT_EQ(read.blocked.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(read.blocked[i].elevation_rad, model.blocked[i].elevation_rad);
    EXPECT_FLOAT_EQ(read.blocked[i].azimuth_begin_rad, model.blocked[i].azimuth_begin_rad);
    EXPECT_FLOAT_EQ(read.blocked[i].azimuth_end_rad, model.blocked[i].azimuth_end_rad);
  }
}

TEST_F(RayDropFile, ErrorsNameTheLine) {
  const std::string weights = "weights = [1, 2, 3, 4, 5, 6, 7, 8]\n";
  EXPECT_EQ(error_of(weights), "");
  EXPECT_NE(error_of("").find("weights is missing"), std::string::npos);
  EXPECT_NE(error_of("\nweights = [1, 2]").find(":2: weights is not a list of 8"),
            std::string::npos);
  EXPECT_NE(error_of("weights = [1, 2, 3, 4, 5, 6, 7, nan]").find(":1: "), std::string::npos);
  EXPECT_NE(error_of(weights + "weihgts = 1").find("did you mean 'weights'"), std::string::npos);
  EXPECT_NE(error_of(weights + "usual_reflectance = 'x'").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "fitted_to = 1").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "blocked = [1]").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "edge_runs = [0, 0, 0, 0, 0, 0, 0]").find(":2: edge_runs has 7"),
            std::string::npos);
  EXPECT_NE(error_of(weights + "edge_runs = [0.5, 0.5, 0.1]").find("a sum above 1"),
            std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1").find(":2: "), std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1\nazimuths_deg = [[1]]").find(":4: "),
            std::string::npos);
  EXPECT_NE(error_of(weights + "[[blocked]]\nelevation_deg = 1\nazimuths_deg = [[1, 999]]")
                .find("-180 to 180"),
            std::string::npos);
  EXPECT_NE(error_of("weights = [").find(":1: "), std::string::npos);
  EXPECT_NE(error_of(std::string(10000, '.')).find("too large"), std::string::npos);
}

TEST_F(RayDropFile, MissingFileIsNoInput) {
  try {
    load_ray_drop(path);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::no_input);
  }
}

}  // namespace
}  // namespace adasplats
