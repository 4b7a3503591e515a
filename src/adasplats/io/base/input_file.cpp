// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace adasplats {
namespace {

static_assert(sizeof(std::size_t) == 8, "sizes of files are held in std::size_t");

// Small enough for the L2 cache, so that spreading it over columns reads memory only once.
constexpr std::size_t kReadBytes = std::size_t{256} << 10;

int open_or_throw(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a FIFO without a writer returns at once; regular files ignore it.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) throw system_error(ErrorKind::no_input, path, "cannot be opened", errno);
  return descriptor;
}

const char* kind_of_file(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a FIFO";
  return "not a regular file";
}

}  // namespace

InputDescriptor::InputDescriptor(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(open_or_throw(path_)) {
  struct stat status {};
  const bool has_status = ::fstat(descriptor_, &status) == 0;
  const int error = errno;
  if (has_status && S_ISREG(status.st_mode)) {
    size_bytes_ = static_cast<std::uint64_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  if (!has_status) throw system_error(ErrorKind::no_input, path_, "cannot be examined", error);
  throw Error(ErrorKind::no_input, path_.string() + ": is " + kind_of_file(status.st_mode) +
                                       ", expected a regular file");
}

InputDescriptor::~InputDescriptor() { ::close(descriptor_); }

void InputDescriptor::read_at(std::uint64_t offset, std::span<std::byte> to) const {
  for (std::size_t done = 0; done < to.size();) {
    const ssize_t got =
        ::pread(descriptor_, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw system_error(ErrorKind::io, path_, "cannot be read", errno);
    if (got == 0)
      throw Error(ErrorKind::io, path_.string() + ": byte " + std::to_string(offset + done) +
                                     ": the file became shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
}

InputFile::InputFile(std::filesystem::path path) : file_(std::move(path)) {
  if (size_bytes() == 0) throw data_error({file_.path(), {}, {}}, "the file is empty");
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kReadBytes, size_bytes())));
}

void InputFile::skip(std::uint64_t bytes) {
  require(bytes);
  const std::uint64_t buffered = end_ - begin_;
  if (bytes < buffered) {
    begin_ += static_cast<std::size_t>(bytes);
  } else {
    begin_ = end_ = 0;
  }
  offset_ += bytes;
}

Error InputFile::error_here(const std::string& message) const {
  return data_error({path(), offset_, {}}, message);
}

void InputFile::require(std::uint64_t bytes) const {
  if (bytes <= remaining()) return;
  throw data_error(
      {path(), size_bytes(), {}},
      "the file ends here, " + std::to_string(bytes - remaining()) + " more bytes were expected");
}

void InputFile::fill(std::size_t bytes) {
  require(bytes);
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (bytes > buffer_.size()) buffer_.resize(bytes);
  // A file that grows while it is read counts with its size at opening.
  const auto end = static_cast<std::size_t>(std::min<std::uint64_t>(buffer_.size(), remaining()));
  file_.read_at(offset_ + end_, std::span(buffer_).subspan(end_, end - end_));
  end_ = end;
}

}  // namespace adasplats
