// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/io/base/atomic_file.h"
#include "cli/interrupt.h"

namespace adasplats::app {
namespace {

namespace fs = std::filesystem;

constexpr double kShortestPoll_s = 0.002, kLongestPoll_s = 0.05;
constexpr double kPollShare = 0.05;  // of the time so far: short steps are measured as well
constexpr int kCannotStart = 127;    // as shells have it
constexpr int kSignalBase = 128;
constexpr int kMessageLength = 300;

/// What happens in the new process: only calls that are safe between fork and exec.
[[noreturn]] void become(char* const* arguments, const char* log, pid_t parent) {
  setpgid(0, 0);
  // It must not go on where we are killed: nobody would count its time, and the next run would meet
  // it in the same folder.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // it has died meanwhile
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  execv(arguments[0], arguments);
  _exit(kCannotStart);
}

/// Starts the program; its group's number is its process number.
pid_t start(const std::vector<std::string>& arguments, const fs::path& log) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  // execv takes char* for historical reasons and changes nothing.
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) become(argv.data(), log.c_str(), parent);
  if (child < 0) {
    throw system_error(ErrorKind::software, arguments.front(), "cannot be started", errno);
  }
  setpgid(child, child);  // whoever of the two is first
  return child;
}

/// Resident memory of a process, given as its folder in /proc; 0 where it is of another group.
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

/// Why a child did not do its work, for people.
std::string message_of(const ChildResult& result, const ChildLimits& limits, const fs::path& log) {
  std::array<char, 96> text{};
  if (result.end == ChildEnd::timeout) {
    std::snprintf(text.data(), text.size(), "ended after the time limit of %g s", limits.seconds);
    return text.data();
  }
  if (result.end == ChildEnd::out_of_memory) {
    std::snprintf(text.data(), text.size(), "ended at the memory limit of %.3g GiB",
                  static_cast<double>(limits.memory_bytes) / kBytesPerGiB);
    return text.data();
  }
  if (result.exit_code > kSignalBase) {
    return "was ended by signal " + std::to_string(result.exit_code - kSignalBase);
  }
  const std::string said = last_line(log);
  return said.empty() ? "exit code " + std::to_string(result.exit_code) : said;
}

/// A child and all that it starts; none of them outlives this object.
class ChildGroup {
 public:
  explicit ChildGroup(pid_t child) : child_(child) {}
  ~ChildGroup() {
    if (child_ > 0) end();
  }
  ChildGroup(const ChildGroup&) = delete;
  ChildGroup& operator=(const ChildGroup&) = delete;

  pid_t number() const { return child_; }

  /// Whether the child has ended. It is not waited for: its number stays its own until end().
  bool has_ended() const {
    siginfo_t info{};
    const auto id = static_cast<id_t>(child_);
    return waitid(P_PID, id, &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child_;
  }

  struct Ending {
    int status = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< of the child alone
  };
  Ending end() {
    Ending ending;
    struct rusage usage {};
    kill(-child_, SIGKILL);
    while (wait4(child_, &ending.status, 0, &usage) < 0 && errno == EINTR) {
    }
    child_ = 0;
    ending.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return ending;
  }

 private:
  pid_t child_;
};

}  // namespace

ChildResult run_child(const std::vector<std::string>& arguments, const ChildLimits& limits,
                      const fs::path& log, ProgressSink& progress) {
  write_file(log, "");  // says so where the folder cannot be written
  // Where our parent has it ignored, children vanish without an exit code.
  std::signal(SIGCHLD, SIG_DFL);
  const Stopwatch watch;
  ChildGroup group(start(arguments, log));
  ChildResult result;
  for (;;) {
    if (group.has_ended()) {
      const ChildGroup::Ending ending = group.end();
      result.peak_memory_bytes = std::max(result.peak_memory_bytes, ending.peak_memory_bytes);
      result.exit_code = WIFEXITED(ending.status) ? WEXITSTATUS(ending.status)
                                                  : kSignalBase + WTERMSIG(ending.status);
      result.end = result.exit_code == 0 ? ChildEnd::done : ChildEnd::failed;
      // A signal to all processes (the machine shuts down) is no failure of the child.
      if (result.end == ChildEnd::failed) throw_if_interrupted();
      break;
    }
    result.peak_memory_bytes =
        std::max(result.peak_memory_bytes, group_memory_bytes(group.number()));
    const bool too_large =
        limits.memory_bytes > 0 && result.peak_memory_bytes > limits.memory_bytes;
    if (too_large || watch.seconds() > limits.seconds) {
      group.end();
      result.end = too_large ? ChildEnd::out_of_memory : ChildEnd::timeout;
      break;
    }
    throw_if_interrupted();
    progress.advance(0);
    std::this_thread::sleep_for(std::chrono::duration<double>(
        std::clamp(kPollShare * watch.seconds(), kShortestPoll_s, kLongestPoll_s)));
  }
  result.seconds = watch.seconds();
  if (result.end != ChildEnd::done) result.message = message_of(result, limits, log);
  return result;
}

}  // namespace adasplats::app
