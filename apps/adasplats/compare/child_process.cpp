// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"
#include "interrupt.h"
#include "stopwatch.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every unistd.h

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPollInterval{50};
constexpr int kSignalBase = 128;
constexpr int kMessageLength = 300;

/// Starts the program; its group's number is its process number.
pid_t start(const std::vector<std::string>& arguments, const fs::path& log) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  // posix_spawn takes char* for historical reasons and changes nothing.
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = -1;
  const int failure = posix_spawn(&child, argv.front(), &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0) {
    throw system_error(ErrorKind::software, arguments.front(), "cannot start the program", failure);
  }
  return child;
}

/// The number behind `key` in a line of /proc/PID/status, or of a field of /proc/PID/stat.
std::uint64_t resident_bytes(const fs::path& process, pid_t group) {
  std::ifstream stat(process / "stat");
  std::string line;
  if (!std::getline(stat, line)) return 0;  // it has ended meanwhile
  // The name in brackets may hold anything: fields are counted from the last bracket.
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string state;
  long parent = 0, process_group = 0;
  if (!(fields >> state >> parent >> process_group) || process_group != group) return 0;
  std::ifstream memory(process / "statm");
  std::uint64_t pages = 0, resident_pages = 0;
  if (!(memory >> pages >> resident_pages)) return 0;
  return resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t group_memory_bytes(pid_t group) {
  std::uint64_t sum = 0;
  std::error_code failure;
  for (fs::directory_iterator entry("/proc", failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename().string();
    const bool is_number =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= '0' && c <= '9'; });
    if (is_number) sum += resident_bytes(entry->path(), group);
  }
  return sum;
}

std::string last_line(const fs::path& log) {
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line)) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last.substr(0, kMessageLength);
}

/// Ends a process group when it is left, unless the child was waited for.
class GroupGuard {
 public:
  explicit GroupGuard(pid_t group) : group_(group) {}
  ~GroupGuard() {
    if (group_ > 0) end();
  }
  GroupGuard(const GroupGuard&) = delete;
  GroupGuard& operator=(const GroupGuard&) = delete;

  void end() {
    kill(-group_, SIGKILL);
    int status = 0;
    while (waitpid(group_, &status, 0) < 0 && errno == EINTR) {
    }
    group_ = 0;
  }
  /// The child has ended by itself; what it has left behind goes as well.
  void release() {
    kill(-group_, SIGKILL);
    group_ = 0;
  }

 private:
  pid_t group_;
};

}  // namespace

ChildResult run_child(const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const fs::path& log) {
  write_file(log, "");  // says so where the folder cannot be written
  const Stopwatch watch;
  const pid_t child = start(arguments, log);
  GroupGuard guard(child);
  ChildResult result;
  for (;;) {
    int status = 0;
    struct rusage usage {};
    const pid_t ended = wait4(child, &status, WNOHANG, &usage);
    if (ended == child) {
      guard.release();
      const std::uint64_t own_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
      result.peak_memory_bytes = std::max(result.peak_memory_bytes, own_bytes);
      result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
      result.end = result.exit_code == 0 ? ChildEnd::done : ChildEnd::failed;
      break;
    }
    result.peak_memory_bytes = std::max(result.peak_memory_bytes, group_memory_bytes(child));
    const bool too_large =
        limits.memory_bytes > 0 && result.peak_memory_bytes > limits.memory_bytes;
    if (too_large || watch.seconds() > limits.seconds) {
      guard.end();
      result.end = too_large ? ChildEnd::out_of_memory : ChildEnd::timeout;
      break;
    }
    throw_if_interrupted();
    std::this_thread::sleep_for(kPollInterval);
  }
  result.seconds = watch.seconds();
  if (result.end != ChildEnd::done) result.message = last_line(log);
  return result;
}

}  // namespace adasplats::app
