// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/splat_model.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/splats/model/any_model.h"

namespace adasplats {
namespace {

/// A splat at (4, 5, z) next to a valid one.
std::string model_text(const std::string& z, const std::string& radius, const std::string& label,
                       const std::string& group) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 2\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "radius", "class", "group"})
    text += std::string("property double ") + name + "\n";
  return text + "end_header\n1 2 3 0 0 1 0.5 40 0\n4 5 " + z + " 1 0 0 " + radius + " " + label +
         " " + group + "\n";
}

// Oracle: what a float, 16 bits and the groups can hold.
TEST(SplatModel, ValuesThatASplatCannotHaveAreErrors) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& text) {
    return load_model(folder.write("m.ply", text));
  };
  const SplatModel good = load(model_text("6", "0.1", "65535", "3"));
  EXPECT_EQ(good.classes, (std::vector<std::uint16_t>{40, 65535}));
  EXPECT_EQ(good.groups[1], SemanticGroup::non_surface);
  const auto rejected = [&](const std::string& text, const std::string& part) {
    expect_error(ErrorKind::data, {"m.ply", "splat ", part}, [&] { load(text); });
  };
  rejected(model_text("7777777777777777777777777777777777777777777", "0.1", "50", "1"), "too far");
  rejected(model_text("6", "1e-300", "50", "1"), "radius");
  rejected(model_text("6", "1e300", "50", "1"), "radius");
  for (const char* label : {"65536", "-1", "1.5", "nan"})
    rejected(model_text("6", "0.1", label, "1"), "class");
  for (const char* group : {"4", "-1", "0.5", "nan"})
    rejected(model_text("6", "0.1", "50", group), "group");
}

TEST(SplatModel, OtherVersionsOfTheFormatAreRejected) {
  const TemporaryFolder folder;
  std::string text = model_text("6", "0.1", "50", "1");
  text.insert(text.find("element"), "comment adasplats.splats 2\n");
  expect_error(ErrorKind::data, {"m.ply", "format version 2", "reads version 1"},
               [&] { load_model(folder.write("m.ply", text)); });
  text.replace(text.find("splats 2"), 8, "splats 1");
  EXPECT_EQ(load_model(folder.write("m.ply", text)).size(), 2U);
}

// Oracle: the opacity at the rim of the opaque disks (scene/soft_disk.h).
TEST(SplatModel, SoftDisksBecomeOpaqueOnes) {
  SplatModel soft;
  soft.disks.assign(3, {{1, 2, 3}, 0.65F, {0, 0, 1}});
  soft.disks[2].center.x = 4;
  soft.opacities = {0.9F, 0.25F, 0.4F};
  soft.classes = {5, 6, 7};
  const SplatModel made = opaque(soft);
  EXPECT_TRUE(made.opacities.empty());
  EXPECT_EQ(made.classes, (std::vector<std::uint16_t>{5, 7}));
  ASSERT_EQ(made.size(), 2U);
  EXPECT_EQ(made.disks[1].center.x, 4);
  for (const std::size_t k : {0U, 1U}) {
    const Disk& disk = made.disks[k];
    const Ray ray = {disk.center + Vec3f{disk.radius, 0, 5}, 0, {0, 0, -1}};
    EXPECT_NEAR(opacity_of_hit(ray, 5, soft.disks[2 * k], soft.opacities[2 * k]), 0.3, 1e-5);
  }
}

TEST(SplatModel, OpacitiesAreInTheFile) {
  const TemporaryFolder folder;
  SplatModel model;
  model.disks.assign(2, {{1, 2, 3}, 0.5F, {0, 0, 1}});
  model.opacities = {0.25F, 1};
  save_model(folder.path() / "m.ply", model);
  EXPECT_EQ(load_model(folder.path() / "m.ply").opacities, model.opacities);
  model.opacities = {0.25F, 1.5F};
  save_model(folder.path() / "m.ply", model);
  expect_error(ErrorKind::data, {"m.ply", "splat 1: opacity is 1.5", "expected 0 to 1"},
               [&] { load_model(folder.path() / "m.ply"); });
}

TEST(SplatModel, LogOddsOfLostBeamsAreInTheFile) {
  const TemporaryFolder folder;
  SplatModel model;
  model.disks.assign(2, {{1, 2, 3}, 0.5F, {0, 0, 1}});
  model.opacities = {0.25F, 1};
  model.drop_log_odds = {-1.5F, 3};
  save_model(folder.path() / "m.ply", model);
  EXPECT_EQ(load_model(folder.path() / "m.ply").drop_log_odds, model.drop_log_odds);
  EXPECT_EQ(opaque(model).drop_log_odds, std::vector<float>{3});
  model.drop_log_odds[1] = kNaN;
  save_model(folder.path() / "m.ply", model);
  expect_error(ErrorKind::data, {"m.ply", "splat 1: drop is nan", "expected -100 to 100"},
               [&] { load_model(folder.path() / "m.ply"); });
}

TEST(AnyModel, PointsAreRejectedWithTheCommandThatModelsThem) {
  const TemporaryFolder folder;
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
      "property double z\nend_header\n1 2 3\n";
  const auto load = [&](const std::filesystem::path& file) { load_any_model(file); };
  expect_error(ErrorKind::data, {"points.ply", "'nx'", "'adasplats model'"},
               [&] { load(folder.write("points.ply", points)); });
  expect_error(ErrorKind::data,
               {"points.las", "is a point cloud (LAS or LAZ)", "'adasplats model'"},
               [&] { load(folder.write("points.las", "LASF")); });
  expect_error(ErrorKind::no_input, {"is a folder", "'adasplats model'"},
               [&] { load(folder.path()); });
  expect_error(ErrorKind::no_input, {"missing.las"}, [&] { load(folder.path() / "missing.las"); });
}

}  // namespace
}  // namespace adasplats
