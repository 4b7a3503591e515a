// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "work.h"

#include <algorithm>

#include "keywords.h"

namespace adasplats::python {
namespace {

constexpr auto kMinInterval = std::chrono::milliseconds(50);

}  // namespace

void SignalCheck::operator()() const {
  const Clock::rep now = Clock::now().time_since_epoch().count();
  Clock::rep last = last_->load();
  if (now - last < Clock::duration(kMinInterval).count()) return;
  if (!last_->compare_exchange_strong(last, now)) return;  // another thread checks
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

int checked_threads(int threads) {
  if (threads < 0 || threads > 4096) throw py::value_error("threads must be 0 to 4096");
  return threads;
}

PythonProgress::PythonProgress(py::object callable) : callable_(std::move(callable)) {
  if (!callable_.is_none() && PyCallable_Check(callable_.ptr()) == 0)
    throw py::type_error("progress must be None or a function of (step, done, total)");
}

void PythonProgress::begin_step(std::string_view name, std::uint64_t total) {
  name_ = name;
  total_ = total;
  report(0);
}

void PythonProgress::advance(std::uint64_t done) {
  if (std::chrono::steady_clock::now() - reported_at_ >= kMinInterval) report(done);
}

void PythonProgress::end_step() { report(total_); }

void PythonProgress::report(std::uint64_t done) {
  reported_at_ = std::chrono::steady_clock::now();
  const py::gil_scoped_acquire acquired;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!callable_.is_none()) callable_(name_, done, total_);
}

void PythonProgress::warn(std::string_view message) {
  // Work that is repeated on another device repeats its warnings.
  if (std::find(warnings_.begin(), warnings_.end(), message) == warnings_.end())
    warnings_.emplace_back(message);
}

void PythonProgress::issue_warnings() {
  const std::vector<std::string> warnings = std::exchange(warnings_, {});
  for (const std::string& warning : warnings)
    if (PyErr_WarnEx(PyExc_UserWarning, with_keywords(warning).c_str(), 1) != 0)
      throw py::error_already_set();
}

void WorkOptions::take(Keywords& keywords) {
  if (has_device) {
    keywords.take<DeviceKind>("device", device.kind, device_words());
    keywords.take("gpus", device.gpus);
  }
  keywords.take("threads", threads);
  if (has_seed) keywords.take("seed", seed);
  keywords.take("progress", progress);
}

Work::Work(const WorkOptions& options)
    : python_progress_(options.progress),
      progress_(python_progress_),
      executor_(checked_threads(options.threads), SignalCheck(), &progress_),
      seed_(options.seed),
      device_(options.has_device ? choose_device(options.device) : DeviceChoice{}) {}

}  // namespace adasplats::python
