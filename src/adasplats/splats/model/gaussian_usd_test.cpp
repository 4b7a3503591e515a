// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Values are compared by tests/exports; this is of names and of what a model lacks.
#include "adasplats/splats/model/gaussian_usd.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

std::string usd_text(const SplatModel& model, const LabelScheme* labels) {
  const TemporaryFolder folder;
  const std::vector<ColorBytes> colors(model.size());
  write_gaussian_usd(folder.path() / "m.usda", model, colors, labels);
  std::ifstream stream(folder.path() / "m.usda");
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(GaussianUsd, NamesPrimsByTheirClasses) {
  SplatModel model;
  model.origin = {500000.5, 0, -1};
  model.disks.assign(4, Disk{{1, 2, 3}, 0.5F, {0, 0, 1}});
  model.classes = {1, 2, 3, 7};
  model.intensities = {0.5F, std::numeric_limits<float>::quiet_NaN(), 1, 0};
  const LabelScheme labels("own", {{1, "traffic sign", {}, {}, {}},
                                   {2, "traffic-sign", {}, {}, {}},
                                   {3, "3d \"thing\"", {}, {}, {}}});
  const std::string text = usd_text(model, &labels);
  for (const char* part :
       {"double3 xformOp:translate = (500000.5, 0, -1)", "Splat \"traffic_sign\"",
        "Splat \"traffic_sign_\"", "Splat \"class_3d__thing_\"", "Splat \"class_7\"",
        R"(semantics:labels:class = ["3d \"thing\""])", "primvars:intensity = [0] ("})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(GaussianUsd, WithoutClassesIsOnePrimWithoutLabels) {
  SplatModel model;
  model.disks.assign(2, Disk{{1, 2, 3}, 0.5F, {0, 0, 1}});
  const std::string text = usd_text(model, nullptr);
  EXPECT_NE(text.find("Splat \"splats\"\n"), std::string::npos);
  EXPECT_EQ(text.find("semantics"), std::string::npos);
  EXPECT_EQ(text.find("primvars"), std::string::npos);
  EXPECT_THROW(write_gaussian_usd("m.usda", model, {}, nullptr), std::logic_error);
}

}  // namespace
}  // namespace adasplats
