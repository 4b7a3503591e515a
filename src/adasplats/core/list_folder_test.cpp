// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/list_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

using Paths = std::vector<std::filesystem::path>;

TEST(ListFolder, EntriesAreSorted) {
  const TemporaryFolder folder;
  folder.write("b", "");
  folder.write(".hidden", "");
  folder.write("a/deeper", "");
  const Paths expected = {folder.path() / ".hidden", folder.path() / "a", folder.path() / "b"};
  EXPECT_EQ(list_folder(folder.path()), expected);
  EXPECT_EQ(list_folder_if_any(folder.path()), expected);
}

TEST(ListFolder, FilesBelowAFolder) {
  const TemporaryFolder folder;
  folder.write("b", "");
  folder.write("a/deep/c", "");
  folder.write("other/d", "");
  std::filesystem::create_directory_symlink(folder.path() / "other", folder.path() / "a" / "link");
  EXPECT_EQ(files_below(folder.path()),
            (Paths{folder.path() / "a" / "deep" / "c", folder.path() / "b",
                   folder.path() / "other" / "d"}));
}

TEST(ListFolder, MissingFoldersAreErrorsOrEmpty) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("file", "text");
  for (const std::filesystem::path& path : {file, folder.path() / "none"}) {
    EXPECT_EQ(list_folder_if_any(path), Paths());
    expect_error(ErrorKind::no_input, {path.string() + ": cannot be listed: "},
                 [&] { list_folder(path); });
  }
}

}  // namespace
}  // namespace adasplats
