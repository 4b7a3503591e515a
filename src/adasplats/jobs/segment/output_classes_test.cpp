// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/output_classes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

const std::vector<std::string> kNames = {"road", "car", "truck", "pole"};

class ClassMap : public testing::Test {
 protected:
  OutputClasses read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_class_map(file_, kNames);
  }
  void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
    expect_error(ErrorKind::config, parts, [&] { read(text); });
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "map.txt";
};

TEST_F(ClassMap, GivesNumbersAndNames) {
  const OutputClasses outputs = read(
      "# mine\n\nroad = 1 street\r\ncar=7 8 9 vehicle # parked, too\ntruck = 7 vehicle\n"
      "unknown = 99\nunlabeled = 255\n");
  ASSERT_EQ(outputs.classes.size(), 3U);
  EXPECT_EQ(outputs.classes[1].id, 7);
  EXPECT_EQ(outputs.classes[1].name, "vehicle");
  EXPECT_EQ(outputs.classes[2].id, 99);
  EXPECT_EQ(outputs.classes[2].name, "unknown");
  EXPECT_EQ(outputs.of_network, (std::vector<std::size_t>{0, 1, 1, 2}));
  EXPECT_EQ(outputs.unlabeled, 255);
  EXPECT_TRUE(outputs.joins());
}

TEST_F(ClassMap, WithoutNamesTheyAreTheNetworks) {
  const OutputClasses outputs = read("road = 4\ncar = 3\ntruck = 2\npole = 1");
  EXPECT_EQ(outputs.classes[3].name, "pole");
  EXPECT_EQ(outputs.unlabeled, 0);
  EXPECT_FALSE(outputs.joins());
}

TEST_F(ClassMap, IsRefusedWithTheLine) {
  const std::string rest = "unknown = 9\n";
  expect_refused(rest + "rod = 1\n", {"map.txt:2", "no class 'rod'", "'road'"});
  expect_refused(rest + "road 1\n", {"map.txt:2", "CLASS = NUMBER"});
  expect_refused(rest + "= 1\n", {"map.txt:2", "CLASS = NUMBER"});
  expect_refused(rest + "road = \n", {"map.txt:2", "no number for 'road'"});
  expect_refused(rest + "road = street\n", {"map.txt:2", "'street' is no number"});
  expect_refused(rest + "road = -1\n", {"'-1' is no number"});
  expect_refused(rest + "road = 65536\n", {"'65536' is no number"});
  expect_refused(rest + "road = 1.5\n", {"'1.5' is no number"});
  expect_refused(rest + "road = 1 a b\n", {"'b' behind the name"});
  expect_refused(rest + "road = 1\nroad = 2 b\n", {"map.txt:3", "second time"});
  expect_refused(rest + "road = 1 a\ncar = 1 b\n", {"map.txt:3", "number 1 is 'a' and 'b'"});
  expect_refused(rest + "road = 1 a\ncar = 2 a\n", {"map.txt:3", "'a' is number 1 and 2"});
  expect_refused("road = 1\ncar = 2\npole = 3\n", {"map.txt", "'truck'", "'unknown'"});
  expect_error(ErrorKind::no_input, {"none.txt"},
               [&] { read_class_map(folder_.path() / "none.txt", kNames); });
}

TEST(OutputClasses, ProbabilitiesAreSummed) {
  OutputClasses outputs;
  outputs.classes = {{1, "a"}, {2, "b"}};
  outputs.of_network = {1, 0, 1};
  const std::vector<float> probabilities = {0.25F, 0.5F, 0.25F, 1, 0, 0};
  EXPECT_EQ(outputs.joined(probabilities), (std::vector<float>{0.5F, 0.5F, 0, 1}));
}

TEST(OutputClasses, AreThoseOfSemanticKitti) {
  const std::vector<std::string> names = {"pole", "road"};
  const OutputClasses outputs = semantickitti_outputs(names, "n");
  EXPECT_EQ(outputs.classes[0].id, 80);
  EXPECT_EQ(outputs.classes[1].id, 40);
  const std::vector<std::string> own = {"pole", "kerb"};
  expect_error(ErrorKind::data, {"n: ", "'kerb'", "class_map"},
               [&] { semantickitti_outputs(own, "n"); });
}

}  // namespace
}  // namespace adasplats
