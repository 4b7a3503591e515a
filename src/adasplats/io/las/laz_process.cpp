// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz_process.h"

#ifdef ADASPLATS_HAVE_LASZIP

#include <fcntl.h>
#include <laszip/laszip_api.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <exception>
#include <type_traits>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

// The pipe carries blocks: a number of points and the points; at the end 0, then the length of a
// message and the message.
static_assert(std::is_trivially_copyable_v<LasPoint>);
constexpr std::size_t kBlockPoints = 4096;

LasPoint decode_point(const LasHeader& header, const laszip_point_struct& from) {
  LasPoint point;
  point.position = header.position(from.X, from.Y, from.Z);
  point.intensity = from.intensity;
  if (las_format(header.format).is_extended) {
    point.is_withheld = (from.extended_classification_flags & kLasExtendedWithheld) != 0;
    point.classification = from.extended_classification;
    point.return_number = from.extended_return_number;
    point.number_of_returns = from.extended_number_of_returns;
  } else {
    point.is_withheld = from.withheld_flag != 0;
    point.classification = from.classification;
    point.return_number = from.return_number;
    point.number_of_returns = from.number_of_returns;
  }
  point.user_data = from.user_data;
  point.point_source_id = from.point_source_ID;
  point.gps_time = from.gps_time;
  point.red = from.rgb[0];
  point.green = from.rgb[1];
  point.blue = from.rgb[2];
  return point;
}

/// Writes to the pipe; ends the process where nobody reads any more.
void send(int pipe, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t put = ::write(pipe, from, bytes);
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) ::_exit(1);
    from += put;
    bytes -= static_cast<std::size_t>(put);
  }
}

void send_points(int pipe, const std::vector<LasPoint>& points) {
  const auto count = static_cast<std::uint32_t>(points.size());
  if (count == 0) return;
  send(pipe, &count, sizeof count);
  send(pipe, points.data(), count * sizeof(LasPoint));
}

std::string last_error(laszip_POINTER reader) {
  laszip_CHAR* text = nullptr;
  return laszip_get_error(reader, &text) == 0 && text != nullptr ? text : "LASzip failed";
}

/// Reads and sends all points; gives LASzip's message where it fails. Nothing is closed: the
/// process ends next, and LASzip's own cleaning up is what crashes most.
std::string unpack(int pipe, const char* path, const LasHeader& header) {
  laszip_POINTER reader = nullptr;
  if (laszip_create(&reader) != 0) return "LASzip cannot be started";
  laszip_BOOL is_compressed = 0;
  laszip_point_struct* point = nullptr;
  if (laszip_open_reader(reader, path, &is_compressed) != 0 ||
      laszip_get_point_pointer(reader, &point) != 0)
    return last_error(reader);
  std::vector<LasPoint> block;
  for (std::uint64_t k = 0; k < header.points; ++k) {
    if (laszip_read_point(reader) != 0) {
      send_points(pipe, block);
      return last_error(reader);
    }
    block.push_back(decode_point(header, *point));
    if (block.size() < kBlockPoints && k + 1 < header.points) continue;
    send_points(pipe, block);
    block.clear();
  }
  return "";
}

[[noreturn]] void run_child(int pipe, const char* path, const LasHeader& header) {
  // A crash is expected: it shall end this process at once, without a core or a handler.
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGPIPE})
    std::signal(number, SIG_DFL);
  std::string message;
  try {
    message = unpack(pipe, path, header);
  } catch (const std::exception& error) {
    message = error.what();
  }
  const std::uint32_t end = 0;
  const auto length = static_cast<std::uint32_t>(message.size());
  send(pipe, &end, sizeof end);
  send(pipe, &length, sizeof length);
  send(pipe, message.data(), length);
  ::_exit(0);
}

}  // namespace

LazProcess::LazProcess(const std::filesystem::path& path, const LasHeader& header) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw system_error(ErrorKind::io, path, "no pipe to LASzip", errno);
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[0]);
    run_child(ends[1], path.c_str(), header);
  }
  const int error = errno;
  ::close(ends[1]);
  pipe_ = ends[0];
  if (process_ > 0) return;
  ::close(pipe_);
  throw system_error(ErrorKind::io, path, "no process for LASzip", error);
}

LazProcess::~LazProcess() {
  ::close(pipe_);
  // Where not all points were taken the process may be in an endless loop of LASzip's.
  ::kill(process_, SIGKILL);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool LazProcess::receive(void* to, std::size_t bytes) {
  char* place = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t got = ::read(pipe_, place, bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    place += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

std::vector<LasPoint> LazProcess::next_points() {
  std::uint32_t count = 0;
  if (!receive(&count, sizeof count) || count > kBlockPoints) {
    fault_ = "LASzip crashed";
    return {};
  }
  std::vector<LasPoint> points(count);
  if (count > 0 && receive(points.data(), count * sizeof(LasPoint))) return points;
  constexpr std::uint32_t kLongestMessage = 4096;
  std::uint32_t length = 0;
  if (count > 0 || !receive(&length, sizeof length) || length > kLongestMessage) {
    fault_ = "LASzip crashed";
    return {};
  }
  fault_.assign(length, ' ');
  if (!receive(fault_.data(), length)) fault_ = "LASzip crashed";
  if (fault_.empty()) fault_ = "LASzip gave fewer points than the header says";
  return {};
}

}  // namespace adasplats

#endif
