// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/panel.h"

#include <gtest/gtest.h>

#include <fstream>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {
namespace {

/// A slope of points, 1 m high per metre from `low` on, with or without intensities.
std::filesystem::path slope(const std::filesystem::path& file, double low, bool intensities) {
  std::ofstream out(file);
  out << (intensities ? "x y z intensity\n" : "x y z\n");
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) {
      out << 0.5 * x << " " << 0.5 * y << " " << low + 0.5 * x;
      out << (intensities ? " " + std::to_string(0.001 * x) : "") << "\n";
    }
  return file;
}

Camera from_afar(const Panel& panel) {
  Camera camera = overview(panel.shown_part(), 64, 48, 0.8);
  return camera;
}

// A panel beside one that shows something else is as it is alone: intensities are no heights.
TEST(Panel, AScaleIsSharedByPanelsThatShowTheSameAlone) {
  const TemporaryFolder folder;
  OwnSession session;
  const auto bright = slope(folder.path() / "bright.xyz", 0, true);
  const auto low = slope(folder.path() / "low.xyz", 0, false);
  const auto high = slope(folder.path() / "high.xyz", 6, false);
  const PanelLook look;
  const auto drawn = [&](const std::vector<std::filesystem::path>& inputs) {
    SharedRange range;
    Image image;
    for (const auto& input : inputs) {
      Panel panel(input, "", session);
      panel.prepare(look, range);
      image = panel.draw(from_afar(panel), look, session.executor);
    }
    return image.pixels;
  };
  EXPECT_EQ(drawn({bright, low}), drawn({low}));
  EXPECT_NE(drawn({high, low}), drawn({low})) << "the same scale for both";
  EXPECT_EQ(drawn({low, low}), drawn({low}));
}

TEST(ClassLegend, HasWhatIsThereTheCommonestFirst) {
  const LabelScheme labels("mine",
                           {{1, "road", SemanticGroup::ground, Mobility::fixed, {9, 9, 9}},
                            {2, "wall", SemanticGroup::surface, Mobility::fixed, {8, 8, 8}},
                            {3, "none", SemanticGroup::linear, Mobility::fixed, {0, 0, 0}},
                            {4, "rare", SemanticGroup::linear, Mobility::fixed, {7, 7, 7}},
                            {5, "gone", SemanticGroup::linear, Mobility::fixed, {6, 6, 6}}});
  std::vector<std::uint16_t> classes(5000, 2);
  classes.resize(7000, 1);
  classes.resize(9000, 3);
  classes.push_back(4);
  const ClassLegend legend = legend_of(classes, &labels);
  ASSERT_EQ(legend.size(), 2U);
  EXPECT_EQ(legend[0].second, "wall");
  EXPECT_EQ(legend[1].second, "road");
  EXPECT_TRUE(legend_of(classes, nullptr).empty());
}

}  // namespace
}  // namespace adasplats
