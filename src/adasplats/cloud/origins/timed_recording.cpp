// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/origins/timed_recording.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxPoints = 200'000, kSweeps = 8, kMaxOfSweep = 200'000;
constexpr double kSweep_s = 0.1;

/// Times in the middles of eight parts with as many points each.
std::array<double, kSweeps> middles_of(const std::vector<TimedPoint>& points) {
  std::vector<double> times;
  times.reserve(points.size());
  for (const TimedPoint& point : points) times.push_back(point.time);
  std::ranges::sort(times);
  std::array<double, kSweeps> middles{};
  for (std::size_t s = 0; s < kSweeps; ++s)
    middles[s] = times[times.size() * (2 * s + 1) / (2 * kSweeps)];
  return middles;
}

void thin(std::vector<TimedPoint>& sweep) {
  const std::size_t every = sweep.size() / kMaxOfSweep + 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sweep.size(); i += every) sweep[kept++] = sweep[i];
  sweep.resize(kept);
}

}  // namespace

void TimedRecording::add(const std::string& file, std::span<const Vec3d> positions,
                         std::span<const double> times, SaidClock said) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i])) {
      span_ = {std::min(span_.first, times[i]), std::max(span_.last, times[i])};
    } else if (is_finite(positions[i])) {
      throw Error(ErrorKind::data,
                  file + ": the time of point " + std::to_string(i) + " (from 0) is not finite");
    }
  }
  said_ = files_.empty() || said == said_ ? said : SaidClock::nothing;
  if (files_.empty()) first_name_ = file;
  files_.push_back({positions, times});
  size_ += times.size();
}

std::string TimedRecording::name() const {
  return first_name_ +
         (files_.size() > 1 ? " and " + std::to_string(files_.size() - 1) + " more" : "");
}

std::size_t TimedRecording::count_within(TimeSpan span_s, const ClockPair& clock) const {
  std::size_t points = 0;
  for (const File& file : files_)
    for (const double time : file.times) {
      const double time_s = clock.in_trajectory(time);
      if (time_s > span_s.first && time_s < span_s.last) ++points;
    }
  return points;
}

SweepSample TimedRecording::sample(double unit_s) const {
  SweepSample sample;
  const auto is_sound = [](const File& file, std::size_t i) {
    return is_finite(file.positions[i]) && std::isfinite(file.times[i]);
  };
  const std::size_t stride = size_ / kMaxPoints + 1;
  for (const File& file : files_)
    for (std::size_t i = 0; i < file.times.size(); i += stride)
      if (is_sound(file, i)) sample.points.push_back({file.positions[i], file.times[i]});
  if (sample.points.empty()) return sample;
  const auto middles = middles_of(sample.points);
  sample.sweeps.resize(kSweeps);
  for (const File& file : files_)
    for (std::size_t i = 0; i < file.times.size(); ++i)
      for (std::size_t s = 0; s < kSweeps; ++s)
        if (std::fabs(file.times[i] - middles[s]) * unit_s <= 0.5 * kSweep_s && is_sound(file, i))
          sample.sweeps[s].push_back({file.positions[i], file.times[i]});
  std::ranges::for_each(sample.sweeps, thin);
  return sample;
}

}  // namespace adasplats
