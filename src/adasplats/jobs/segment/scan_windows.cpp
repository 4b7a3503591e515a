// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/scan_windows.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace adasplats {

ScanWindows::ScanWindows(const KittiSequence& sequence, std::vector<std::size_t> chosen,
                         const WindowOptions& options, double farthest_m)
    : sequence_(sequence),
      chosen_(std::move(chosen)),
      max_points_(options.points * 2 / 3),
      max_context_(options.points / 6),
      farthest_m_(farthest_m) {
  check_settings(options);
}

ScanWindows::Placed ScanWindows::read(std::size_t index) const {
  const KittiScan scan = read_kitti_points(sequence_, index);
  Placed placed;
  placed.scan.index = index;
  placed.scan.has_place.reserve(scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    // Not so for coordinates that are NaN, either.
    const bool is_near = length(vec_cast<double>(scan.positions[i])) <= farthest_m_;
    placed.scan.has_place.push_back(is_near);
    if (!is_near) continue;
    placed.positions.push_back(scan.positions[i]);
    if (!scan.intensities.empty()) placed.intensities.push_back(scan.intensities[i]);
  }
  return placed;
}

const ScanWindows::Placed& ScanWindows::at(std::size_t place) {
  while (first_ + read_.size() <= place) read_.push_back(read(chosen_[first_ + read_.size()]));
  return read_[place - first_];
}

std::size_t ScanWindows::first_of_context(std::size_t place) {
  std::size_t points = 0;
  while (place > first_ && points < max_context_) points += at(--place).positions.size();
  return place;
}

void ScanWindows::add_points(const Placed& placed, PointCloud& cloud) const {
  const RigidTransform pose = sequence_.trajectory[placed.scan.index].world_from_sensor;
  for (const Vec3f p : placed.positions)
    cloud.positions.push_back(vec_cast<float>(pose * vec_cast<double>(p) - cloud.origin));
  cloud.intensities.insert(cloud.intensities.end(), placed.intensities.begin(),
                           placed.intensities.end());
  // NaN: scans without intensities.
  cloud.intensities.resize(cloud.positions.size(), std::numeric_limits<float>::quiet_NaN());
}

std::optional<ScanWindow> ScanWindows::next() {
  if (next_ == chosen_.size()) return std::nullopt;
  std::size_t end = next_, points = 0;
  while (end < chosen_.size() && points < max_points_) points += at(end++).positions.size();
  std::size_t context_end = end;
  for (points = 0; context_end < chosen_.size() && points < max_context_;)
    points += at(context_end++).positions.size();
  if (context_end == chosen_.size()) end = context_end;

  const std::size_t context_begin = first_of_context(next_);
  ScanWindow window;
  window.cloud.origin = sequence_.trajectory[chosen_[context_begin]].world_from_sensor.translation;
  bool has_intensities = false;
  const auto add = [&](std::size_t place) {
    add_points(at(place), window.cloud);
    has_intensities = has_intensities || !at(place).intensities.empty();
  };
  for (std::size_t k = next_; k < end; ++k) {
    add(k);
    window.scans.push_back(at(k).scan);
  }
  window.points = window.cloud.size();
  for (std::size_t k = context_begin; k < next_; ++k) add(k);
  for (std::size_t k = end; k < context_end; ++k) add(k);
  if (!has_intensities) window.cloud.intensities.clear();

  next_ = end;
  const std::size_t kept = first_of_context(next_);
  read_.erase(read_.begin(), read_.begin() + static_cast<std::ptrdiff_t>(kept - first_));
  first_ = kept;
  return window;
}

}  // namespace adasplats
