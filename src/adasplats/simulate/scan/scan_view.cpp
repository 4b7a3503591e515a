// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_view.h"

#include <algorithm>
#include <utility>

#include "adasplats/simulate/scan/scan_rules.h"

namespace adasplats {

ScanView::ScanView(const Scan& scan)
    : world_from_sensor(scan.world_from_sensor),
      time_s(scan.time_s),
      knots(scan.knots),
      duration_s(scan.duration_s),
      frame(scan.frame),
      rays(scan.rays),
      positions(scan.positions) {
  for_each_scan_attribute([&](const auto& attribute) { attribute.of(*this) = attribute.of(scan); });
}

ScanView::ScanView(const ScanBatch& batch, std::size_t i, const ScanMotion& motion,
                   const ScanRules& rules)
    : world_from_sensor(motion.reference.world_from_sensor),
      time_s(motion.reference.time_s),
      knots(motion.knots),
      duration_s(motion.duration_s),
      frame(rules.frame()),
      rays(rules.firings().size()) {
  const auto part = [&](auto& values, const auto* array) {
    if (array != nullptr) values = {array + batch.offsets[i], array + batch.offsets[i + 1]};
  };
  part(positions, batch.arrays.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { part(attribute.of(*this), attribute.of(batch.arrays)); });
}

std::size_t ScanView::size() const {
  std::size_t most = positions.size();
  for_each_scan_attribute(
      [&](const auto& attribute) { most = std::max(most, attribute.of(*this).size()); });
  return most;
}

void ScanView::copy_to(Scan& scan) const {
  scan.world_from_sensor = world_from_sensor;
  scan.time_s = time_s;
  scan.knots.assign(knots.begin(), knots.end());
  scan.duration_s = duration_s;
  scan.frame = frame;
  scan.rays = rays;
  scan.positions.assign(positions.begin(), positions.end());
  for_each_scan_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(*this);
    attribute.of(scan).assign(values.begin(), values.end());
  });
}

Vec3d world_point_of(const ScanView& scan, std::size_t i) {
  const Vec3d point = vec_cast<double>(scan.positions[i]);
  const bool is_raw = scan.frame == PointFrame::raw && scan.knots.size() > 1;
  if (!is_raw || scan.times_s.empty() || !(scan.duration_s > 0))
    return scan.world_from_sensor * point;
  return world_point(scan.knots, double{scan.times_s[i]} / scan.duration_s, point);
}

double time_of_point(const ScanView& scan, std::size_t i) {
  if (!scan.moved() || scan.times_s.empty()) return scan.time_s;
  return scan.begin_s() + double{scan.times_s[i]};
}

HeldScan held_scan(Scan&& scan) {
  const auto held = std::make_shared<const Scan>(std::move(scan));
  return {*held, held};
}

HeldScan ScanPool::hold(Scan& scan) {
  std::unique_ptr<Scan> taken;
  {
    const std::lock_guard lock(free_->mutex);
    if (!free_->scans.empty()) {
      taken = std::move(free_->scans.back());
      free_->scans.pop_back();
    }
  }
  if (!taken) taken = std::make_unique<Scan>();
  std::swap(*taken, scan);
  const std::shared_ptr<Scan> held(taken.release(), [free = free_](Scan* done) {
    std::unique_ptr<Scan> back(done);
    const std::lock_guard lock(free->mutex);
    free->scans.push_back(std::move(back));
  });
  return {*held, held};
}

}  // namespace adasplats
