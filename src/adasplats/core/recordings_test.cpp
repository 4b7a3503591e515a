// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/recordings_test.h"

#include <gtest/gtest.h>

#include <fstream>

namespace adasplats {
namespace {

/// The environment variable for one test, as it was again afterwards.
class Recordings : public testing::Test {
 protected:
  Recordings() {
    if (const char* const said = std::getenv(kName)) before_ = said;
  }
  ~Recordings() override {
    if (before_) {
      setenv(kName, before_->c_str(), 1);
    } else {
      unsetenv(kName);
    }
  }
  static constexpr const char* kName = "ADASPLATS_TEST_DATA";

 private:
  std::optional<std::string> before_;
};

TEST_F(Recordings, TheEnvironmentComesFirst) {
  const std::filesystem::path folder = testing::TempDir();
  std::ofstream(folder / "adasplats_recording") << "here";
  setenv(kName, folder.c_str(), 1);
  EXPECT_EQ(recording("adasplats_recording"), folder / "adasplats_recording");
  std::filesystem::remove(folder / "adasplats_recording");
}

TEST_F(Recordings, AFolderWithoutTheRecordingIsAnError) {
  setenv(kName, testing::TempDir().c_str(), 1);
  EXPECT_THROW(recording("adasplats_no_such_recording"), std::runtime_error);
}

TEST_F(Recordings, AnEmptyVariableIsNoFolder) {
  setenv(kName, "", 1);
  EXPECT_EQ(recording("formats"), std::nullopt);
}

TEST_F(Recordings, WithoutTheVariableTheConfiguredFolderIsUsed) {
  unsetenv(kName);
  const std::filesystem::path configured = ADASPLATS_TEST_DATA;
  EXPECT_EQ(recording(".").has_value(), !configured.empty());
}

}  // namespace
}  // namespace adasplats
