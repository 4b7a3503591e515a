// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxNameBytes = 200;
constexpr int kMaxAttempts = 10000;
constexpr std::size_t kWriteBytes = std::size_t{64} << 10;
// One system call moves at most about 2 GiB; see write(2).
constexpr std::size_t kLargestCallBytes = std::size_t{1} << 30;

/// The file to replace: of a symbolic link its target, so that the link stays.
std::filesystem::path target_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  if (error) throw system_error(ErrorKind::cannot_create, path, "broken link", error.value());
  return target;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

void flush_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // A folder with write but no read permission cannot be opened for fsync; the file itself is safe.
  if (descriptor < 0) return;
  const bool failed = ::fsync(descriptor) != 0;
  const int error = errno;
  ::close(descriptor);
  // EINVAL: the file system has nothing to flush for folders.
  if (failed && error != EINVAL)
    throw system_error(ErrorKind::io, folder, "the folder cannot be flushed to disk", error);
}

void write_all(int descriptor, const std::filesystem::path& path, const char* data,
               std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t put = ::write(descriptor, data, std::min(bytes, kLargestCallBytes));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw system_error(ErrorKind::io, path, "cannot be written", errno);
    data += put;
    bytes -= static_cast<std::size_t>(put);
  }
}

/// Whether a path still is the open file, a regular one without other names.
bool is_at(const std::filesystem::path& path, int descriptor) {
  struct stat open {};
  struct stat named {};
  return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         S_ISREG(named.st_mode) && named.st_nlink == 1 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

/// Creates a temporary file, or takes over one that nobody has locked, and locks it; -1: in use.
int create_or_take_over(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  constexpr int kFlags = O_WRONLY | O_CLOEXEC | O_NOFOLLOW;
  int descriptor = ::open(temporary.c_str(), kFlags | O_CREAT | O_EXCL, 0666);
  const bool is_new = descriptor >= 0;
  if (!is_new && errno != EEXIST && errno != EINTR)
    throw system_error(ErrorKind::cannot_create, path, "cannot be created", errno);
  if (!is_new) descriptor = ::open(temporary.c_str(), kFlags);
  if (descriptor < 0) return -1;
  // Without locks (some network file systems) files of others are never taken over.
  const bool is_locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  const bool has_no_locks = !is_locked && errno != EWOULDBLOCK;
  if ((!is_locked && !(is_new && has_no_locks)) || !is_at(temporary, descriptor)) {
    ::close(descriptor);
    return -1;
  }
  if (is_new || ::ftruncate(descriptor, 0) == 0) return descriptor;
  const int error = errno;
  ::close(descriptor);
  throw system_error(ErrorKind::io, path, "cannot be written", error);
}

/// Closes a descriptor when an exception is thrown.
struct OpenDescriptor {
  int number;
  ~OpenDescriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path) : path_(target_of(path)) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // rename() over /dev/null would replace the device.
    throw Error(ErrorKind::cannot_create, path_.string() + ": exists and is not a regular file");
  }
  // Names of files have at most 255 bytes.
  const std::string name = ".adasplats-" + path_.filename().string().substr(0, kMaxNameBytes);
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    if (attempt == kMaxAttempts)
      throw Error(ErrorKind::cannot_create,
                  path_.string() + ": cannot be created: the folder contains " + name +
                      "-0.tmp to " + std::to_string(attempt - 1) + ".tmp, of other programs");
    temporary_ = folder_of(path_) / (name + "-" + std::to_string(attempt) + ".tmp");
    descriptor_ = create_or_take_over(temporary_, path_);
  }
}

AtomicFile::~AtomicFile() {
  // In this order, since the next writer may take the name as soon as the lock is gone.
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  const char* text = static_cast<const char*>(data);
  if (buffer_.size() + bytes > kWriteBytes) {
    write_through(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  if (bytes > kWriteBytes / 2) {
    write_through(buffer_.data(), buffer_.size());
    buffer_.clear();
    write_through(text, bytes);
  } else if (bytes > 0) {
    buffer_.append(text, bytes);
  }
}

void AtomicFile::write_through(const char* data, std::size_t bytes) {
  if (descriptor_ < 0) throw std::logic_error("AtomicFile: used after commit()");
  write_all(descriptor_, path_, data, bytes);
}

void AtomicFile::commit() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
  if (::fsync(descriptor_) != 0)
    throw system_error(ErrorKind::io, path_, "cannot be flushed to disk", errno);
  // Some network file systems report a full disk only when a file is closed. The lock stays.
  const int copy = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
  if (copy >= 0 && ::close(copy) != 0)
    throw system_error(ErrorKind::io, path_, "cannot be closed", errno);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0)
    throw system_error(ErrorKind::cannot_create, path_, "cannot be put in place", errno);
  temporary_.clear();
  ::close(std::exchange(descriptor_, -1));
  flush_folder(folder_of(path_));
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

void write_file_in_place(const std::filesystem::path& path, std::string_view content) {
  OpenDescriptor file{-1};
  do {
    file.number = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  } while (file.number < 0 && errno == EINTR);
  if (file.number < 0)
    throw system_error(ErrorKind::cannot_create, path, "cannot be created", errno);
  write_all(file.number, path, content.data(), content.size());
  if (::close(std::exchange(file.number, -1)) != 0)
    throw system_error(ErrorKind::io, path, "cannot be closed", errno);
}

std::string read_file(const std::filesystem::path& path) {
  const InputDescriptor file(path);
  // One byte more than the size, so that the second call of read() finds the end of the file.
  std::string content(static_cast<std::size_t>(file.size_bytes()) + 1, '\0');
  std::size_t used = 0;
  while (true) {
    const ssize_t got = ::read(file.get(), content.data() + used,
                               std::min(content.size() - used, kLargestCallBytes));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw system_error(ErrorKind::io, path, "cannot be read", errno);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
    if (used == content.size()) content.resize(content.size() * 2);
  }
  content.resize(used);
  return content;
}

}  // namespace adasplats
