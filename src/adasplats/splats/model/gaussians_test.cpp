// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussians.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/io/text/gltf.h"
#include "adasplats/splats/model/any_model.h"
#include "adasplats/splats/model/gaussian_glb.h"
#include "adasplats/splats/model/gaussian_ply.h"

namespace adasplats {
namespace {

using Colors = std::vector<std::array<std::uint8_t, 3>>;

/// Disks in all directions, far from zero, with every value that models have.
SplatModel rich_model(bool is_soft) {
  SplatModel model;
  model.origin = {650'000, 6'860'000, 30};
  for (std::uint64_t i = 0; i < 300; ++i) {
    Random random(9, 0, i);
    const auto number = [&](double low, double high) {
      return static_cast<float>(random.uniform(low, high));
    };
    Disk disk;
    disk.center = {number(-50, 50), number(-50, 50), number(-3, 12)};
    disk.radius = number(0.02, 0.7);
    disk.normal = vec_cast<float>(
        normalized(Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}));
    model.disks.push_back(disk);
    if (is_soft) model.opacities.push_back(number(0.1, 0.95));
    model.classes.push_back(static_cast<std::uint16_t>(random.uniform(0, 260)));
    model.groups.push_back(static_cast<SemanticGroup>(i % 4));
    model.intensities.push_back(number(0, 1));
    model.drop_log_odds.push_back(number(-3, 3));
  }
  model.label_scheme = "semantickitti";
  model.method = "consistent";
  return model;
}

Colors colors_for(const SplatModel& model) {
  Colors colors;
  for (std::size_t i = 0; i < model.size(); ++i)
    colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 7});
  return colors;
}

void expect_same_disks(const SplatModel& found, const SplatModel& model) {
  ASSERT_EQ(found.size(), model.size());
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Disk &a = found.disks[i], &b = model.disks[i];
    const Vec3d from = found.origin + vec_cast<double>(a.center),
                to = model.origin + vec_cast<double>(b.center);
    EXPECT_NEAR(length(from - to), 0, 1e-5);
    EXPECT_NEAR(a.radius, b.radius, 1e-6 * static_cast<double>(b.radius) + 1e-7);
    EXPECT_NEAR(length(a.normal - b.normal), 0, 1e-6);
  }
}

TEST(GaussianGlb, IsReadBackWithEverything) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "model.glb";
  for (const bool is_soft : {false, true}) {
    const SplatModel model = rich_model(is_soft);
    write_gaussian_glb(file, model, colors_for(model));
    EXPECT_TRUE(is_gltf(file) && has_gltf_splats(file) && !is_mesh_file(file));
    const SplatModel found = load_model(file);
    expect_same_disks(found, model);
    EXPECT_EQ(found.opacities, model.opacities);
    EXPECT_EQ(found.classes, model.classes);
    EXPECT_EQ(found.groups, model.groups);
    EXPECT_EQ(found.intensities, model.intensities);
    EXPECT_EQ(found.drop_log_odds, model.drop_log_odds);
    EXPECT_EQ(found.label_scheme, "semantickitti");
    EXPECT_EQ(found.method, "consistent");
    EXPECT_EQ(found.colors[3], colors_for(model)[3]);
    EXPECT_TRUE(std::holds_alternative<SplatModel>(load_any_model(file)));
  }
}

TEST(GaussianPly, IsReadBackAsDisks) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "gaussians.ply";
  for (const GaussianKind kind : {GaussianKind::volumes, GaussianKind::surfels})
    for (const bool is_soft : {false, true}) {
      const SplatModel model = rich_model(is_soft);
      write_gaussian_ply(file, model, colors_for(model), kind);
      const SplatModel found = load_model(file);
      expect_same_disks(found, model);
      ASSERT_EQ(found.opacities.size(), model.opacities.size());
      for (std::size_t i = 0; i < model.opacities.size(); ++i)
        EXPECT_NEAR(found.opacities[i], model.opacities[i], 1e-5);
    }
}

/// A PLY as training programs write it.
std::filesystem::path trained(const TemporaryFolder& folder, const std::string& rows, int count) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (const char* name :
       {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "f_rest_0", "opacity",
        "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    text += "property float " + std::string(name) + "\n";
  return folder.write("trained.ply", text + "end_header\n" + rows);
}

// The shortest axis of the first is its y, turned by 90 degrees about z to -x; its rotation is not
// of unit length, as in trained files. The second is invisible.
TEST(GaussianPly, VolumesOfOtherProgramsBecomeDisks) {
  const TemporaryFolder folder;
  const auto file = trained(folder,
                            "1 2 3 0 0 0 1.7724539 0 -9 0.5 0 -1 -4 -2 2 0 0 2\n"
                            "1 2 3 0 0 0 0 0 0 0.5 -8 -1 -1 -2 1 0 0 0\n",
                            2);
  const SplatModel found = load_model(file);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(std::fabs(found.disks[0].normal.x), 1, 1e-6);
  EXPECT_NEAR(found.opacities[0], 0.5, 1e-6);
  EXPECT_NEAR(found.disks[0].radius, 1.3 * std::sqrt(2 * std::exp(-1.0) * std::exp(-2.0)), 1e-6);
  EXPECT_EQ(found.colors[0], (ColorBytes{255, 128, 0}));
}

void expect_error(const std::filesystem::path& file, const std::string& says) {
  try {
    load_model(file);
    FAIL() << says << ": accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::data) << says;
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

// Compressed files give opacities of exactly 1, whose logit is infinite.
TEST(GaussianPly, AnInfiniteLogitIsOpaque) {
  const TemporaryFolder folder;
  const SplatModel found = load_model(trained(folder,
                                              "1 2 3 0 0 0 0 0 0 0.5 inf -1 -4 -2 1 0 0 0\n"
                                              "1 2 3 0 0 0 0 0 0 0.5 0 -1 -1 -2 1 0 0 0\n",
                                              2));
  EXPECT_EQ(found.opacities, (std::vector<float>{1, 0.5F}));
}

TEST(GaussianPly, WrongValuesAreNamed) {
  const TemporaryFolder folder;
  expect_error(trained(folder, "1 2 3 0 0 0 0 0 0 0.5 nan -1 -4 -2 1 0 0 0\n", 1),
               "opacity is not finite");
  expect_error(trained(folder, "1 2 3 0 0 0 0 0 0 0.5 0 -1 -4 -2 0 0 0 0\n", 1), "rotation is 0");
  expect_error(trained(folder, "1 2 3 0 0 0 0 0 0 0.5 0 nan -4 -2 1 0 0 0\n", 1),
               "scale_0 is not finite");
  expect_error(trained(folder, "1 2 3 0 0 0 0 0 0 0.5 -9 -1 -4 -2 1 0 0 0\n", 1), "invisible");
}

/// The same file with a part of its JSON replaced by one of the same length.
std::filesystem::path changed(const TemporaryFolder& folder, const std::filesystem::path& file,
                              const std::string& from, std::string to) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  to.resize(from.size(), ' ');
  bytes.replace(bytes.find(from), from.size(), to);
  return folder.write("changed.glb", bytes);
}

TEST(GaussianGlb, LinearColoursBecomeSrgb) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "model.glb";
  const SplatModel model = rich_model(false);
  write_gaussian_glb(file, model, Colors(model.size(), {55, 128, 188}));
  const SplatModel found =
      load_model(changed(folder, file, R"("srgb_rec709_display")", R"("lin_rec709_display")"));
  EXPECT_EQ(found.colors[0], (ColorBytes{128, 188, 223}));  // IEC 61966-2-1
}

TEST(GaussianGlb, WrongContentIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "model.glb";
  const SplatModel model = rich_model(true);
  write_gaussian_glb(file, model, colors_for(model));
  expect_error(changed(folder, file, R"("kernel":"ellipse")", R"("kernel":"custom")"), "ellipse");
  expect_error(changed(folder, file, R"("KHR_gaussian_splatting:SCALE")", R"("_B")"),
               "SCALE' is missing");
  expect_error(changed(folder, file, R"("count":300,"type":"SCALAR"})", R"("count":9e9})"), "");
  expect_error(changed(folder, file, R"("bufferView":3,"componentType":5126,"count":300)",
                       R"("bufferView":99,"componentType":5126,"count":30)"),
               "there are only");
  expect_error(changed(folder, file, R"("rotation":[-0.5,-0.5,-0.5,0.5])", R"("scale":[1,1,2])"),
               "unevenly");
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97) {
    const auto cut = folder.write("cut.glb", bytes.substr(0, size));
    EXPECT_THROW(load_model(cut), Error) << size;
  }
}

}  // namespace
}  // namespace adasplats
