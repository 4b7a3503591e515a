// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <vector>

#include "adasplats/io/arrays/npy.h"
#include "adasplats/io/base/files_test.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

TEST(AtomicFile, RoundTripOfEmptySmallAndLarge) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0UL, 1UL, 65535UL, 65536UL, 65537UL, 1000000UL}) {
    std::string content(size, '\0');
    for (std::size_t k = 0; k < size; ++k) content[k] = static_cast<char>(k * 31 >> 3);
    write_file(folder.path() / "file", content);
    EXPECT_EQ(read_file(folder.path() / "file"), content) << size;
    EXPECT_EQ(folder.file_count(), 1U);
  }
}

TEST(AtomicFile, ManySmallWritesAreTheirConcatenation) {
  const TemporaryFolder folder;
  std::string expected;
  AtomicFile file(folder.path() / "file");
  for (int k = 0; k < 30000; ++k) {
    const std::string piece = std::to_string(k) + (k % 1000 == 0 ? std::string(40000, 'x') : "\n");
    file.write(piece);
    expected += piece;
  }
  file.commit();
  EXPECT_EQ(read_file(folder.path() / "file"), expected);
}

TEST(AtomicFile, OldFileIsThereUntilCommitAndStaysWithoutIt) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.write("file", "old");
  {
    AtomicFile file(path);
    file.write("new");
    EXPECT_EQ(read_file(path), "old");
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.file_count(), 1U);
  AtomicFile file(path);
  file.write("new");
  file.commit();
  EXPECT_EQ(read_file(path), "new");
  EXPECT_THROW(file.commit(), std::logic_error);
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotMix) {
  const TemporaryFolder folder;
  AtomicFile first(folder.path() / "file");
  AtomicFile second(folder.path() / "file");
  first.write("first");
  second.write("second");
  first.commit();
  second.commit();
  EXPECT_EQ(read_file(folder.path() / "file"), "second");
}

TEST(AtomicFile, ReplacesWhatAKilledWriterLeft) {
  const TemporaryFolder folder;
  folder.write(".adasplats-file-0.tmp", "longer than the new file");
  write_file(folder.path() / "file", "new");
  EXPECT_EQ(read_file(folder.path() / "file"), "new");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AtomicFile, NeverWritesToAnotherFileThroughALink) {
  const TemporaryFolder folder;
  folder.write("other", "of the user");
  std::filesystem::create_symlink(folder.path() / "other", folder.path() / ".adasplats-file-0.tmp");
  std::filesystem::create_hard_link(folder.path() / "other",
                                    folder.path() / ".adasplats-file-1.tmp");
  write_file(folder.path() / "file", "new");
  EXPECT_EQ(read_file(folder.path() / "file"), "new");
  EXPECT_EQ(read_file(folder.path() / "other"), "of the user");
}

TEST(AtomicFile, NamesMayBeLong) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / std::string(255, 'n');
  write_file(path, "new");
  EXPECT_EQ(read_file(path), "new");
}

TEST(AtomicFile, FollowsALinkAndKeepsIt) {
  const TemporaryFolder folder;
  const std::filesystem::path target = folder.write("target", "old");
  const std::filesystem::path link = folder.path() / "link";
  std::filesystem::create_symlink(target, link);
  write_file(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(target), "new");
}

TEST(AtomicFile, RejectsFilesThatCannotBeCreated) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::cannot_create, {"no-folder"},
               [&] { write_file(folder.path() / "no-folder" / "file", "x"); });
  expect_error(ErrorKind::cannot_create, {"not a regular file"},
               [&] { write_file(folder.path(), "x"); });
  const std::filesystem::path fifo = folder.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  expect_error(ErrorKind::cannot_create, {"not a regular file"}, [&] { write_file(fifo, "x"); });
}

TEST(ReadFile, MissingFolderAndFifoAreNoInput) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::no_input, {"missing", "No such file"},
               [&] { read_file(folder.path() / "missing"); });
  expect_error(ErrorKind::no_input, {"is a folder"}, [&] { read_file(folder.path()); });
  const std::filesystem::path fifo = folder.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  expect_error(ErrorKind::no_input, {"is a FIFO"}, [&] { read_file(fifo); });
}

TEST(ReadFile, PathsWithSpacesAndUtf8) {
  const TemporaryFolder folder;
  write_file(folder.path() / "Straße nach Süden 点群.txt", "content");
  EXPECT_EQ(read_file(folder.path() / "Straße nach Süden 点群.txt"), "content");
}

/// Runs `write` in a child that may write `limit_bytes` to a file; gives whether that ended in an
/// Error of kind io, as a full disk gives.
template <class F>
bool fails_with_io_error_at(rlim_t limit_bytes, F&& write) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{limit_bytes, limit_bytes};
    int code = 3;
    if (::setrlimit(RLIMIT_FSIZE, &limit) == 0) {
      try {
        write();
        code = 1;
      } catch (const Error& error) {
        code = error.kind() == ErrorKind::io ? 0 : 2;
      } catch (...) {
        code = 4;
      }
    }
    ::_exit(code);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Fault 33. The limit takes every multiple of a step that divides none of the writers' buffers, so
// that each of their writes is the first to fail in turn.
template <class F>
void expect_old_file_survives(F&& write) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "file";
  write(path);
  const std::uintmax_t size = std::filesystem::file_size(path);
  folder.write("file", "old content");
  std::vector<rlim_t> limits = {0, 1, static_cast<rlim_t>(size - 1)};
  for (std::uintmax_t limit = 9973; limit < size; limit += 9973) limits.push_back(limit);
  for (const rlim_t limit : limits) {
    EXPECT_TRUE(fails_with_io_error_at(limit, [&] { write(path); })) << "limit " << limit;
    EXPECT_EQ(read_file(path), "old content") << "limit " << limit;
    EXPECT_EQ(folder.file_count(), 1U) << "limit " << limit;
  }
}

TEST(DiskFull, FileOfManyWrites) {
  expect_old_file_survives([](const std::filesystem::path& path) {
    AtomicFile file(path);
    for (int k = 0; k < 20000; ++k) file.write("0123456789");
    file.write(std::string(150000, 'x'));
    file.commit();
  });
}

TEST(DiskFull, PlyAndNpy) {
  const std::vector<float> values(120000, 1.5F);
  expect_old_file_survives([&](const std::filesystem::path& path) {
    const std::vector<ColumnView> columns = {{"x", ColumnType::f32, values.data(), 4}};
    write_ply(path, values.size(), columns);
  });
  expect_old_file_survives(
      [&](const std::filesystem::path& path) { write_npy(path, values, values.size() / 4, 4); });
}

}  // namespace
}  // namespace adasplats
