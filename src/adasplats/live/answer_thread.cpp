// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/answer_thread.h"

#include <cstddef>
#include <utility>

namespace adasplats {
namespace {

constexpr std::size_t kMaxCalls = 100;

}  // namespace

AnswerThread::AnswerThread() : thread_([this] { run(); }) {}

AnswerThread::~AnswerThread() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool AnswerThread::post(Call call) {
  {
    const std::lock_guard lock(mutex_);
    if (calls_.size() >= kMaxCalls) return false;
    calls_.push_back(std::move(call));
  }
  changed_.notify_all();
  return true;
}

void AnswerThread::run() {
  std::unique_lock lock(mutex_);
  while (!stops_) {
    if (calls_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const Call call = std::move(calls_.front());
    calls_.pop_front();
    lock.unlock();
    call();
    lock.lock();
  }
}

}  // namespace adasplats
