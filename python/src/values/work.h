// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/jobs/session/session.h"
#include "keywords.h"

namespace adasplats::python {

/// Receives progress without the GIL. At most every 50 ms it acquires the GIL, checks for signals
/// (Ctrl-C) and calls progress(step, done, total). An exception of either ends the work.
class PythonProgress final : public ProgressSink {
 public:
  /// `callable`: may be None. Errors: TypeError.
  explicit PythonProgress(py::object callable);

  void begin_step(std::string_view name, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end_step() override;
  void warn(std::string_view message) override;

  /// Issues the warnings as UserWarning. Needs the GIL.
  void issue_warnings();

 private:
  void report(std::uint64_t done);

  py::object callable_;
  std::string name_;
  std::uint64_t total_ = 0;
  std::chrono::steady_clock::time_point reported_at_;
  std::vector<std::string> warnings_;
};

/// Interruption check of an Executor: checks for signals (Ctrl-C) at most every 50 ms, with or
/// without the GIL. An exception of a signal handler ends the loop.
class SignalCheck {
 public:
  void operator()() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::shared_ptr<std::atomic<Clock::rep>> last_ = std::make_shared<std::atomic<Clock::rep>>(0);
};

/// The keywords device, gpus, threads, seed and progress.
struct WorkOptions {
  DeviceOptions device;
  bool has_device = true;
  int threads = 0;
  bool has_seed = false;
  std::uint64_t seed = 1;
  py::object progress = py::none();

  void take(Keywords& keywords);
};

/// Errors: ValueError (not 0 to 4096).
int checked_threads(int threads);

/// Executor, progress and device of one call or one object.
class Work {
 public:
  /// Errors: those of choose_device().
  explicit Work(const WorkOptions& options);

  Session session() { return {executor_, progress_, seed_, device_}; }
  const Executor& executor() const { return executor_; }
  ProgressSink& progress() { return progress_; }
  const DeviceChoice& device() const { return device_; }

  /// Runs f(session) without the GIL, then issues the warnings.
  template <class F>
  auto run(F&& f) {
    auto result = [&] {
      const py::gil_scoped_release released;
      Session session_now = session();
      return f(session_now);
    }();
    python_progress_.issue_warnings();
    return result;
  }

 private:
  PythonProgress python_progress_;
  ProgressMeter progress_;
  Executor executor_;
  std::uint64_t seed_;
  DeviceChoice device_;
};

}  // namespace adasplats::python
