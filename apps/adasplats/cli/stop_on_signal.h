// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "adasplats/serve/http_server.h"
#include "cli/interrupt.h"

namespace adasplats::app {

/// Stops the server on an interrupt. The caller's thread throws the exception.
class StopOnSignal {
 public:
  explicit StopOnSignal(HttpServer& server) : thread_([this, &server] { watch(server); }) {}
  ~StopOnSignal() {
    done_ = true;
    thread_.join();
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  void watch(HttpServer& server) {
    while (!done_) {
      try {
        throw_if_interrupted();
      } catch (const Interrupted&) {
        server.stop();
        return;
      }
      constexpr std::chrono::milliseconds kInterruptCheck{50};
      std::this_thread::sleep_for(kInterruptCheck);
    }
  }

  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace adasplats::app
