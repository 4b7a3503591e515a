// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/child_process.h"

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
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every unistd.h

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr double kShortestPoll_s = 0.002, kLongestPoll_s = 0.05;
constexpr double kPollShare = 0.05;  // of the elapsed time, so that short steps are timed well, too
constexpr int kSignalBase = 128;
constexpr int kMessageLength = 300;

bool is_program(const fs::path& path) {
  std::error_code failure;
  return fs::is_regular_file(path, failure) && access(path.c_str(), X_OK) == 0;
}

/// Arguments of exec.
struct ExecCall {
  char* const* arguments;
  char* const* environment;
  int log;
  bool own_group;
};

/// Runs in the new process: only calls that are safe between fork and exec.
[[noreturn]] void become(const ExecCall& call, pid_t parent) {
  if (call.own_group) setpgid(0, 0);
  // The child must not outlive us: its time would not count, and the next run would find it at work
  // in the same folder.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // the parent has died meanwhile
  const int in = open("/dev/null", O_RDONLY);
  dup2(in, STDIN_FILENO);
  dup2(call.log, STDOUT_FILENO);
  dup2(call.log, STDERR_FILENO);
  // Signals that we ignore would stay ignored.
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  execve(call.arguments[0], call.arguments, call.environment);
  _exit(kCannotStart);
}

/// exec expects char* for historical reasons and changes nothing.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// The environment of this process with changes.
std::vector<std::string> environment_with(const std::vector<std::string>& changes) {
  std::vector<std::string> variables = changes;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    const std::string_view name = text.substr(0, text.find('=') + 1);
    if (std::none_of(changes.begin(), changes.end(),
                     [&](const std::string& change) { return change.starts_with(name); }))
      variables.emplace_back(text);
  }
  return variables;
}

/// Starts the program. With limits the number of its group is its process number.
pid_t start(const ChildProgram& child) {
  const std::vector<std::string> environment = environment_with(child.environment);
  const std::vector<char*> argv = pointers_to(child.arguments), envp = pointers_to(environment);
  const int log = open(child.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (log < 0) throw system_error(ErrorKind::cannot_create, child.log, "cannot be written", errno);
  const ExecCall call = {argv.data(), envp.data(), log, child.limits.has_value()};
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process == 0) become(call, parent);
  const int error = errno;
  close(log);
  if (process < 0)
    throw system_error(ErrorKind::unavailable, child.arguments[0], "cannot be started", error);
  if (call.own_group) setpgid(process, process);  // in both processes: either may be first
  return process;
}

/// Resident memory of a process, given as its folder in /proc; 0 if it is in another group.
std::uint64_t resident_bytes(const fs::path& process, pid_t group) {
  std::ifstream stat(process / "stat");
  std::string line;
  if (!std::getline(stat, line)) return 0;  // it has ended meanwhile
  // The name in brackets may contain anything: count fields from the last bracket.
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

/// Why a child failed, for users.
std::string message_of(const ChildResult& result, const ChildProgram& child) {
  std::array<char, 96> text{};
  if (result.end == ChildEnd::timeout) {
    std::snprintf(text.data(), text.size(), "ended after the time limit of %g s",
                  child.limits->seconds);
    return text.data();
  }
  if (result.end == ChildEnd::out_of_memory) {
    std::snprintf(text.data(), text.size(), "ended at the memory limit of %.3g GiB",
                  static_cast<double>(child.limits->memory_bytes) / kBytesPerGiB);
    return text.data();
  }
  std::string output = last_line(child.log);
  if (result.signalled) {
    return "was ended by signal " + std::to_string(result.exit_code - kSignalBase) +
           (output.empty() ? "" : ": " + output);
  }
  if (!output.empty()) return output;
  return result.exit_code == kCannotStart ? "cannot be started"
                                          : "exit code " + std::to_string(result.exit_code);
}

/// A child and, with limits, all processes that it starts. None outlives this object.
class Process {
 public:
  explicit Process(const ChildProgram& child)
      : number_(start(child)), is_group_(child.limits.has_value()) {}
  ~Process() {
    if (number_ > 0) end();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Whether the child has ended. Does not reap it, so that its number stays reserved until end().
  bool has_ended() {
    siginfo_t info{};
    const auto id = static_cast<id_t>(number_);
    // Fails if SIGCHLD is ignored and the child is gone.
    is_gone_ = waitid(P_PID, id, &info, WEXITED | WNOHANG | WNOWAIT) != 0;
    return is_gone_ || info.si_pid == number_;
  }

  /// The limit that it exceeds, if any; updates the peak memory.
  std::optional<ChildEnd> passed(const ChildLimits& limits, double seconds,
                                 std::uint64_t& peak_memory_bytes) const {
    peak_memory_bytes = std::max(peak_memory_bytes, group_memory_bytes(number_));
    if (limits.memory_bytes > 0 && peak_memory_bytes > limits.memory_bytes)
      return ChildEnd::out_of_memory;
    if (seconds > limits.seconds) return ChildEnd::timeout;
    return std::nullopt;
  }

  struct Ending {
    int exit_code = 0;
    bool signalled = false;
    std::uint64_t peak_memory_bytes = 0;  ///< of the child alone
  };
  Ending end() {
    int status = kCannotStart << 8;  // of a child that cannot be waited for
    struct rusage usage {};
    // After it is gone its number may belong to another process.
    if (is_group_ || !is_gone_) kill(is_group_ ? -number_ : number_, SIGKILL);
    while (wait4(number_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    number_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status),
            !WIFEXITED(status), static_cast<std::uint64_t>(usage.ru_maxrss) * 1024};
  }

 private:
  pid_t number_;
  bool is_group_;
  bool is_gone_ = false;
};

}  // namespace

std::optional<fs::path> find_on_path(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path program = fs::path(rest.substr(0, end)) / name;
    if (end > 0 && is_program(program)) return program;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

std::optional<fs::path> find_next_to_program(const std::string& name) {
  std::error_code failure;
  const fs::path own = fs::read_symlink("/proc/self/exe", failure);
  if (failure) return std::nullopt;
  const fs::path program = own.parent_path() / name;
  if (is_program(program)) return program;
  return std::nullopt;
}

ChildResult run_child(const ChildProgram& child, ProgressSink& progress) {
  const Stopwatch watch;
  Process process(child);
  ChildResult result;
  std::optional<ChildEnd> passed;
  while (!process.has_ended()) {
    if (child.limits)
      passed = process.passed(*child.limits, watch.seconds(), result.peak_memory_bytes);
    if (passed) break;
    progress.advance(0);
    std::this_thread::sleep_for(std::chrono::duration<double>(
        std::clamp(kPollShare * watch.seconds(), kShortestPoll_s, kLongestPoll_s)));
  }
  const Process::Ending ending = process.end();
  result.seconds = watch.seconds();
  result.peak_memory_bytes = std::max(result.peak_memory_bytes, ending.peak_memory_bytes);
  if (!passed) result.exit_code = ending.exit_code;
  result.signalled = !passed && ending.signalled;
  result.end = passed.value_or(ending.exit_code == 0 ? ChildEnd::done : ChildEnd::failed);
  // A signal to all processes (Ctrl-C, shutdown) is not a failure of the child: let it cancel us.
  if (result.end == ChildEnd::failed) progress.advance(0);
  if (result.end != ChildEnd::done) result.message = message_of(result, child);
  return result;
}

}  // namespace adasplats
