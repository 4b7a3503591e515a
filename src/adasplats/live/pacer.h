// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace adasplats {

/// How late actions were, s.
struct Lateness {
  std::size_t actions = 0;  ///< of all time; the others are of the last 100,000
  double median_s = 0, p99_s = 0, max_s = 0;
};

/// Calls functions at given times on a thread of its own, in the order of these times and, at equal
/// ones, of the calls of add().
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  Pacer();
  ~Pacer() { stop(); }
  Pacer(const Pacer&) = delete;
  Pacer& operator=(const Pacer&) = delete;

  /// A time that is over means at once. What it throws is dropped.
  void add(Clock::time_point due, std::function<void()> action);
  /// Waits until all actions are done, or until stop().
  void drain();
  /// Drops what is left, for good, and ends the thread. Callable from any thread but that one, once
  /// at a time.
  void stop();
  Lateness lateness() const;

 private:
  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_, drained_;
  std::multimap<Clock::time_point, std::function<void()>> actions_;
  bool is_acting_ = false, stops_ = false;
  std::vector<float> late_s_;  ///< a ring
  std::size_t count_ = 0;
  std::thread thread_;
};

}  // namespace adasplats
