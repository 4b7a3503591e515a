// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/error.h"

#include <gtest/gtest.h>
#include <sysexits.h>

#include <cerrno>

#include "adasplats/core/memory.h"

namespace adasplats {
namespace {

// Oracle: sysexits.h.
TEST(Error, ExitCodes) {
  EXPECT_EQ(exit_code(ErrorKind::usage), EX_USAGE);
  EXPECT_EQ(exit_code(ErrorKind::data), EX_DATAERR);
  EXPECT_EQ(exit_code(ErrorKind::no_input), EX_NOINPUT);
  EXPECT_EQ(exit_code(ErrorKind::unavailable), EX_UNAVAILABLE);
  EXPECT_EQ(exit_code(ErrorKind::software), EX_SOFTWARE);
  EXPECT_EQ(exit_code(ErrorKind::cannot_create), EX_CANTCREAT);
  EXPECT_EQ(exit_code(ErrorKind::io), EX_IOERR);
  EXPECT_EQ(exit_code(ErrorKind::config), EX_CONFIG);
}

TEST(Error, PlacesInFiles) {
  const Error line = data_error({"a b.csv", {}, 7}, "found 3");
  EXPECT_STREQ(line.what(), "a b.csv:7: found 3");
  EXPECT_EQ(exit_code(line.kind()), EX_DATAERR);
  EXPECT_STREQ(data_error({"a.bin", 0, {}}, "cut").what(), "a.bin: byte 0: cut");
  EXPECT_STREQ(data_error({"a.bin", {}, {}}, "cut").what(), "a.bin: cut");
}

TEST(Error, SystemErrorsNameTheReason) {
  const Error error = system_error(ErrorKind::no_input, "a", "cannot be opened", ENOENT);
  EXPECT_STREQ(error.what(), "a: cannot be opened: No such file or directory");
  EXPECT_EQ(exit_code(error.kind()), EX_NOINPUT);
}

TEST(NearestWord, FindsTypos) {
  const std::vector<std::string> words = {"radius", "voxel", "rings"};
  EXPECT_EQ(nearest_word("radus", words), "radius");    // left out
  EXPECT_EQ(nearest_word("radiuus", words), "radius");  // doubled
  EXPECT_EQ(nearest_word("roxel", words), "voxel");     // replaced
  EXPECT_EQ(nearest_word("rings", words), "rings");
}

TEST(NearestWord, IgnoresOtherWords) {
  EXPECT_EQ(nearest_word("temperature", {"radius", "voxel"}), std::nullopt);
  EXPECT_EQ(nearest_word("radius", {}), std::nullopt);
}

TEST(NearestWord, EmptyWordsAndTies) {
  EXPECT_EQ(nearest_word("", {"ab", "abc"}), "ab");
  EXPECT_EQ(nearest_word("", {"abc"}), std::nullopt);
  EXPECT_EQ(nearest_word("cat", {"bat", "rat"}), "bat");  // the first of equals
}

TEST(NearestWord, ABeginningIsNoTypo) {
  const std::vector<std::string> options = {"--mount", "--output", "--output-format", "--rate"};
  EXPECT_EQ(nearest_word("--out", options), "--output");
  EXPECT_EQ(did_you_mean("--out", options), ", did you mean '--output' or '--output-format'?");
  EXPECT_EQ(nearest_word("--moun", options), "--mount");
  EXPECT_EQ(nearest_word("--rat", {"--rats-a", "--rats-b", "--rats-c", "--rats-d", "--rats-e",
                                   "--rats-f", "--rats-g", "--bat"}),
            "--bat");  // too many to list
}

TEST(NearestWord, FindsNamesByAPartOfThem) {
  const std::vector<std::string> sensors = {"hdl-64-paper", "ouster-os1-64", "velodyne-hdl-64e-s2",
                                            "velodyne-vlp-16"};
  EXPECT_EQ(nearest_word("vlp-16", sensors), "velodyne-vlp-16");
  EXPECT_EQ(nearest_word("os1-64", sensors), "ouster-os1-64");
  EXPECT_EQ(nearest_word("OS-1-64", sensors), "ouster-os1-64");
  EXPECT_EQ(nearest_word("hdl64", sensors), "hdl-64-paper");  // the shortest
  EXPECT_EQ(did_you_mean("hdl64", sensors),
            ", did you mean 'hdl-64-paper' or 'velodyne-hdl-64e-s2'?");
  EXPECT_EQ(did_you_mean("velodyne-vlp-17", sensors), ", did you mean 'velodyne-vlp-16'?");
  EXPECT_EQ(did_you_mean("s", sensors), "");
  EXPECT_EQ(did_you_mean("64", std::vector<std::string>(7, "hdl-64-paper")), "") << "says nothing";
  EXPECT_EQ(did_you_mean("--", sensors), "");
}

TEST(Memory, PeakCountsWhatWasTouched) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const std::vector<char> block(kBytes, 1);
  EXPECT_GE(peak_memory_bytes(), kBytes);
  EXPECT_EQ(block.back(), 1);
}

}  // namespace
}  // namespace adasplats
