// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/label_scheme.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

// Oracle: the published semantic-kitti.yaml.
TEST(LabelScheme, SemanticKittiAsPublished) {
  const LabelScheme& scheme = semantickitti_labels();
  EXPECT_EQ(scheme.classes().size(), 34U);
  const SemanticClass* road = scheme.find(std::uint16_t{40});
  ASSERT_NE(road, nullptr);
  EXPECT_EQ(road->name, "road");
  EXPECT_EQ(road->group, SemanticGroup::ground);
  EXPECT_EQ(road->mobility, Mobility::fixed);
  EXPECT_EQ(road->rgb, (std::array<std::uint8_t, 3>{255, 0, 255}));
  // The file lists the car as [245, 150, 100] in the order blue, green, red.
  EXPECT_EQ(scheme.find("car")->rgb, (std::array<std::uint8_t, 3>{100, 150, 245}));
  EXPECT_EQ(scheme.find(std::uint16_t{259})->name, "moving-other-vehicle");
  EXPECT_EQ(scheme.find(std::uint16_t{2}), nullptr);
  EXPECT_EQ(scheme.find(std::uint16_t{65535}), nullptr);
  EXPECT_EQ(scheme.find("caar"), nullptr);
}

TEST(LabelScheme, SemanticKittiMobilityFollowsTheIds) {
  for (const SemanticClass& c : semantickitti_labels().classes()) {
    const Mobility expected = c.id >= 252                ? Mobility::moving
                              : c.id >= 10 && c.id <= 32 ? Mobility::movable
                                                         : Mobility::fixed;
    EXPECT_EQ(c.mobility, expected) << c.name;
    EXPECT_EQ(c.name.starts_with("moving-"), c.id >= 252) << c.name;
  }
}

// Oracle: the numbers and names in the data sets' own files.
TEST(LabelScheme, PandaSetAndNuscenesAsPublished) {
  EXPECT_EQ(pandaset_labels().classes().size(), 43U);
  EXPECT_EQ(pandaset_labels().find(std::uint16_t{7})->name, "Road");
  EXPECT_EQ(pandaset_labels().find("Other Vehicle - Pedicab")->id, 21);
  EXPECT_EQ(pandaset_labels().find("Other Static Object")->id, 42);
  EXPECT_EQ(nuscenes_labels().classes().size(), 33U);
  EXPECT_EQ(nuscenes_labels().find("flat.driveable_surface")->id, 24);
  EXPECT_EQ(nuscenes_labels().find(std::uint16_t{31})->name, "vehicle.ego");
  for (const LabelScheme* scheme : known_label_schemes()) {
    EXPECT_EQ(load_label_scheme(scheme->name()).name(), scheme->name());
    for (const SemanticClass& known : scheme->classes())
      EXPECT_EQ(scheme->find(known.name)->id, known.id) << known.name;
  }
}

// Oracle: ASPRS, "LAS specification 1.4 - R15", table 17.
TEST(LabelScheme, ClassesOfLas) {
  EXPECT_EQ(asprs_labels().classes().size(), 256U);
  EXPECT_EQ(asprs_labels().find(std::uint16_t{2})->name, "ground");
  EXPECT_EQ(asprs_labels().find("high vegetation")->id, 5);
  EXPECT_EQ(asprs_labels().find("bridge deck")->id, 17);
  EXPECT_EQ(asprs_labels().find("temporal exclusion")->id, 22);
  EXPECT_EQ(asprs_labels().find(std::uint16_t{63})->name, "reserved 63");
  EXPECT_EQ(asprs_labels().find(std::uint16_t{64})->name, "user class 64");
  EXPECT_EQ(asprs_labels().find(std::uint16_t{255})->group, SemanticGroup::surface);
  EXPECT_EQ(asprs_labels().find(std::uint16_t{256}), nullptr);
}

// Oracle: the examples of paper section "Adaptive Splatting" for each group.
TEST(LabelScheme, GroupsOfThePaper) {
  for (const char* name : {"road", "sidewalk"}) {
    EXPECT_EQ(semantickitti_labels().find(name)->group, SemanticGroup::ground);
    EXPECT_EQ(paris_carla_3d_labels().find(name)->group, SemanticGroup::ground);
  }
  for (const char* name : {"pole", "traffic-sign"}) {
    EXPECT_EQ(semantickitti_labels().find(name)->group, SemanticGroup::linear);
    EXPECT_EQ(paris_carla_3d_labels().find(name)->group, SemanticGroup::linear);
  }
  for (const char* name : {"vegetation", "fence"}) {
    EXPECT_EQ(semantickitti_labels().find(name)->group, SemanticGroup::non_surface);
    EXPECT_EQ(paris_carla_3d_labels().find(name)->group, SemanticGroup::non_surface);
  }
  EXPECT_EQ(semantickitti_labels().find("building")->group, SemanticGroup::surface);
  EXPECT_EQ(paris_carla_3d_labels().find("building")->group, SemanticGroup::surface);
}

TEST(LabelScheme, ParisCarla3dHasAllIds) {
  ASSERT_EQ(paris_carla_3d_labels().classes().size(), 23U);
  for (std::uint16_t id = 0; id < 23; ++id) EXPECT_EQ(paris_carla_3d_labels().classes()[id].id, id);
  EXPECT_EQ(paris_carla_3d_labels().find("vehicles")->mobility, Mobility::movable);
}

TEST(LabelScheme, SortsAndRefusesTwins) {
  const SemanticClass a{7, "a", SemanticGroup::linear, Mobility::fixed, {}};
  const SemanticClass b{3, "b", SemanticGroup::linear, Mobility::fixed, {}};
  EXPECT_EQ(LabelScheme("s", {a, b}).classes().front().name, "b");
  EXPECT_THROW(LabelScheme("s", {a, b, a}), std::logic_error);
  EXPECT_EQ(LabelScheme("s", {}).find(std::uint16_t{0}), nullptr);
}

TEST(LabelScheme, NamesOfGroups) {
  EXPECT_EQ(name_of(SemanticGroup::ground), "ground");
  EXPECT_EQ(name_of(SemanticGroup::non_surface), "non-surface");
}

constexpr const char* kGoodScheme = R"(name = "mine"
[[class]]
id = 5
name = "pole"
group = "linear"
[[class]]
id = 65535
name = "bus"
group = "non-surface"
mobility = "moving"
rgb = [255, 240, 150]
)";

TEST(LoadLabelScheme, ByNameAndFromFile) {
  EXPECT_EQ(load_label_scheme("semantickitti").classes().size(), 34U);
  EXPECT_EQ(load_label_scheme("paris-carla-3d").classes().size(), 23U);
  const TemporaryFolder folder;
  const LabelScheme scheme = load_label_scheme(folder.write("my labels é.toml", kGoodScheme));
  EXPECT_EQ(scheme.name(), "mine");
  ASSERT_EQ(scheme.classes().size(), 2U);
  EXPECT_EQ(scheme.classes()[0].group, SemanticGroup::linear);
  EXPECT_EQ(scheme.classes()[0].mobility, Mobility::fixed);
  EXPECT_EQ(scheme.classes()[1].id, 65535);
  EXPECT_EQ(scheme.classes()[1].group, SemanticGroup::non_surface);
  EXPECT_EQ(scheme.classes()[1].mobility, Mobility::moving);
  EXPECT_EQ(scheme.classes()[1].rgb, (std::array<std::uint8_t, 3>{255, 240, 150}));
}

TEST(LoadLabelScheme, UnknownNameSuggests) {
  expect_error(ErrorKind::no_input, {"semantickity", "'semantickitti'"},
               [] { load_label_scheme("semantickity"); });
  expect_error(ErrorKind::no_input, {}, [] { load_label_scheme(std::string(10000, 'x')); });
}

struct BadScheme {
  const char* text;
  std::vector<std::string> parts;
};

class LoadLabelSchemeBad : public testing::TestWithParam<BadScheme> {};

TEST_P(LoadLabelSchemeBad, IsAConfigErrorWithTheLine) {
  const TemporaryFolder folder;
  const std::string file = folder.write("bad.toml", GetParam().text);
  std::vector<std::string> parts = GetParam().parts;
  parts.front() = file + ":" + parts.front() + ":";
  expect_error(ErrorKind::config, parts, [&] { load_label_scheme(file); });
}

INSTANTIATE_TEST_SUITE_P(
    All, LoadLabelSchemeBad,
    testing::Values(BadScheme{"", {"1", "'name'"}}, BadScheme{"name = \"a\"\n", {"1", "[[class]]"}},
                    BadScheme{"name = \"a\"\nclass = 3\n", {"2", "[[class]]"}},
                    BadScheme{"name = \"a\"\nclass = []\n", {"2", "[[class]]"}},
                    BadScheme{"name = \"a\"\nnome = 3\n", {"2", "'nome'", "'name'"}},
                    BadScheme{"name = \"a\"\nname = \"b\"\n", {"2"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nnmae = \"x\"\n",
                              {"4", "'nmae'", "'name'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nid = 2\n", {"4"}},
                    BadScheme{"name = \"a\"\n[[class]]\nname = \"x\"\n", {"2", "'id'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 65536\n", {"3", "65535"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = -1\n", {"3", "'id'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1.0\n", {"3", "'id'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nname = \"x\"\ngroup = \"liner\"\n",
                              {"5", "'liner'", "'linear'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nname = \"x\"\ngroup = \"linear\"\n"
                              "mobility = \"mobile\"\n",
                              {"6", "'mobile'", "'movable'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nname = \"x\"\ngroup = \"linear\"\n"
                              "rgb = [1, 2, 256]\n",
                              {"6", "'rgb'"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nname = \"x\"\ngroup = \"linear\"\n"
                              "[[class]]\nid = 1\nname = \"y\"\ngroup = \"linear\"\n",
                              {"7", "duplicate id 1"}},
                    BadScheme{"name = \"a\"\n[[class]]\nid = 1\nname = \"x\"\ngroup = \"linear\"\n"
                              "[[class]]\nid = 2\nname = \"x\"\ngroup = \"linear\"\n",
                              {"8", "duplicate class name 'x'"}},
                    BadScheme{"name = \"a\n", {"1"}}));

TEST(LoadLabelScheme, DeepNestingIsAnErrorAndNoCrash) {
  const TemporaryFolder folder;
  const std::string brackets = "a = " + std::string(100000, '[');
  std::string tables = "a = ", keys = "a", header = "[a";
  for (int i = 0; i < 100000; ++i) {
    tables += "{a=";
    keys += ".a";
    header += ".a";
  }
  for (const std::string& text : {brackets, tables, keys + " = 1\n", header + "]\n"}) {
    const std::string file = folder.write("deep.toml", text);
    expect_error(ErrorKind::config, {file + ":1:"}, [&] { load_label_scheme(file); });
  }
}

}  // namespace
}  // namespace adasplats
