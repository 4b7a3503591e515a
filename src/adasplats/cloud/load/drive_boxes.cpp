// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/drive_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "adasplats/cloud/load/box_files.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr int kSteps = 20;  // on either side of the given times
constexpr double kStep_s = 0.01;
constexpr double kFast_mps = 3;
using Counts = std::array<std::size_t, 2 * kSteps + 1>;

/// The place of a step from -kSteps to kSteps in Counts.
std::size_t place_of(int step) {
  const int place = step + kSteps;
  return static_cast<std::size_t>(place);
}

double speed_at(const BoxTrack& track, double time_s) {
  constexpr double kAround_s = 0.1;
  const Vec3d way = track.at(time_s + kAround_s).middle - track.at(time_s - kAround_s).middle;
  return length(way) / (2 * kAround_s);
}

/// Whether a point is in a box, above what may be ground.
bool is_inside(const TimedBox& box, Vec3d point) {
  constexpr double kGround_m = 0.25;
  return box.contains(point, 0, kGround_m);
}

/// Counts points in boxes of fast objects, by how much later the boxes are: with the times of the
/// points, and with those of the scans.
class ClockCounter {
 public:
  ClockCounter(const MovingBoxes& boxes, const KittiSequence& drive)
      : boxes_(boxes), drive_(drive), is_counted_(boxes.tracks().size()) {}

  void add(std::size_t index) {
    const TimedPose& pose = drive_.trajectory[index];
    std::vector<std::size_t> fast;
    for (std::size_t k = 0; k < boxes_.tracks().size(); ++k) {
      const std::vector<TimedBox>& boxes = boxes_.tracks()[k].boxes;
      if (pose.time_s > boxes.front().time_s && pose.time_s < boxes.back().time_s &&
          speed_at(boxes_.tracks()[k], pose.time_s) > kFast_mps)
        fast.push_back(k);
    }
    if (fast.empty()) return;
    const std::optional<KittiScan> scan = try_kitti_points(drive_, index);
    for (const std::size_t k : fast)
      if (scan) add(pose, *scan, k);
  }

  const Counts& of_points() const { return of_points_; }
  const Counts& of_scans() const { return of_scans_; }
  std::size_t objects() const {
    return static_cast<std::size_t>(std::ranges::count(is_counted_, true));
  }

 private:
  void add(const TimedPose& pose, const KittiScan& scan, std::size_t track_number) {
    const BoxTrack& track = boxes_.tracks()[track_number];
    const TimedBox now = track.at(pose.time_s);
    const double reach_m =
        length(now.half_size) + 2 * kSteps * kStep_s * speed_at(track, pose.time_s);
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const Vec3d point = pose.world_from_sensor * vec_cast<double>(scan.positions[i]);
      if (!(length(point - now.middle) <= reach_m)) continue;
      const double time_s = time_of_point(scan, pose, i);
      for (int step = -kSteps; step <= kSteps; ++step) {
        const std::size_t place = place_of(step);
        const bool is_in = is_inside(track.at(time_s + step * kStep_s), point);
        of_points_[place] += is_in ? 1 : 0;
        of_scans_[place] += is_inside(track.at(pose.time_s + step * kStep_s), point) ? 1 : 0;
        if (is_in) is_counted_[track_number] = true;
      }
    }
  }

  const MovingBoxes& boxes_;
  const KittiSequence& drive_;
  Counts of_points_{}, of_scans_{};
  std::vector<bool> is_counted_;
};

/// The times of boxes at the stamps of scans become those of their poses.
BoxContent at_poses(BoxContent content, std::span<const double> stamps_s, const Trajectory& poses) {
  constexpr double kSame_s = 1e-4;
  for (BoxTrack& track : content.moving) {
    for (TimedBox& box : track.boxes) {
      const auto stamp = std::ranges::min_element(
          stamps_s, {}, [&](double stamp_s) { return std::fabs(stamp_s - box.time_s); });
      const auto k = static_cast<std::size_t>(stamp - stamps_s.begin());
      if (std::fabs(*stamp - box.time_s) < kSame_s) box.time_s = poses[k].time_s;
    }
  }
  return content;
}

/// Whether a box is within 500 m of the path, which is farther than any LiDAR measures.
bool is_near_path(const BoxContent& content, const Trajectory& poses) {
  constexpr double kFarthest_m = 500;
  constexpr std::size_t kPoses = 200;  // spread over the path
  const std::size_t step = std::max<std::size_t>(1, poses.size() / kPoses);
  const auto is_near = [&](const TimedBox& box) {
    for (std::size_t k = 0; k < poses.size(); k += step)
      if (length(box.middle - poses[k].world_from_sensor.translation) < kFarthest_m) return true;
    return false;
  };
  for (const std::vector<BoxTrack>* const tracks : {&content.moving, &content.at_rest})
    for (const BoxTrack& track : *tracks)
      if (std::ranges::any_of(track.boxes, is_near)) return true;
  return false;
}

std::string clock_text(const std::filesystem::path& file, const BoxClock& clock) {
  std::array<char, 200> text{};
  std::snprintf(
      text.data(), text.size(),
      ": its clock is %.2f s %s%s; box times were corrected (%zu instead of %zu points are "
      "in boxes of fast objects)",
      std::fabs(clock.later_s), clock.later_s < 0 ? "behind" : "ahead",
      clock.are_of_scans ? ", with one box per scan" : "", clock.points, clock.as_given);
  return file.string() + text.data();
}

}  // namespace

std::optional<BoxClock> fit_box_clock(const MovingBoxes& boxes, const KittiSequence& drive,
                                      const Executor& executor) {
  constexpr std::size_t kScans = 16, kMinPoints = 500, kMinObjects = 3;
  constexpr double kMore = 1.02;
  ClockCounter counter(boxes, drive);
  const std::size_t count = std::min(kScans, drive.scans.size());
  for (std::size_t k = 0; k < count; ++k) {
    executor.check_interruption();
    counter.add((2 * k + 1) * drive.scans.size() / (2 * count));
  }
  const Counts& given = boxes.are_of_scans() ? counter.of_scans() : counter.of_points();
  BoxClock best{0, boxes.are_of_scans(), given[kSteps], given[kSteps]};
  for (int distance = 0; distance <= kSteps; ++distance) {
    for (const int step : {distance, -distance}) {
      const std::size_t place = place_of(step);
      for (const bool are_of_scans : {boxes.are_of_scans(), !boxes.are_of_scans()}) {
        const std::size_t points = (are_of_scans ? counter.of_scans() : counter.of_points())[place];
        if (points > best.points) best = {step * kStep_s, are_of_scans, points, best.as_given};
      }
    }
  }
  const bool is_clear =
      best.points >= kMinPoints && counter.objects() >= kMinObjects &&
      static_cast<double>(best.points) > kMore * static_cast<double>(best.as_given);
  return is_clear ? std::optional(best) : std::nullopt;
}

void add_boxes(const DriveSettings& settings, std::span<const double> stamps_s,
               KittiSequence& drive, const Executor& executor, ProgressSink& progress) {
  if (settings.found_boxes) drive.boxes = settings.found_boxes;
  if (settings.found_boxes || settings.boxes.empty() || drive.scans.empty()) return;
  if (!drive.has_times)
    throw Error(ErrorKind::data, settings.boxes.string() +
                                     ": its boxes have times, but the scans of " +
                                     drive.folder.string() + " have none");
  BoxContent content = read_box_file(
      settings.boxes, {drive.scans, drive.trajectory, settings.topic, settings.scene});
  if (content.are_of_scans && !stamps_s.empty())
    content = at_poses(std::move(content), stamps_s, drive.trajectory);
  if (content.twins > 0)
    progress.warn(settings.boxes.string() + ": " + std::to_string(content.twins) +
                  " objects are in the boxes of others at the same times; they were left out");
  if (!is_near_path(content, drive.trajectory))
    throw Error(ErrorKind::data, settings.boxes.string() +
                                     ": no box is within 500 m of the sensor's path; boxes must be "
                                     "in the frame of the poses");
  constexpr double kSweep_s = 0.1;
  MovingBoxes boxes(std::move(content));
  if (!boxes.overlaps(drive.trajectory.front().time_s - kSweep_s,
                      drive.trajectory.back().time_s + kSweep_s))
    throw Error(ErrorKind::data, settings.boxes.string() +
                                     ": no box has a time within the scans; the clocks differ, or "
                                     "the boxes belong to another drive");
  if (const std::optional<BoxClock> clock = fit_box_clock(boxes, drive, executor)) {
    // The best offset may be beyond the search.
    if (std::fabs(clock->later_s) > (kSteps - 0.5) * kStep_s)
      throw Error(ErrorKind::data, settings.boxes.string() +
                                       ": its clock differs from that of the points by 0.2 s or "
                                       "more; give boxes in the clock of the scans");
    progress.warn(clock_text(settings.boxes, *clock));
    boxes.correct_times(clock->later_s, clock->are_of_scans);
  }
  drive.boxes = std::make_shared<const MovingBoxes>(std::move(boxes));
}

}  // namespace adasplats
