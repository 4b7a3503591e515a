// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/origin_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/maths/median.h"
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {
namespace {

constexpr std::size_t kCheckedBeams = 400'000;
/// Minimum contradicted seeds of a part and of all parts: among four equally good shifts, the best
/// has 2 % fewer by chance.
constexpr std::uint64_t kEnoughOfPart = 1000, kEnough = 1500;

// OriginCheck::near_rise and far_rise: correct positions never have less than the kMin values, and
// rarely less than both kDoubted values (docs/research/positions.md).
constexpr double kMinNear = 0.96, kDoubtedNear = 1.03;
constexpr double kMinFar = 0.97, kDoubtedFar = 1.06;

/// Joins parts with the next ones until each has enough contradicted seeds.
std::vector<MovedEvidence> parts_of(std::span<const MovedEvidence> scene_parts) {
  std::vector<MovedEvidence> parts;
  MovedEvidence next;
  for (const MovedEvidence& part : scene_parts) {
    next += part;
    if (next.given.contradicted < kEnoughOfPart) continue;
    parts.push_back(next);
    next = {};
  }
  if (!parts.empty()) parts.back() += next;
  return parts;
}

/// Contradicted seeds of the best shift.
std::uint64_t min_contradicted(std::span<const CrossedSeeds> moved) {
  return std::ranges::min(moved, {}, &CrossedSeeds::contradicted).contradicted;
}

std::string hundredths(double value) {
  const std::string digits = std::to_string(std::lround(100 * value) + 1000);  // four at least
  return std::to_string(std::lround(100 * value) / 100) + "." + digits.substr(digits.size() - 2);
}

std::string figures(const OriginCheck& check) {
  return "rays from positions shifted by 10 % of the median range cross " +
         hundredths(check.near_rise) + " times as many surfaces, from positions shifted by 30 % " +
         hundredths(check.far_rise) + " times";
}

}  // namespace

MovedEvidence& MovedEvidence::operator+=(const MovedEvidence& other) {
  given += other.given;
  for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += other.moved[k];
  return *this;
}

double OriginCheck::share() const {
  return seeds == 0 ? 0 : static_cast<double>(contradicted) / static_cast<double>(seeds);
}

OriginCheck origin_check(std::span<const MovedEvidence> scene_parts) {
  OriginCheck check;
  for (const MovedEvidence& part : scene_parts) {
    check.seeds += part.given.crossed;
    check.contradicted += part.given.contradicted;
  }
  std::uint64_t near = 0, far = 0;
  for (const MovedEvidence& part : parts_of(scene_parts)) {
    const std::span moved(part.moved);
    near += min_contradicted(moved.first(kNearMoves));
    far += min_contradicted(moved.subspan(kNearMoves));
  }
  if (check.contradicted < kEnough) return check;
  check.near_rise = static_cast<double>(near) / static_cast<double>(check.contradicted);
  check.far_rise = static_cast<double>(far) / static_cast<double>(check.contradicted);
  return check;
}

std::string origin_objection(const OriginCheck& check) {
  if (check.contradicted < kEnough) return {};
  if (check.near_rise >= kMinNear && check.far_rise >= kMinFar) return {};
  return "the sensor positions do not match the points: " + figures(check) +
         "; correct ones give at least " + hundredths(kMinNear) + " and " + hundredths(kMinFar) +
         "; check the axes, units, clock and mount of the poses (`trust_origins` skips this check)";
}

std::string origin_doubt(const OriginCheck& check) {
  if (check.contradicted < kEnough || !origin_objection(check).empty()) return {};
  if (check.near_rise >= kDoubtedNear || check.far_rise >= kDoubtedFar) return {};
  return "the sensor positions may be wrong: " + figures(check) +
         "; most recordings give at least " + hundredths(kDoubtedNear) + " or " +
         hundredths(kDoubtedFar) +
         ", dense vegetation less; check the axes, units, clock and mount of the poses";
}

PointCloud sample_beams(const PointCloud& cloud, std::span<const std::uint8_t> removed,
                        std::size_t all) {
  PointCloud beams;
  if (!cloud.has_beams()) return beams;
  constexpr double kAll = std::numeric_limits<std::uint32_t>::max();
  const double share = std::min(1.0, static_cast<double>(kCheckedBeams) / static_cast<double>(all));
  const auto last = static_cast<std::uint32_t>(share * kAll);
  const bool has_classes = !removed.empty() && !cloud.classes.empty();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f sensor = cloud.sensor_positions[i], point = cloud.positions[i];
    if (!is_beam(cloud.origin_kind(i)) || ray_hash(sensor, point) > last) continue;
    if (has_classes && removed[cloud.classes[i]] != 0) continue;
    beams.positions.push_back(point);
    beams.sensor_positions.push_back(sensor);
  }
  return beams;
}

float origin_unit_m(const PointCloud& beams) {
  std::vector<float> ranges_m(beams.size());
  for (std::size_t i = 0; i < beams.size(); ++i)
    ranges_m[i] = length(beams.positions[i] - beams.sensor_positions[i]);
  constexpr float kLeast_m = 10;
  return ranges_m.empty() ? kLeast_m : std::max(kLeast_m, upper_median_of(ranges_m));
}

EvidenceOptions origin_evidence() {
  EvidenceOptions evidence;
  evidence.range_margin_m = 0.5F;
  evidence.parts = 1;
  return evidence;
}

}  // namespace adasplats
