// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/provenance/provenance.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "adasplats/jobs/provenance/machine.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

TEST(Provenance, TellsWhatAFigureComesFrom) {
  const Json json = to_json(provenance_of(3));
  EXPECT_FALSE(json["version"].get<std::string>().empty());
  // tests/command_line/test_provenance.py says which commit it has to be.
  EXPECT_FALSE(json["commit"].get<std::string>().empty());
  EXPECT_TRUE(json["dirty"].is_null() || json["dirty"].is_boolean());
  EXPECT_TRUE(std::regex_match(json["date"].get<std::string>(),
                               std::regex(R"(20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ)")));
  EXPECT_EQ(json["machine"]["cores"], 3);
  EXPECT_GT(json["machine"]["memory_bytes"], 0);
  EXPECT_EQ(json["device"]["kind"], "cpu");
  EXPECT_TRUE(json["command"].get<std::string>().starts_with("adasplats_jobs_test"));
}

TEST(Provenance, QuotesWordsForAShell) {
  EXPECT_EQ(shell_word("a/b=1,2"), "a/b=1,2");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_word("it's here"), R"('it'\''s here')");
}

// Oracle: what the system's shell makes of it.
TEST(Provenance, AShellTakesWordsAsTheyAre) {
  for (const std::string word :
       {"plain/a-b_c.ply", "two words", "it's", "\"double\"", "$HOME", "`id`",
        "$(id)",           "a\\b",      "*",    "~",          "#x",    "a;b",
        "a&b|c",           "(x)",       "<in>", "!x",         "{a,b}", "ä ö",
        "tab\there",       "new\nline", "",     "'",          "[ab]",  "?"}) {
    FILE* const shell = popen(("printf '%s|' " + shell_word(word)).c_str(), "r");
    ASSERT_NE(shell, nullptr);
    std::string said;
    for (int c = std::fgetc(shell); c != EOF; c = std::fgetc(shell)) said += static_cast<char>(c);
    EXPECT_EQ(pclose(shell), 0);
    EXPECT_EQ(said, word + "|");
  }
}

TEST(Provenance, CommandsAreOfTheProgramAndQuoted) {
  EXPECT_EQ(command_text({}), "adasplats");
  EXPECT_EQ(command_text({"view", "my street/a.ply", "--sensor=x"}),
            "adasplats view 'my street/a.ply' --sensor=x");
}

TEST(DeviceJson, NamesWhatComputes) {
  DeviceChoice gpus;
  gpus.kind = DeviceKind::cuda;
  gpus.driver = "13.0";
  gpus.gpus.resize(2);
  gpus.gpus[0].name = "Imagined 0";
  gpus.gpus[1].name = "Imagined 2";
  gpus.gpus[1].index = 2;
  Json json = device_json(gpus);
  EXPECT_TRUE(json.contains("kernel_driver"));
  json.erase("kernel_driver");  // of this machine
  EXPECT_EQ(json["peak_bytes"].size(), 2U);
  json.erase("peak_bytes");
  EXPECT_EQ(json.dump(),
            R"({"kind":"cuda","name":"Imagined 0, Imagined 2","driver":"13.0","gpus":[0,2]})");
  const std::string cpu = device_json(DeviceChoice()).dump();
  EXPECT_TRUE(cpu.starts_with(R"({"kind":"cpu",)")) << cpu;
  EXPECT_TRUE(cpu.ends_with(R"("driver":null})")) << cpu;
}

}  // namespace
}  // namespace adasplats
