// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/value_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "adasplats/cloud/load/dropped_points.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

class Warnings : public ProgressSink {
 public:
  void warn(std::string_view message) override { text += std::string(message) + "\n"; }
  std::string text;
};

/// Random points in a box of 50 m around a place; `rounded` makes the coordinates of a file.
template <class Rounded>
std::string steps_warning(Vec3d place, Rounded&& rounded, std::size_t count = 3000) {
  Random random(7, 0, 0);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d p = place;
    for (int axis = 0; axis < 3; ++axis) p[axis] = rounded(p[axis] + 50 * random.uniform(), axis);
    points.push_back(p);
  }
  Warnings warnings;
  warn_of_steps("a.ply", points, warnings);
  return warnings.text;
}

double float32(double value, int /*axis*/) {
  return static_cast<double>(static_cast<float>(value));
}

// Oracle: a float32 has 24 bits: steps of 2^-5 m at 400 km and of 2^-1 m at 5,000 km.
TEST(ValueChecks, StepsOfFloat32) {
  const std::string text = steps_warning({400e3, 5000e3, 100}, float32);
  EXPECT_NE(text.find("a.ply: coordinates are on steps (x of 0.03125 m, y of 0.5 m)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("32-bit"), std::string::npos);
  EXPECT_NE(steps_warning({400e3, 400e3, 100}, float32), "");
  EXPECT_EQ(steps_warning({5e3, 5e3, 100}, float32), "");
}

TEST(ValueChecks, StepsOfFewDigits) {
  const auto six_digits = [](double value, int) {
    return std::stod([value] {
      char buffer[32];
      std::snprintf(buffer, sizeof buffer, "%.6g", value);
      return std::string(buffer);
    }());
  };
  const std::string text = steps_warning({512300, 5412300, 100}, six_digits);
  EXPECT_NE(text.find("x of 1 m, y of 10 m"), std::string::npos) << text;
  EXPECT_NE(text.find("few digits"), std::string::npos);
}

TEST(ValueChecks, MillimetresCentimetresAndRastersAreFine) {
  for (const double step : {0.001, 0.01})
    EXPECT_EQ(steps_warning({512300, 5412300, 100},
                            [step](double v, int) { return step * std::round(v / step); }),
              "");
  std::vector<Vec3d> raster;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) raster.push_back({5e5 + i, 5e6 + j, 100 + std::sin(i)});
  Warnings warnings;
  warn_of_steps("a.las", raster, warnings);
  warn_of_steps("a.las", std::vector<Vec3d>(200, {5e5, 5e6, 0}), warnings);
  warn_of_steps("a.las", {}, warnings);
  EXPECT_EQ(warnings.text, "");
}

CloudPart part_with(const std::string& name, float low, float high) {
  CloudPart part;
  for (int i = 0; i < 200; ++i)
    part.cloud.intensities.push_back(low + (high - low) * static_cast<float>(i) / 199);
  part.runs.push_back({0, 200, name, {}});
  return part;
}

TEST(ValueChecks, IntensityScales) {
  const auto warning = [](std::vector<CloudPart> parts) {
    Warnings warnings;
    warn_of_intensity_scales(parts, warnings);
    return warnings.text;
  };
  std::vector<CloudPart> mixed;
  mixed.push_back(part_with("a.las", 100, 140));
  mixed.push_back(part_with("b.las", 25700, 35723));
  const std::string text = warning(std::move(mixed));
  for (const char* const part : {"a.las", "b.las", "100", "35"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  std::vector<CloudPart> alike;
  alike.push_back(part_with("a.las", 0, 255));
  alike.push_back(part_with("b.las", 100, 4000));
  EXPECT_EQ(warning(std::move(alike)), "");
  EXPECT_EQ(warning({}), "");
}

// Oracle: the ellipsoid of WGS 84; UTM coordinates of the same distance from zero are accepted.
TEST(ValueChecks, GeocentricCoordinatesAreAnError) {
  ProgressSink quiet;
  const auto check = [&](Vec3d middle) {
    const Vec3d half = {100, 100, 20};
    require_metres("a.las", middle - half, middle + half, {}, quiet);
  };
  EXPECT_THROW(check({4201000, 172460, 4780100}), Error);     // near Paris
  EXPECT_THROW(check({-2694045, -4293642, 3857878}), Error);  // near San Francisco
  EXPECT_NO_THROW(check({500000, 6340000, 50}));
  EXPECT_NO_THROW(check({0, 0, 0}));
}

}  // namespace
}  // namespace adasplats
