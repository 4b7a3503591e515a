// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/pacer.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace adasplats {
namespace {

constexpr std::size_t kKeptDelays = 100'000;

/// Lets this thread go before those that simulate, if the system permits it.
void ask_for_priority() {
  constexpr int kNice = -10;
  const auto thread = static_cast<id_t>(syscall(SYS_gettid));
  setpriority(PRIO_PROCESS, thread, kNice);
}

}  // namespace

Pacer::Pacer() : thread_([this] { run(); }) {}

void Pacer::stop() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  drained_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Pacer::add(Clock::time_point due, std::function<void()> action) {
  bool is_next = false;
  {
    const std::lock_guard lock(mutex_);
    const auto added = actions_.emplace(due, std::move(action));
    is_next = added == actions_.begin();
  }
  if (is_next) changed_.notify_all();
}

void Pacer::drain() {
  std::unique_lock lock(mutex_);
  drained_.wait(lock, [this] { return stops_ || (actions_.empty() && !is_acting_); });
}

Lateness Pacer::lateness() const {
  std::vector<float> late_s;
  Lateness lateness;
  {
    const std::lock_guard lock(mutex_);
    late_s = late_s_;
    lateness.actions = count_;
  }
  if (late_s.empty()) return lateness;
  // Not sorted, because each request for the state asks for it.
  const auto quantile = [&late_s](std::size_t rank) {
    const auto at = late_s.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(late_s, at);
    return static_cast<double>(*at);
  };
  constexpr double kMost = 0.99;
  lateness.median_s = quantile(late_s.size() / 2);
  lateness.p99_s =
      quantile(static_cast<std::size_t>(kMost * static_cast<double>(late_s.size() - 1)));
  lateness.max_s = quantile(late_s.size() - 1);
  return lateness;
}

void Pacer::run() {
  ask_for_priority();
  std::unique_lock lock(mutex_);
  while (!stops_) {
    if (actions_.empty()) {
      drained_.notify_all();
      changed_.wait(lock);
      continue;
    }
    const Clock::time_point due = actions_.begin()->first, now = Clock::now();
    if (due > now) {
      changed_.wait_until(lock, due);
      continue;
    }
    const std::function<void()> action = std::move(actions_.extract(actions_.begin()).mapped());
    const auto late_s = std::chrono::duration<float>(now - due).count();
    if (late_s_.size() < kKeptDelays)
      late_s_.push_back(late_s);
    else
      late_s_[count_ % kKeptDelays] = late_s;
    ++count_;
    is_acting_ = true;
    lock.unlock();
    try {
      action();
    } catch (...) {  // without memory, it is lost
    }
    lock.lock();
    is_acting_ = false;
  }
}

}  // namespace adasplats
