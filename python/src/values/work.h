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

/// Hears of progress without the GIL; takes it at most every 50 ms to see to signals (Ctrl-C) and
/// to inform a Python callable, progress(step, done, total). What these raise ends the work.
class PythonProgress final : public ProgressSink {
 public:
  /// `callable`: None for none. Errors: TypeError.
  explicit PythonProgress(py::object callable);

  void begin_step(std::string_view name, std::uint64_t total) override;
  void advance(std::uint64_t done) override;
  void end_step() override;
  void warn(std::string_view message) override;

  /// Gives the warnings to Python. With the GIL.
  void issue_warnings();

 private:
  void tell(std::uint64_t done);

  py::object callable_;
  std::string name_;
  std::uint64_t total_ = 0;
  std::chrono::steady_clock::time_point told_;
  std::vector<std::string> warnings_;
};

/// Sees to signals (Ctrl-C) at most every 50 ms, with or without the GIL; what they raise ends the
/// loop of the Executor that it is the interruption of.
class SignalCheck {
 public:
  void operator()() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::shared_ptr<std::atomic<Clock::rep>> last_ = std::make_shared<std::atomic<Clock::rep>>(0);
};

/// What a function computes with: its keywords device, gpus, threads, seed and progress.
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

  /// f(session) while other Python threads go on. Then the warnings are issued.
  template <class F>
  auto run(F&& f) {
    auto result = [&] {
      const py::gil_scoped_release released;
      Session session_now = session();
      return f(session_now);
    }();
    told_.issue_warnings();
    return result;
  }

 private:
  PythonProgress told_;
  ProgressMeter progress_;
  Executor executor_;
  std::uint64_t seed_;
  DeviceChoice device_;
};

}  // namespace adasplats::python
