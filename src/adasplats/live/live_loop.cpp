// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/live_loop.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxCommands = 1000;

}  // namespace

LiveLoop::LiveLoop(LiveRig& rig, LiveStreams& streams, bool running)
    : rig_(rig),
      streams_(streams),
      running_(running),
      last_scans_(rig.sensors().size()),
      thread_([this] { loop(); }) {}

LiveLoop::~LiveLoop() { stop(); }

void LiveLoop::stop() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  pacer_.stop();  // a step may be waiting for its parts to be sent
  if (thread_.joinable()) thread_.join();
}

bool LiveLoop::post(Command command) {
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() >= kMaxCommands) return false;
    commands_.push_back(std::move(command));
  }
  changed_.notify_all();
  return true;
}

std::shared_ptr<const Scan> LiveLoop::last_scan(std::size_t sensor) const {
  const std::lock_guard lock(mutex_);
  return last_scans_.at(sensor);
}

void LiveLoop::set_running(bool running) {
  if (running && steps_left_ > 0)
    throw Error(ErrorKind::usage, "steps are being made; wait for their end");
  if (running && !running_) begins_ = true;
  if (running) error_.clear();
  running_ = running;
  if (!running && steps_left_ > 0) end_steps("stopped by a request");
}

void LiveLoop::make_steps(std::size_t count, StepsDone done) {
  if (running_) throw Error(ErrorKind::usage, "the simulation runs; stop it first (run)");
  if (steps_left_ > 0) throw Error(ErrorKind::usage, "other steps are being made");
  error_.clear();
  steps_left_ = count;
  steps_done_ = std::move(done);
}

void LiveLoop::loop() {
  std::unique_lock lock(mutex_);
  while (!stops_) {
    // Those that come meanwhile wait for the next step.
    for (std::size_t left = commands_.size(); left > 0 && !stops_; --left) {
      const Command command = std::move(commands_.front());
      commands_.pop_front();
      lock.unlock();
      command();
      lock.lock();
    }
    if (stops_) return;
    if (!running_ && steps_left_ == 0 && !commands_.empty()) continue;
    if (!running_ && steps_left_ == 0) {
      changed_.wait(lock);
    } else if (running_ && !begins_ && Clock::now() < last_begin_) {
      if (commands_.empty()) changed_.wait_until(lock, last_begin_);
    } else {
      lock.unlock();
      step();
      lock.lock();
    }
  }
}

void LiveLoop::end_steps(const std::string& error) {
  steps_left_ = 0;
  if (const StepsDone done = std::exchange(steps_done_, nullptr)) done(error);
}

void LiveLoop::step() {
  try {
    if (!running_ || begins_) pacer_.drain();  // of what was made while it ran
    const LiveStep step = rig_.step();
    {
      const std::lock_guard lock(mutex_);
      for (const LiveScan& live : step.scans) last_scans_[live.sensor] = live.scan;
    }
    const Clock::time_point now = Clock::now();
    if (running_) {
      const auto duration = std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(step.duration_s));
      if (!begins_ && now > next_due_) ++late_steps_;
      // The first one waits, so that a step that takes longer than usual is not late.
      const Clock::time_point due = begins_ ? now + duration : std::max(now, next_due_);
      begins_ = false;
      last_begin_ = due - duration;
      next_due_ = due + duration;
      send(step, due, 1);
    } else {
      // As fast as possible, in the order of time.
      constexpr double kFast = 1e-6;
      send(step, now, streams_.has_packets() ? 1 : kFast);
      pacer_.drain();
      if (--steps_left_ == 0) end_steps("");
    }
  } catch (const std::exception& error) {
    error_ = error.what();
    running_ = false;
    end_steps(error_);
  } catch (...) {  // an interruption, which also ends the program
    running_ = false;
    end_steps("interrupted");
  }
}

/// `pace`: seconds that a second of the simulation takes.
void LiveLoop::send(const LiveStep& step, Clock::time_point due, double pace) {
  const LiveStreams::Schedule schedule = [&](double time_s, std::function<void()> action) {
    const std::chrono::duration<double> after(pace * std::max(0.0, time_s - step.begin_s));
    pacer_.add(due + std::chrono::duration_cast<Clock::duration>(after), std::move(action));
  };
  streams_.send(step, schedule);
}

}  // namespace adasplats
