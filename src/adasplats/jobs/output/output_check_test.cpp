// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/output_check.h"

#include <gtest/gtest.h>

#include <vector>

#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

void refuse_file(const fs::path& file, const std::vector<fs::path>& inputs) {
  expect_error(ErrorKind::usage, {file.string()}, [&] { require_no_input(file, inputs); });
}

void refuse_folder(const fs::path& folder, const std::vector<fs::path>& inputs) {
  expect_error(ErrorKind::usage, {folder.string()}, [&] { require_folder_apart(folder, inputs); });
}

TEST(OutputCheck, EndingsSayWhatIsWritten) {
  require_ending("a.ply", ".ply");
  require_ending("x/a.b.PLY", ".ply");
  for (const char* name : {"a.txt", "a", "a.ply.gz", ".ply"})
    expect_error(ErrorKind::usage, {name, ".ply"}, [&] { require_ending(name, ".ply"); });
  const std::vector<std::string> endings = {".ply", ".glb", ".mcap"};
  require_ending("a.mcap", endings);
  expect_error(ErrorKind::usage, {".ply, .glb or .mcap"},
               [&] { require_ending("a.obj", endings); });
}

TEST(OutputCheck, FilesAreNoInputsByWhateverName) {
  const TemporaryFolder folder;
  const fs::path input = folder.write("in/a.ply", "x");
  const fs::path soft = folder.path() / "soft.ply", hard = folder.path() / "hard.ply";
  fs::create_symlink(input, soft);
  fs::create_hard_link(input, hard);
  for (const fs::path& output : {input, soft, hard, folder.path() / "in/../in/a.ply"})
    refuse_file(output, {folder.path() / "other", input});
  require_no_input(folder.path() / "new.ply", std::vector<fs::path>{input});
  // Beside the files of an input folder it would be one of them.
  refuse_file(folder.path() / "in/b.ply", {folder.path() / "in"});
  // Of another format it would make the folder unclear.
  for (const char* name : {"in/b.csv", "in/b.LAS", "in/b.glb", "in/b.txt"})
    refuse_file(folder.path() / name, {folder.path() / "in"});
  require_no_input(folder.path() / "in/b.json", std::vector<fs::path>{folder.path() / "in"});
  require_no_input(folder.path() / "b.ply", std::vector<fs::path>{folder.path() / "in"});
}

TEST(OutputCheck, FoldersAndInputsLieApart) {
  const TemporaryFolder folder;
  const fs::path input = folder.write("in/deep/a.ply", "x");
  fs::create_directory_symlink(folder.path() / "in", folder.path() / "link");
  refuse_folder(folder.path() / "in", {input});
  refuse_folder(folder.path() / "in/", {input});
  refuse_folder(folder.path() / "link", {input});
  refuse_folder(folder.path() / "link/deep", {input});
  refuse_folder(folder.path() / "in/new", {folder.path() / "in"});
  refuse_folder(folder.path() / "link/new/", {folder.path() / "in"});
  refuse_folder(folder.path() / "in", {folder.path() / "in"});
  require_folder_apart(folder.path() / "in/new", std::vector<fs::path>{input});
  require_folder_apart(folder.path() / "inner", std::vector<fs::path>{folder.path() / "in"});
}

}  // namespace
}  // namespace adasplats
