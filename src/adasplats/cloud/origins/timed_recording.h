// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/origins/clocks.h"
#include "adasplats/cloud/origins/sweep_evidence.h"

namespace adasplats {

/// Points with times, of files that one trajectory is to fit.
class TimedRecording {
 public:
  /// Points of a file, whose views have to stay. Points without a place do not count. Errors: data
  /// for a point with a place and without a time.
  void add(const std::string& file, std::span<const Vec3d> positions, std::span<const double> times,
           SaidClock said);

  bool have_times() const { return span_.first < span_.last; }
  TimeSpan span() const { return span_; }
  SaidClock said() const { return said_; }  ///< by all files
  std::string name() const;                 ///< for messages
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
  SaidClock said_ = SaidClock::nothing;
  std::size_t size_ = 0;
  TimeSpan span_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

}  // namespace adasplats
