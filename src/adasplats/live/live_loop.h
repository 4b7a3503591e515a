// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "adasplats/live/live_rig.h"
#include "adasplats/live/live_streams.h"
#include "adasplats/live/pacer.h"

namespace adasplats {

/// Steps a rig on a thread of its own: in real time, or a number of steps as fast as they can be
/// made (with packets at most in real time, since receivers lose bursts). In real time, up to two
/// steps are simulated ahead of what is being sent; if steps take longer than they last, the clock
/// of the simulation falls behind and no step is skipped.
class LiveLoop {
 public:
  /// What a user wants to do between two steps.
  using Command = std::function<void()>;
  /// `error`: why not all steps were made; empty: they were.
  using StepsDone = std::function<void(const std::string& error)>;

  LiveLoop(LiveRig& rig, LiveStreams& streams, bool running);
  ~LiveLoop();
  LiveLoop(const LiveLoop&) = delete;
  LiveLoop& operator=(const LiveLoop&) = delete;

  /// Ends the simulating thread; commands and scans that are left are dropped. Its other members
  /// may be used on any thread from then on.
  void stop();
  /// Calls a command on the simulating thread. False, and nothing happens: too many are waiting.
  bool post(Command command);
  /// The last scan of a sensor; null: none yet. Thread-safe.
  std::shared_ptr<const Scan> last_scan(std::size_t sensor) const;
  Lateness lateness() const { return pacer_.lateness(); }

  // On the simulating thread only.
  bool is_running() const { return running_; }
  /// Steps that were ready too late for real time.
  std::uint64_t late_steps() const { return late_steps_; }
  /// Why the simulation stopped; empty: it did not.
  const std::string& error() const { return error_; }
  /// False also ends steps that are being made. Errors: usage (true while steps are being made).
  void set_running(bool running);
  /// Errors: usage (it runs, or makes other steps).
  void make_steps(std::size_t count, StepsDone done);

 private:
  using Clock = Pacer::Clock;

  void loop();
  void step();
  void send(const LiveStep& step, Clock::time_point due, double pace);
  void end_steps(const std::string& error);

  LiveRig& rig_;
  LiveStreams& streams_;
  bool running_;
  bool begins_ = true;  ///< real time: no step was made since set_running()
  std::size_t steps_left_ = 0;
  StepsDone steps_done_;
  Clock::time_point last_begin_;  ///< when the sending of the step before the last one begins
  Clock::time_point next_due_;    ///< when that of the next one begins
  std::uint64_t late_steps_ = 0;
  std::string error_;
  mutable std::mutex mutex_;  ///< for the members below
  std::condition_variable changed_;
  std::deque<Command> commands_;
  std::vector<std::shared_ptr<const Scan>> last_scans_;
  bool stops_ = false;
  Pacer pacer_;
  std::thread thread_;
};

}  // namespace adasplats
