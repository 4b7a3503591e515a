// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/program.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <thread>

#include "adasplats/core/error.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every unistd.h

namespace adasplats {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};
constexpr int kCannotStart = 127;  // as shells have it

bool is_program(const std::filesystem::path& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(path, failure) && access(path.c_str(), X_OK) == 0;
}

/// What happens in the new process: only calls that are safe between fork and exec.
[[noreturn]] void become(char* const* arguments, char* const* environment, const char* log,
                         pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotStart);  // it has died meanwhile
  const int in = open("/dev/null", O_RDONLY);
  const int out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  // What we ignore would stay ignored.
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  execve(arguments[0], arguments, environment);
  _exit(kCannotStart);
}

/// exec takes char* for historical reasons and changes nothing.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// Ours, and what OpenMP shall do: its threads spin where they wait, which on cores that others use
/// as well took 4 times as long.
std::vector<std::string> environment_for(int threads) {
  std::vector<std::string> variables = {"OMP_NUM_THREADS=" + std::to_string(threads)};
  bool has_policy = false;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (text.starts_with("OMP_NUM_THREADS=")) continue;
    has_policy = has_policy || text.starts_with("OMP_WAIT_POLICY=");
    variables.emplace_back(text);
  }
  if (!has_policy) variables.emplace_back("OMP_WAIT_POLICY=passive");
  return variables;
}

/// A child process that does not outlive this object.
class Child {
 public:
  Child(const std::vector<std::string>& arguments, int threads, const std::filesystem::path& log) {
    const std::vector<std::string> environment = environment_for(threads);
    const std::vector<char*> argv = pointers_to(arguments), envp = pointers_to(environment);
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ == 0) become(argv.data(), envp.data(), log.c_str(), parent);
    if (process_ < 0)
      throw system_error(ErrorKind::unavailable, arguments[0], "cannot be started", errno);
  }
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  struct End {
    int status = 0;
    std::uint64_t peak_memory_bytes = 0;
  };
  /// How it ended, where it has.
  std::optional<End> poll() {
    End end;
    struct rusage usage {};
    if (wait4(process_, &end.status, WNOHANG, &usage) != process_) return std::nullopt;
    process_ = -1;
    end.peak_memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return end;
  }

 private:
  pid_t process_ = -1;
};

std::string last_line(const std::filesystem::path& log) {
  constexpr std::size_t kLongest = 300;
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last.substr(0, kLongest);
}

void check_end(int status, const std::filesystem::path& program, const std::filesystem::path& log) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  std::string text = program.string() + ": ";
  if (WIFSIGNALED(status))
    text += "was ended by signal " + std::to_string(WTERMSIG(status));
  else if (WEXITSTATUS(status) == kCannotStart)
    text += "cannot be started";
  else
    text += "failed with exit code " + std::to_string(WEXITSTATUS(status));
  const std::string said = last_line(log);
  throw Error(ErrorKind::unavailable, text + (said.empty() ? "" : "; it said: " + said));
}

}  // namespace

std::optional<std::filesystem::path> find_on_path(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::filesystem::path program = std::filesystem::path(rest.substr(0, end)) / name;
    if (end > 0 && is_program(program)) return program;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> find_beside_own(const std::string& name) {
  std::error_code failure;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) return std::nullopt;
  const std::filesystem::path program = own.parent_path() / name;
  if (is_program(program)) return program;
  return std::nullopt;
}

std::uint64_t run_program(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, int threads,
                          const std::filesystem::path& log, ProgressSink& progress) {
  std::vector<std::string> all = {program.string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  Child child(all, threads, log);
  while (true) {
    // First: Ctrl-C reaches the child, too, and is no failure of its.
    const std::optional<Child::End> end = child.poll();
    progress.advance(0);
    if (end) {
      check_end(end->status, program, log);
      return end->peak_memory_bytes;
    }
    std::this_thread::sleep_for(kPollInterval);
  }
}

}  // namespace adasplats
