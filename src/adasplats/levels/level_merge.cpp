// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adasplats {
namespace {

constexpr float kSameFacing = 0.70710678F;  ///< cosine of 45 degrees
constexpr double kMinShare = 0.1;           ///< of the area, for a second facing
constexpr int kRounds = 2;                  ///< of moving facings to the means of their disks

/// Over pi.
double area_of(const Disk& disk) {
  return static_cast<double>(disk.radius) * static_cast<double>(disk.radius);
}

float alignment(const Disk& disk, Vec3f direction) {
  return std::fabs(dot(disk.normal, direction));
}

}  // namespace

float ElementValues::intensity(std::size_t k) const {
  if (intensities.empty()) return 0;
  const float value = intensities[sources[k]];
  return std::isnan(value) ? 0 : value;
}

float ElementValues::error_m(std::size_t k) const {
  return errors_m.empty() ? std::numeric_limits<float>::quiet_NaN() : errors_m[sources[k]];
}

Vec3f ElementValues::color(std::size_t k) const {
  if (colors.empty()) return {};
  const auto& [red, green, blue] = colors[sources[k]];
  return {static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)};
}

ElementValues ElementValues::run(std::size_t begin, std::size_t end) const {
  return {classes, intensities, errors_m, colors, sources.subspan(begin, end - begin)};
}

LevelSample sample_of(const Disk& disk, const ElementValues& values, std::size_t k) {
  return {disk.center,         disk.radius,       disk.normal,    values.class_id(k),
          values.intensity(k), values.error_m(k), values.color(k)};
}

LevelSample sample_of(Vec3f position, const ElementValues& values, std::size_t k) {
  return {position,       0, {0, 0, 1}, values.class_id(k), values.intensity(k), values.error_m(k),
          values.color(k)};
}

void CellMerger::find_facings(std::span<const Disk> disks) {
  const auto larger = [](const Disk& a, const Disk& b) { return a.radius < b.radius; };
  facings_ = {};
  facings_[0].direction = std::ranges::max_element(disks, larger)->normal;
  double area = 0, apart = 0;
  const Disk* largest_apart = nullptr;
  for (const Disk& disk : disks) {
    area += area_of(disk);
    if (alignment(disk, facings_[0].direction) > kSameFacing) continue;
    apart += area_of(disk);
    if (largest_apart == nullptr || larger(*largest_apart, disk)) largest_apart = &disk;
  }
  facing_count_ = largest_apart != nullptr && apart >= kMinShare * area ? 2 : 1;
  if (facing_count_ == 2) facings_[1].direction = largest_apart->normal;
}

void CellMerger::assign(std::span<const Disk> disks) {
  for (Facing& facing : facings_) facing = {facing.direction};
  facing_of_.resize(disks.size());
  for (std::size_t k = 0; k < disks.size(); ++k) {
    const Disk& disk = disks[k];
    const bool second = facing_count_ == 2 && alignment(disk, facings_[1].direction) >
                                                  alignment(disk, facings_[0].direction);
    facing_of_[k] = second ? 1 : 0;
    Facing& facing = facings_[facing_of_[k]];
    const double area = area_of(disk);
    const bool with = dot(disk.normal, facing.direction) >= 0;
    facing.area += area;
    if (with) facing.with_direction += area;
    facing.center_sum = facing.center_sum + area * vec_cast<double>(disk.center);
    facing.normal_sum = facing.normal_sum + (with ? area : -area) * vec_cast<double>(disk.normal);
  }
}

std::uint16_t CellMerger::class_of_most_area(std::size_t facing, std::span<const Disk> disks,
                                             const ElementValues& values) {
  if (values.classes.empty()) return 0;
  class_areas_.clear();
  for (std::size_t k = 0; k < disks.size(); ++k) {
    if (facing_of_[k] != facing) continue;
    const std::uint16_t id = values.class_id(k);
    const auto found =
        std::ranges::find(class_areas_, id, &std::pair<std::uint16_t, double>::first);
    if (found == class_areas_.end())
      class_areas_.emplace_back(id, area_of(disks[k]));
    else
      found->second += area_of(disks[k]);
  }
  const auto less = [](const auto& a, const auto& b) {
    return a.second != b.second ? a.second < b.second : a.first > b.first;
  };
  return std::ranges::max_element(class_areas_, less)->first;
}

LevelSample CellMerger::merged_facing(std::size_t facing, std::span<const Disk> disks,
                                      const ElementValues& values) {
  const Facing& sums = facings_[facing];
  const Vec3d center = sums.center_sum / sums.area;
  const Vec3d direction = normalized(sums.normal_sum);
  double reach = 0, intensity = 0, error_m = 0, known = 0;
  Vec3d color;
  for (std::size_t k = 0; k < disks.size(); ++k) {
    if (facing_of_[k] != facing) continue;
    const Vec3d offset = vec_cast<double>(disks[k].center) - center;
    const Vec3d across = offset - dot(offset, direction) * direction;
    reach = std::max(reach, length(across) + static_cast<double>(disks[k].radius));
    const double area = area_of(disks[k]);
    intensity += area * static_cast<double>(values.intensity(k));
    color = color + area * vec_cast<double>(values.color(k));
    if (std::isnan(values.error_m(k))) continue;
    known += area;
    error_m += area * static_cast<double>(values.error_m(k));
  }
  LevelSample sample;
  sample.position = vec_cast<float>(center);
  sample.radius_m = static_cast<float>(std::min(std::sqrt(sums.area), reach));
  const bool against = sums.with_direction < 0.5 * sums.area;
  sample.normal = vec_cast<float>(against ? -direction : direction);
  sample.class_id = class_of_most_area(facing, disks, values);
  sample.intensity = static_cast<float>(intensity / sums.area);
  sample.color = vec_cast<float>(color / sums.area);
  sample.error_m =
      known > 0 ? static_cast<float>(error_m / known) : std::numeric_limits<float>::quiet_NaN();
  return sample;
}

void CellMerger::merge(std::span<const Disk> disks, const ElementValues& values,
                       std::vector<LevelSample>& merged) {
  if (disks.size() == 1) {
    merged.push_back(sample_of(disks.front(), values, 0));
    return;
  }
  find_facings(disks);
  assign(disks);
  for (int round = 0; round < kRounds && facing_count_ == 2; ++round) {
    for (Facing& facing : facings_)
      if (facing.area > 0) facing.direction = normalized(vec_cast<float>(facing.normal_sum));
    assign(disks);
  }
  for (std::size_t k = 0; k < facing_count_; ++k)
    if (facings_[k].area > 0) merged.push_back(merged_facing(k, disks, values));
}

}  // namespace adasplats
