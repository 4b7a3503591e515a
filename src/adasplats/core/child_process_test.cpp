// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/child_process.h"

#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

class ChildProcess : public testing::Test {
 protected:
  ChildProcess() { fs::create_directories(folder_ / "bin"); }
  ~ChildProcess() override { fs::remove_all(folder_); }

  ChildResult shell(const std::string& script, std::optional<ChildLimits> limits = {}) {
    ProgressSink progress;
    return run_child({{"/bin/sh", "-c", script}, {"WORD=ours"}, folder_ / "log", limits}, progress);
  }

  fs::path folder_ = fs::path(testing::TempDir()) / "adasplats child ä";
};

TEST_F(ChildProcess, ReportsHowItEnded) {
  const ChildResult good = shell("test $WORD = ours && test -n $PATH");
  EXPECT_EQ(good.end, ChildEnd::done);
  EXPECT_EQ(good.message, "");
  EXPECT_GT(good.peak_memory_bytes, 100'000U);
  const ChildResult bad = shell("echo first; echo no luck >&2; echo; exit 3");
  EXPECT_EQ(bad.end, ChildEnd::failed);
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_EQ(bad.message, "no luck");
  EXPECT_EQ(shell("exit 4").message, "exit code 4");
  EXPECT_EQ(shell("kill -9 $$").message, "was ended by signal 9");
  ProgressSink progress;
  const ChildResult none = run_child({{"/no/such"}, {}, folder_ / "log"}, progress);
  EXPECT_EQ(none.exit_code, 127);
  EXPECT_EQ(none.message, "cannot be started");
  EXPECT_THROW(run_child({{"/bin/sh"}, {}, folder_ / "no such" / "log"}, progress), Error);
}

TEST_F(ChildProcess, LimitsIncludeAllProcessesItStarts) {
  const fs::path number = folder_ / "number";
  const std::string script = "sleep 600 & echo $! > '" + number.string() + "'; wait";
  const ChildResult slow = shell(script, ChildLimits{.seconds = 0.3});
  EXPECT_EQ(slow.end, ChildEnd::timeout);
  EXPECT_EQ(slow.message, "ended after the time limit of 0.3 s");
  EXPECT_GE(slow.seconds, 0.3);
  pid_t process = 0;
  std::ifstream(number) >> process;
  ASSERT_GT(process, 1);
  for (int i = 0; i < 100 && fs::exists("/proc/" + std::to_string(process)); ++i) {
    std::string state;
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    std::getline(stat, state);
    if (state.find(") Z ") != std::string::npos) break;  // nobody has waited for it yet
    ASSERT_LT(i, 99);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(shell(script, ChildLimits{.memory_bytes = 1000}).end, ChildEnd::out_of_memory);
}

TEST_F(ChildProcess, FoundOnPath) {
  const fs::path program = folder_ / "bin" / "tool of ours";
  std::ofstream(program) << "#!/bin/sh\n";
  const char* const old = std::getenv("PATH");
  const std::string before = old == nullptr ? "" : old;
  setenv("PATH", (":/none:" + program.parent_path().string()).c_str(), 1);
  const auto not_executable = find_on_path("tool of ours");
  fs::permissions(program, fs::perms::owner_all);
  const auto found = find_on_path("tool of ours");
  const auto other = find_on_path("other");
  setenv("PATH", before.c_str(), 1);
  EXPECT_FALSE(not_executable);
  EXPECT_EQ(found, program);
  EXPECT_FALSE(other);
  EXPECT_FALSE(find_next_to_program("other"));
}

}  // namespace
}  // namespace adasplats
