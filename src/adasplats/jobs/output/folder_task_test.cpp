// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/folder_task.h"

#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const Json kPlanned = {{"side", 3}, {"bytes", 12}};

/// What a run does before its tasks, in the folder "o".
void begin(const fs::path& folder) {
  ResumableFolder output(folder / "o", false, "test", kPlanned);
  write_file(output.path() / "known", "abc");
  output.record("known");
}

/// A task that makes one file; whether it was to do.
bool work(const fs::path& folder, const std::string& name) {
  FolderTask task(folder / "o", "test", {{"side", 3}});
  if (task.has(name)) return false;
  write_file(task.path() / name, "made of " + name);
  task.record(name);
  return true;
}

TEST(FolderTask, MakesFilesThatTheRunTakes) {
  const TemporaryFolder folder;
  begin(folder.path());
  EXPECT_TRUE(work(folder.path(), "a"));
  EXPECT_FALSE(work(folder.path(), "a"));
  EXPECT_TRUE(work(folder.path(), "b"));
  const fs::path unfinished = folder.path() / ".o.unfinished";
  EXPECT_EQ(read_file(unfinished / "a.sha256"), sha256_of("made of a") + "  a\n");
  {
    ResumableFolder output(folder.path() / "o/", false, "test", kPlanned);
    EXPECT_TRUE(output.take("a"));
    EXPECT_TRUE(output.take("b"));
    EXPECT_FALSE(output.take("c"));
    EXPECT_EQ(output.recorded().at("a"), sha256_of("made of a"));
    folder.write(".o.unfinished/.adasplats-7-0.tmp", "half");  // of a task of another machine
    const std::string aid = "known";
    output.commit(Json::object(), std::span(&aid, 1));
  }
  // The notes are no part of it.
  const Json content = Json::parse(read_file(folder.path() / "o" / "adasplats.json"));
  EXPECT_EQ(content["outputs"].size(), 2U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path() / "o"), {}), 3);
  // A task that comes late finds it done.
  FolderTask late(folder.path() / "o/", "test", {{"side", 3}});
  EXPECT_TRUE(late.is_finished());
  EXPECT_TRUE(late.has("a"));
  folder.write("o/a", "something else");
  EXPECT_FALSE(late.has("a"));
}

TEST(FolderTask, DamagedFilesAreNotDone) {
  const TemporaryFolder folder;
  begin(folder.path());
  EXPECT_TRUE(work(folder.path(), "a"));
  folder.write(".o.unfinished/a", "something else");
  EXPECT_TRUE(work(folder.path(), "a"));
  for (const char* const note : {"", "what?\n", "12  a\n"}) {
    folder.write(".o.unfinished/a.sha256", note);
    EXPECT_TRUE(work(folder.path(), "a")) << note;
  }
  // A note of another file, or one that is cut short.
  folder.write(".o.unfinished/a.sha256", sha256_of("made of a") + "  b\n");
  EXPECT_TRUE(work(folder.path(), "a"));
  folder.write(".o.unfinished/a.sha256", sha256_of("made of a") + "  a");
  EXPECT_TRUE(work(folder.path(), "a"));
  EXPECT_FALSE(work(folder.path(), "a"));
  folder.write(".o.unfinished/a", "something else");
  ResumableFolder output(folder.path() / "o", false, "test", kPlanned);
  EXPECT_FALSE(output.take("a"));
  fs::remove(output.path() / "a");
  EXPECT_FALSE(output.take("a"));
}

TEST(Digests, AreReadAsWritten) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "n.sha256";
  EXPECT_FALSE(read_digests(file));
  write_digests(file, {});
  ASSERT_TRUE(read_digests(file));
  EXPECT_TRUE(read_digests(file)->empty());
  const std::vector<FileDigest> digests = {{"b/two words", sha256_of("b")}, {"a", sha256_of("a")}};
  write_digests(file, digests);
  const auto read = read_digests(file);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ((*read)[k].name, digests[k].name);
    EXPECT_EQ((*read)[k].sha256, digests[k].sha256);
  }
  const std::string text = read_file(file);
  for (const std::string& damaged : {text.substr(0, text.size() - 1), text + "x", text.substr(1)}) {
    folder.write("n.sha256", damaged);
    EXPECT_FALSE(read_digests(file));
  }
}

TEST(FolderTask, WhatTheRunRecordedIsChecked) {
  const TemporaryFolder folder;
  begin(folder.path());
  const FolderTask task(folder.path() / "o", "test", kPlanned);
  const std::array<std::string, 1> known = {"known"}, other = {"other"};
  EXPECT_TRUE(task.is_recorded("known"));
  EXPECT_TRUE(task.has("known"));
  EXPECT_NO_THROW(task.require(known));
  EXPECT_FALSE(task.is_recorded("other"));
  expect_error(ErrorKind::data, {"other", "`plan`"}, [&] { task.require(other); });
  folder.write(".o.unfinished/known", "abd");
  expect_error(ErrorKind::data, {"known", "has changed"}, [&] { task.require(known); });
  fs::remove(task.path() / "known");
  expect_error(ErrorKind::data, {"known"}, [&] { task.require(known); });
}

TEST(FolderTask, OtherFoldersAreRefused) {
  const TemporaryFolder folder;
  const auto open = [&](const Json& content) {
    return [&folder, content] { const FolderTask task(folder.path() / "o", "test", content); };
  };
  expect_error(ErrorKind::no_input, {"o: no tasks are planned"}, open({{"side", 3}}));
  begin(folder.path());
  EXPECT_NO_THROW(open({{"side", 3}})());
  expect_error(ErrorKind::cannot_create, {"side was 3 and is 4"}, open({{"side", 4}}));
  expect_error(ErrorKind::cannot_create, {"more was nothing and is 1"}, open({{"more", 1}}));
  folder.write(".o.unfinished/journal.sha256", "what?\n");
  expect_error(ErrorKind::data, {"journal.sha256:1 is damaged"}, open({{"side", 3}}));
  folder.write(".o.unfinished/adasplats.json", "{");
  expect_error(ErrorKind::cannot_create, {"adasplats.json is damaged"}, open({{"side", 3}}));
}

TEST(FolderTask, ManyTasksOrOneRunAtATime) {
  const TemporaryFolder folder;
  begin(folder.path());
  {
    const FolderTask first(folder.path() / "o", "test", kPlanned);
    const FolderTask second(folder.path() / "o", "test", kPlanned);
    expect_error(ErrorKind::cannot_create, {"another process"}, [&] { begin(folder.path()); });
  }
  const ResumableFolder run(folder.path() / "o", false, "test", kPlanned);
  expect_error(ErrorKind::cannot_create, {"another process"},
               [&] { const FolderTask task(folder.path() / "o", "test", kPlanned); });
}

}  // namespace
}  // namespace adasplats
