// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/splat_model.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/core/temporary_folder_test.h"
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
