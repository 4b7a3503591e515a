// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/origins/sweep_evidence.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Points with times, of files that one trajectory is to fit.
class TimedRecording {
 public:
  /// Points of a file, whose views have to stay. Points without a place do not count. Errors: data
  /// for a point with a place and without a time.
  void add(const std::string& file, std::span<const Vec3d> positions, std::span<const double> times,
           DeclaredClock declared);

  bool have_times() const { return span_.first < span_.last; }
  TimeSpan span() const { return span_; }
  DeclaredClock declared() const { return declared_; }  ///< by all files
  std::string name() const;                             ///< for messages
  std::size_t size() const { return size_; }
  /// How many points, once in seconds by `clock` in the trajectory's, are within a span.
  std::size_t count_within(TimeSpan span_s, const ClockPair& clock) const;
  /// At most 200,000 points and eight sweeps.
  SweepSample sample(double unit_s) const;

 private:
  struct File {
    std::span<const Vec3d> positions;
    std::span<const double> times;
  };
  std::vector<File> files_;
  std::string first_name_;
  DeclaredClock declared_ = DeclaredClock::none;
  std::size_t size_ = 0;
  TimeSpan span_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

/// Finds which clocks the times of points and of a trajectory are of, and holds what was found
/// against the points.
class ClockFinder {
 public:
  /// `file`: of the trajectory, for messages. `sensor`: the poses of the sensor by it, in the
  /// file's clock. `stated_offset_s` stands for what would be found.
  ClockFinder(const TimedRecording& points, std::filesystem::path file, const Trajectory& sensor,
              std::optional<double> stated_offset_s, const Executor& executor);

  /// The one clock that makes the trajectory cover all times; of several the one that the points
  /// fit clearly best. Errors: data, with figures and with what states it.
  ClockPair find();
  Track track(const ClockPair& clock) const;
  SweepView view(const ClockPair& clock);
  /// Errors: data where points are within a gap of the track, and where they do not look as if they
  /// had been measured from it: too far away, behind each other, or better some seconds before or
  /// after (of a stated offset a warning says so).
  void check(const ClockPair& clock, const SweepView& seen, ProgressSink& progress);
  void require_no_gaps(const ClockPair& clock, const Track& track) const;

 private:
  TimeSpan covered(const ClockPair& clock) const;
  bool covers(const ClockPair& clock) const;
  void require_cover(const std::vector<ClockPair>& possible) const;
  ClockPair clearest(const std::vector<ClockPair>& covering);
  bool is_aside(const ClockPair& clock, const SweepView& seen);
  double better_shift_s(const ClockPair& clock);
  const SweepSample& sample(double unit_s);

  const TimedRecording& points_;
  std::filesystem::path file_;
  const Trajectory& sensor_;
  std::optional<double> stated_offset_s_;
  const Executor& executor_;
  TimeSpan padded_;  ///< the poses, one distance longer at both ends, in the file's unit
  double sample_unit_s_ = 0;
  SweepSample sample_;
};

}  // namespace adasplats
