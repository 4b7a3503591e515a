// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussian_ply.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/splats/model/gaussians.h"

namespace adasplats {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
using Names = std::vector<std::string>;

SplatModel model_of(const std::vector<Vec3d>& normals) {
  SplatModel model;
  for (const Vec3d n : normals) {
    const auto i = static_cast<float>(model.size());
    model.disks.push_back({{i, -2 * i, 0.5F}, 0.05F * (i + 1), vec_cast<float>(n)});
  }
  return model;
}

Table written(const SplatModel& model, GaussianKind kind, const std::vector<Rgb>& colors) {
  const TemporaryFolder folder;
  write_gaussian_ply(folder.path() / "g.ply", model, colors, kind);
  return read_ply(folder.path() / "g.ply");
}

double value(const Table& table, const std::string& name, std::size_t row) {
  return table.find(name)->as_double(row);
}

Names names_of(const Table& table) {
  Names names;
  for (const Column& column : table.columns) names.push_back(column.name);
  return names;
}

/// Poles, directions near them, and random ones.
std::vector<Vec3d> directions() {
  std::vector<Vec3d> normals = {{0, 0, 1},    {0, 0, -1},    {1, 0, 0},        {0, -1, 0},
                                {1e-7, 0, 1}, {0, 1e-6, -1}, {1e-5, -1e-5, -1}};
  Random random(5, 0, 0);
  for (int i = 0; i < 200; ++i)
    normals.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  for (Vec3d& n : normals) n = (1 / length(n)) * n;
  return normals;
}

// Oracle: the lists of construct_list_of_attributes() in the programs of both papers, without the
// harmonics of higher degree.
TEST(GaussianPly, PropertiesInTheOrderOfThePapersPrograms) {
  const SplatModel model = model_of({{0, 0, 1}});
  const std::vector<Rgb> colors(1);
  EXPECT_EQ(names_of(written(model, GaussianKind::volumes, colors)),
            (Names{"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                   "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"}));
  EXPECT_EQ(names_of(written(model, GaussianKind::surfels, colors)),
            (Names{"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                   "scale_0", "scale_1", "rot_0", "rot_1", "rot_2", "rot_3"}));
}

// Oracle: the logarithm of the odds, and the radius where the opacity is half of that at the
// centre.
TEST(GaussianPly, SoftDisksKeepTheirOpacities) {
  SplatModel model = model_of({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  model.opacities = {0.25F, 1, 0};
  const Table table = written(model, GaussianKind::volumes, std::vector<Rgb>(3));
  EXPECT_NEAR(value(table, "opacity", 0), std::log(0.25 / 0.75), 1e-6);
  EXPECT_NEAR(value(table, "opacity", 1), std::log(kGaussianOpacity / (1 - kGaussianOpacity)),
              1e-5);
  EXPECT_TRUE(std::isfinite(value(table, "opacity", 2)));
  EXPECT_NEAR(std::exp(value(table, "scale_0", 0)), 0.05 / 1.3 * kGaussianSigmaOverRadius, 1e-6);
}

TEST(GaussianPly, ThirdAxisIsTheNormal) {
  const std::vector<Vec3d> normals = directions();
  const SplatModel model = model_of(normals);
  const Table table =
      written(model, GaussianKind::volumes, std::vector<Rgb>(normals.size(), Rgb{9, 9, 9}));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    double q[4];
    double squares = 0;
    for (int k = 0; k < 4; ++k) {
      q[k] = value(table, "rot_" + std::to_string(k), i);
      squares += q[k] * q[k];
    }
    EXPECT_NEAR(squares, 1, 1e-6);
    const Vec3d axis = rotation_from_quaternion(q[0], q[1], q[2], q[3]) * Vec3d{0, 0, 1};
    EXPECT_LT(length(axis - normals[i]), 1e-6) << i;
    EXPECT_EQ(value(table, "nx", i), static_cast<double>(model.disks[i].normal.x));
  }
}

// Oracle: what viewers do: sigma = exp(scale), alpha = 1 / (1 + exp(-opacity)), and
// colour = 0.5 + f_dc * sqrt(1 / (4 pi)).
TEST(GaussianPly, SizesOpacityAndColours) {
  const SplatModel model = model_of({{0, 0, 1}, {0, 1, 0}, {1, 0, 0}});
  const std::vector<Rgb> colors = {{0, 128, 255}, {1, 2, 3}, {200, 100, 50}};
  const Table table = written(model, GaussianKind::volumes, colors);
  for (std::size_t i = 0; i < model.size(); ++i) {
    const double radius = static_cast<double>(model.disks[i].radius);
    const double sigma = std::exp(value(table, "scale_0", i));
    EXPECT_EQ(value(table, "scale_0", i), value(table, "scale_1", i));
    EXPECT_NEAR(2 * std::numbers::pi * sigma * sigma, std::numbers::pi * radius * radius, 1e-6);
    EXPECT_NEAR(std::exp(value(table, "scale_2", i)) / sigma, 0.01, 1e-7);
    EXPECT_NEAR(1 / (1 + std::exp(-value(table, "opacity", i))), 0.99, 1e-7);
    for (std::size_t k = 0; k < 3; ++k) {
      const double f = value(table, "f_dc_" + std::to_string(k), i);
      EXPECT_NEAR(255 * (0.5 + f * std::sqrt(1 / (4 * std::numbers::pi))), colors[i][k], 1e-4);
    }
    EXPECT_EQ(value(table, "y", i), -2.0 * static_cast<double>(i));
  }
}

TEST(GaussianPly, FarPlacesAreRelativeToTheirOrigin) {
  SplatModel model = model_of({{0, 0, 1}});
  model.origin = {448000, 5411000.5, 0};
  const Table table = written(model, GaussianKind::surfels, std::vector<Rgb>(1));
  EXPECT_EQ(value(table, "x", 0), 0);
  EXPECT_EQ(table.comments, (Names{"adasplats.origin 448000 5411000.5 0", "adasplats.splats 1"}));
}

TEST(GaussianPly, NoDisksAndWrongColours) {
  EXPECT_EQ(written({}, GaussianKind::volumes, {}).rows, 0U);
  const TemporaryFolder folder;
  EXPECT_THROW(
      write_gaussian_ply(folder.path() / "g.ply", model_of({{0, 0, 1}}), {}, GaussianKind::volumes),
      std::logic_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace adasplats
