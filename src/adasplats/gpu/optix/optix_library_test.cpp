// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/optix/optix_library.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats {
namespace {

/// Sets the environment variable that names the OptiX library.
class NamedLibrary {
 public:
  explicit NamedLibrary(const std::string& path) { setenv(kVariable, path.c_str(), 1); }
  ~NamedLibrary() { unsetenv(kVariable); }
  NamedLibrary(const NamedLibrary&) = delete;
  NamedLibrary& operator=(const NamedLibrary&) = delete;

 private:
  static constexpr const char* kVariable = "ADASPLATS_OPTIX_LIBRARY";
};

std::filesystem::path path_of_test() {
  return std::filesystem::path(testing::TempDir()) / "adasplats_optix_library_test.so";
}

/// Expects both searches to fail with this reason and a remedy.
void expect_unavailable(const std::string& because) {
  if (!built_with_cuda()) GTEST_SKIP() << find_gpus().reason;
  const OptixSearch search = find_optix();
  EXPECT_FALSE(search.available);
  for (const std::string& part :
       {because, std::string("535 or newer"), std::string("NVIDIA_DRIVER_CAPABILITIES"),
        std::string("`device` cuda"), std::string("ADASPLATS_OPTIX_LIBRARY")})
    EXPECT_NE(search.reason.find(part), std::string::npos) << search.reason;
  try {
    const OptixLibrary library;
    ADD_FAILURE() << "opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unavailable);
    EXPECT_EQ(error.what(), search.reason);
  }
}

void expect_content_unavailable(const std::string& content, const std::string& because) {
  const auto path = path_of_test();
  std::ofstream(path) << content;
  const NamedLibrary library(path.string());
  expect_unavailable(because);
  std::filesystem::remove(path);
}

TEST(OptixLibrary, AMissingFileIsReportedWithARemedy) {
  const NamedLibrary library(path_of_test().string() + ".missing");
  expect_unavailable(path_of_test().string() + ".missing");
}

TEST(OptixLibrary, AnEmptyFileIsReportedWithARemedy) {
  expect_content_unavailable("", path_of_test().string() + " is empty");
}

TEST(OptixLibrary, AFileThatIsNoLibraryIsReportedWithARemedy) {
  expect_content_unavailable("no library at all\n", "does not load");
}

TEST(OptixLibrary, AnotherLibraryIsReportedWithARemedy) {
  const NamedLibrary library("libm.so.6");
  expect_unavailable("libm.so.6 is not the OptiX library");
}

}  // namespace
}  // namespace adasplats
