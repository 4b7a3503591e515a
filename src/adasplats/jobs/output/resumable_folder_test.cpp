// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/resumable_folder.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/unfinished_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const Json kContent = {{"seed", 1}, {"inputs", {{"a.bin", "12"}, {"b.bin", "34"}}}};

/// One attempt at a folder of 4 files; ends before file number `stop`. Gives the files it made.
std::vector<std::string> attempt(const fs::path& folder, int stop, const Json& content = kContent) {
  std::vector<std::string> made;
  ResumableFolder output(folder, false, "test", content);
  for (int i = 0; i < 4; ++i) {
    const std::string name = std::string("part/") + std::to_string(i);
    if (output.has(name)) continue;
    if (i == stop) return made;
    fs::create_directories(output.path() / "part");
    write_file(output.path() / name, std::string(1, static_cast<char>('a' + i)));
    output.record(name);
    made.push_back(name);
  }
  const std::string aid = "part/3";
  output.commit({{"count", 3}}, std::span(&aid, 1));
  return made;
}

std::string all_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  std::string text;
  for (const auto& [name, content] : files) text += name + "\n" + content + "\n";
  return text;
}

using Names = std::vector<std::string>;

// Oracle: the folder of an attempt that was not interrupted.
TEST(ResumableFolder, GoesOnWhereItStopped) {
  const TemporaryFolder folder;
  attempt(folder.path() / "whole", 9);
  const std::string whole = all_of(folder.path() / "whole");
  for (int stop = 0; stop < 4; ++stop) {
    const fs::path output = folder.path() / std::to_string(stop);
    EXPECT_EQ(attempt(output, stop).size(), static_cast<std::size_t>(stop));
    EXPECT_FALSE(fs::exists(output));
    EXPECT_EQ(attempt(output, 9).size(), static_cast<std::size_t>(4 - stop));
    EXPECT_EQ(all_of(output), whole);
    EXPECT_FALSE(
        fs::exists(folder.path() / (std::string(".") + std::to_string(stop) + ".unfinished")));
  }
  const Json content = Json::parse(read_file(folder.path() / "whole" / "adasplats.json"));
  EXPECT_EQ(content["command"], "test");
  EXPECT_EQ(content["count"], 3);
  EXPECT_EQ(content["outputs"].size(), 3U);
  EXPECT_EQ(content["outputs"]["part/1"], sha256_of_file(folder.path() / "whole/part/1"));
}

// Oracle: what is recorded by reading the file.
TEST(ResumableFolder, WhatIsDiscardedIsMadeAnew) {
  const TemporaryFolder folder;
  const fs::path output = folder.path() / "out";
  attempt(output, 2);
  {
    ResumableFolder again(output, false, "test", kContent);
    EXPECT_TRUE(again.has("part/1"));
    again.discard();
    EXPECT_FALSE(again.has("part/1"));
    EXPECT_TRUE(fs::is_empty(again.path() / kJournalFile)) << "even if the files stay";
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_EQ(attempt(output, 9).size(), 4U);
}

TEST(ResumableFolder, KnownDigestsAreRecordedAsTheyAre) {
  const TemporaryFolder folder;
  {
    ResumableFolder output(folder.path() / "o", false, "test", kContent);
    write_file(output.path() / "a", "abc");
    write_file(output.path() / "b", "abcd");
    const FileDigest known[] = {{"a", sha256_of("abc")}, {"b", sha256_of("abc")}};
    output.record(known);
    EXPECT_TRUE(output.has("a"));
    EXPECT_FALSE(output.has("b"));
  }
  ResumableFolder output(folder.path() / "o", false, "test", kContent);
  EXPECT_TRUE(output.has("a"));
  EXPECT_EQ(output.recorded().size(), 2U);
}

TEST(ResumableFolder, DamagedFilesAreMadeAgain) {
  const TemporaryFolder folder;
  attempt(folder.path() / "whole", 9);
  attempt(folder.path() / "o", 3);
  folder.write(".o.unfinished/part/1", "x");
  fs::remove(folder.path() / ".o.unfinished/part/2");
  folder.write(".o.unfinished/part/.adasplats-7-0.tmp", "half");
  EXPECT_EQ(attempt(folder.path() / "o", 9), (Names{"part/1", "part/2", "part/3"}));
  EXPECT_EQ(all_of(folder.path() / "o"), all_of(folder.path() / "whole"));
}

TEST(ResumableFolder, TornJournal) {
  const TemporaryFolder folder;
  attempt(folder.path() / "o", 3);
  const fs::path journal = folder.path() / ".o.unfinished/journal.sha256";
  const std::string text = read_file(journal);
  folder.write(".o.unfinished/journal.sha256", text.substr(0, text.size() - 5));
  EXPECT_EQ(attempt(folder.path() / "o", 3), Names{"part/2"});
  EXPECT_EQ(read_file(journal), text);
  // The last line alone can be torn; anything else was not written by us.
  folder.write(".o.unfinished/journal.sha256", text.substr(5));
  expect_error(ErrorKind::cannot_create, {"journal.sha256:1", ".o.unfinished"},
               [&] { attempt(folder.path() / "o", 9); });
}

TEST(ResumableFolder, OtherRunsAreRefused) {
  const TemporaryFolder folder;
  attempt(folder.path() / "o", 2);
  Json other = kContent;
  other["seed"] = 2;
  expect_error(ErrorKind::cannot_create, {".o.unfinished", "seed was 1 and is 2"},
               [&] { attempt(folder.path() / "o", 9, other); });
  other = kContent;
  other["inputs"]["b.bin"] = "56";
  expect_error(ErrorKind::cannot_create, {"inputs.b.bin was \"34\" and is \"56\""},
               [&] { attempt(folder.path() / "o", 9, other); });
  other["inputs"].erase("b.bin");
  expect_error(ErrorKind::cannot_create, {"inputs.b.bin was \"34\" and is nothing"},
               [&] { attempt(folder.path() / "o", 9, other); });
  // The refused ones left all as it was.
  EXPECT_EQ(attempt(folder.path() / "o", 9), (Names{"part/2", "part/3"}));
  expect_error(ErrorKind::cannot_create, {"not empty"}, [&] { attempt(folder.path() / "o", 9); });
}

TEST(ResumableFolder, ForeignAndDamagedFolders) {
  const TemporaryFolder folder;
  folder.write(".o.unfinished/thesis.txt", "x");
  expect_error(ErrorKind::cannot_create, {"adasplats.json"},
               [&] { attempt(folder.path() / "o", 9); });
  EXPECT_TRUE(fs::exists(folder.path() / ".o.unfinished/thesis.txt"));
  folder.write(".p.unfinished/adasplats.json", "{");
  expect_error(ErrorKind::cannot_create, {"damaged"}, [&] { attempt(folder.path() / "p", 9); });
  fs::create_directory(folder.path() / ".q.unfinished");
  EXPECT_EQ(attempt(folder.path() / "q", 9).size(), 4U);
}

TEST(ResumableFolder, OneProcessAtATime) {
  const TemporaryFolder folder;
  {
    const ResumableFolder first(folder.path() / "o", false, "test", kContent);
    expect_error(ErrorKind::cannot_create, {"another process"},
                 [&] { attempt(folder.path() / "o", 9); });
  }
  // Nothing was recorded, nothing is left.
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace adasplats
