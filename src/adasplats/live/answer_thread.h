// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace adasplats {

/// Makes answers that take long, in order, so that neither the server's thread nor the simulating
/// one waits for them.
class AnswerThread {
 public:
  using Call = std::function<void()>;

  AnswerThread();
  /// Drops the calls that have not begun.
  ~AnswerThread();
  AnswerThread(const AnswerThread&) = delete;
  AnswerThread& operator=(const AnswerThread&) = delete;

  /// Calls `call`, which must not throw. False, and nothing happens: too many are waiting.
  bool post(Call call);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Call> calls_;
  bool stops_ = false;
  std::thread thread_;
};

}  // namespace adasplats
