// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_alignment.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "adasplats/core/maths/median.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kGroupScans = 10;
constexpr double kReach_m = 40;              // of rays that are looked at
constexpr std::size_t kRaysAGroup = 20'000;  // at most
constexpr std::size_t kMinHits = 1'000;      // that say anything of a group
constexpr double kMinHitShare = 0.2;         // of its rays: else most of it is not in the city
constexpr double kSamePlace_m = 1e-3;        // where a scan is the one that was corrected before

/// A correction at the place of one scan.
PoseCorrection correction_at(const TimedPose& pose, const RigidTransform& motion) {
  const Vec3d at = pose.world_from_sensor.translation;
  return {pose.time_s, at, rotation_vector(motion.rotation), motion * at - at};
}

PoseCorrection blended(const PoseCorrection& a, const PoseCorrection& b, double share) {
  PoseCorrection mixed = a;
  mixed.rotation_rad = (1 - share) * a.rotation_rad + share * b.rotation_rad;
  mixed.shift_m = (1 - share) * a.shift_m + share * b.shift_m;
  return mixed;
}

}  // namespace

/// Scans of one drive, one behind another.
struct CityAlignment::Group {
  std::size_t first = 0, end = 0;        ///< of the cloud's scans
  double time_s = 0;                     ///< in the middle
  FitRays rays;                          ///< relative to the city's origin
  std::optional<RigidTransform> motion;  ///< of world coordinates
};

CityAlignment::CityAlignment(std::filesystem::path city, const CityManifest& manifest,
                             const Executor& executor)
    : city_(std::move(city)), manifest_(manifest), executor_(executor) {}
CityAlignment::~CityAlignment() = default;

/// Groups with their rays; a group does not go over from one drive into another.
std::vector<CityAlignment::Group> CityAlignment::groups_in(const PointCloud& cloud) const {
  std::vector<Group> groups;
  std::vector<std::size_t> group_of(cloud.scan_poses.size());
  for (std::size_t scan = 0; scan < cloud.scan_poses.size(); ++scan) {
    const double time_s = cloud.scan_poses[scan].time_s;
    const bool goes_on = scan > 0 && time_s > cloud.scan_poses[scan - 1].time_s &&
                         scan - groups.back().first < kGroupScans;
    if (!goes_on) groups.push_back({scan, scan, 0, {}, {}});
    groups.back().end = scan + 1;
    group_of[scan] = groups.size() - 1;
  }
  const auto is_wanted = [&](std::size_t i) {
    return is_beam(cloud.origin_kind(i)) &&
           length(cloud.positions[i] - cloud.sensor_positions[i]) <= static_cast<float>(kReach_m);
  };
  std::vector<std::size_t> wanted(groups.size()), seen(groups.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_wanted(i)) ++wanted[group_of[cloud.scan_indices[i]]];
  const Vec3d shift = cloud.origin - manifest_.origin;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::size_t g = group_of[cloud.scan_indices[i]];
    if (!is_wanted(i) || seen[g]++ % (1 + wanted[g] / kRaysAGroup) != 0) continue;
    const auto in_city = [&](Vec3f p) { return vec_cast<float>(vec_cast<double>(p) + shift); };
    groups[g].rays.ends.push_back(in_city(cloud.positions[i]));
    groups[g].rays.sensors.push_back(in_city(cloud.sensor_positions[i]));
  }
  for (Group& group : groups)
    group.time_s =
        0.5 * (cloud.scan_poses[group.first].time_s + cloud.scan_poses[group.end - 1].time_s);
  return groups;
}

/// The splats of all tiles that rays end in.
const FitScene* CityAlignment::scene_around(const FitRays& rays) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Vec3f low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  for (const Vec3f end : rays.ends) {
    low = min(low, end);
    high = max(high, end);
  }
  const TileKey first = manifest_.grid.tile_of(manifest_.origin + vec_cast<double>(low));
  const TileKey last = manifest_.grid.tile_of(manifest_.origin + vec_cast<double>(high));
  std::vector<std::size_t> tiles;
  for (std::size_t k = 0; k < manifest_.tiles.size(); ++k) {
    const TileKey key = manifest_.tiles[k].key;
    if (manifest_.tiles[k].splats > 0 && key.x >= first.x && key.x <= last.x && key.y >= first.y &&
        key.y <= last.y)
      tiles.push_back(k);
  }
  if (tiles.empty()) return nullptr;
  if (!scene_ || tiles != tiles_) {
    std::vector<Disk> disks;
    for (const std::size_t tile : tiles) {
      const std::vector<Disk> more = load_city_tile(city_, manifest_, tile).disks;
      disks.insert(disks.end(), more.begin(), more.end());
    }
    scene_.reset();
    scene_ = std::make_unique<FitScene>(std::move(disks), executor_);
    tiles_ = std::move(tiles);
  }
  return scene_.get();
}

void CityAlignment::find_motion(Group& group) {
  if (group.rays.ends.size() < kMinHits) return;
  const FitScene* const scene = scene_around(group.rays);
  if (scene == nullptr) return;
  const FitMotion fit = fit_motion(*scene, group.rays, group.rays.middle(), executor_);
  const double share = static_cast<double>(fit.hits) / static_cast<double>(group.rays.ends.size());
  if (fit.hits < kMinHits || share < kMinHitShare) return;
  // The same about the world's zero.
  const Vec3d origin = manifest_.origin;
  group.motion = {fit.motion.rotation,
                  fit.motion.translation + origin - fit.motion.rotation * origin};
}

/// What a scan needs: by the groups around its time that have a motion, or the nearest one.
std::optional<PoseCorrection> CityAlignment::correction_of(const TimedPose& pose,
                                                           std::span<const Group> drive) const {
  const Group* before = nullptr;
  const Group* behind = nullptr;
  for (const Group& group : drive) {
    if (!group.motion) continue;
    if (group.time_s <= pose.time_s) before = &group;
    if (group.time_s > pose.time_s && behind == nullptr) behind = &group;
  }
  if (before == nullptr && behind == nullptr)
    return last_ ? std::optional(correction_at(pose, *last_)) : std::nullopt;
  if (before == nullptr) return correction_at(pose, *behind->motion);
  if (behind == nullptr) return correction_at(pose, *before->motion);
  return blended(correction_at(pose, *before->motion), correction_at(pose, *behind->motion),
                 (pose.time_s - before->time_s) / (behind->time_s - before->time_s));
}

void CityAlignment::lay_on(PointCloud& cloud) {
  if (missing_for_calibration(cloud) != nullptr) return;
  std::vector<Group> groups = groups_in(cloud);
  for (Group& group : groups) {
    executor_.check_interruption();
    find_motion(group);
    group.rays = {};
  }
  Calibration found;
  for (std::size_t begin = 0; begin < groups.size();) {
    std::size_t end = begin + 1;
    while (end < groups.size() && groups[end].time_s > groups[end - 1].time_s) ++end;
    const std::span<const Group> drive = std::span(groups).subspan(begin, end - begin);
    if (begin > 0) last_.reset();  // another drive
    for (std::size_t scan = drive.front().first; scan < drive.back().end; ++scan) {
      const TimedPose& pose = cloud.scan_poses[scan];
      const auto correction = correction_of(pose, drive);
      found.poses.push_back(correction ? *correction : correction_at(pose, RigidTransform{}));
    }
    for (const Group& group : drive) count(group, cloud.scan_poses[group.first]);
    begin = end;
  }
  if (!apply(found, cloud, executor_))
    throw std::logic_error("CityAlignment: corrections of other scans");
  corrections_.insert(corrections_.end(), found.poses.begin(), found.poses.end());
}

void CityAlignment::count(const Group& group, const TimedPose& pose) {
  ++groups_;
  if (!group.motion) return;
  last_ = group.motion;
  shifts_m_.push_back(length(correction_at(pose, *group.motion).shift_m));
}

Calibration CityAlignment::behind(const Calibration& applied) const {
  Calibration both = applied;
  if (applied.poses.empty() && applied.mount.empty()) {
    both.poses = corrections_;
    return both;
  }
  for (PoseCorrection& pose : both.poses) {
    const RigidTransform first = pose.corrected_from_given();
    const Vec3d corrected = first * pose.position;
    for (const PoseCorrection& own : corrections_) {
      if (own.time_s != pose.time_s || length(own.position - corrected) > kSamePlace_m) continue;
      const RigidTransform motion = own.corrected_from_given() * first;
      pose.rotation_rad = rotation_vector(motion.rotation);
      pose.shift_m = motion * pose.position - pose.position;
      break;
    }
  }
  return both;
}

AlignmentReport CityAlignment::report() const {
  AlignmentReport report = {groups_, shifts_m_.size(), 0, 0};
  for (const double shift_m : shifts_m_)
    report.largest_shift_m = std::max(report.largest_shift_m, shift_m);
  std::vector<double> shifts_m = shifts_m_;
  if (!shifts_m.empty()) report.median_shift_m = upper_median_of(shifts_m);
  return report;
}

Json to_json(const AlignmentReport& report) {
  return {{"groups", report.groups},
          {"aligned", report.aligned},
          {"largest_shift_m", report.largest_shift_m},
          {"median_shift_m", report.median_shift_m}};
}

}  // namespace adasplats
