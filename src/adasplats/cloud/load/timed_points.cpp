// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/timed_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "adasplats/cloud/origins/clock_finder.h"
#include "adasplats/cloud/poses/mount.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kScan_s = 0.1;
constexpr std::size_t kMostScans = 10'000;  // poses of their own that a calibration can hold

bool has_own_times(const CloudPart& part) {
  return !part.is_sequence && part.size() > 0 && part.times_s.size() == part.size() &&
         part.world_sensors.empty();
}

/// Cuts the times into scans and numbers those that have points.
class ScanNumbers {
 public:
  explicit ScanNumbers(TimeSpan times_s) : begin_s_(times_s.first) {
    const double length_s = times_s.last - times_s.first;
    scan_s_ = std::max(kScan_s, length_s / static_cast<double>(kMostScans - 1));
    used_.resize(static_cast<std::size_t>(length_s / scan_s_) + 1);
  }
  std::uint32_t piece_of(double time_s) const {
    const double piece =
        std::clamp((time_s - begin_s_) / scan_s_, 0.0, static_cast<double>(used_.size() - 1));
    return static_cast<std::uint32_t>(piece);
  }
  void use(std::uint32_t piece) { used_[piece] = 1; }
  /// Numbers of pieces, from `first` on, and the poses of the used ones in their middles.
  Trajectory number(std::uint32_t first, const Trajectory& track) {
    Trajectory poses;
    for (std::size_t piece = 0; piece < used_.size(); ++piece) {
      if (used_[piece] == 0) continue;
      used_[piece] = first + static_cast<std::uint32_t>(poses.size());
      const double middle_s = begin_s_ + (static_cast<double>(piece) + 0.5) * scan_s_;
      poses.push_back({middle_s, interpolate(track, middle_s)});
    }
    return poses;
  }
  std::uint32_t number_of(std::uint32_t piece) const { return used_[piece]; }
  double scan_s() const { return scan_s_; }

 private:
  double begin_s_, scan_s_ = kScan_s;
  std::vector<std::uint32_t> used_;
};

void place(CloudPart& part, const ClockPair& clock, const Trajectory& poses, ScanNumbers& scans,
           const Executor& executor) {
  part.world_sensors.resize(part.size());
  part.cloud.scan_indices.resize(part.size());
  executor.for_chunks(part.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double time_s = clock.in_trajectory(part.times_s[i]);
      part.world_sensors[i] = interpolate(poses, time_s).translation;
      part.cloud.scan_indices[i] = scans.piece_of(time_s);
    }
  });
  for (const std::uint32_t piece : part.cloud.scan_indices) scans.use(piece);
  part.times_s = {};
}

Trajectory sensor_track(const LoadOptions& options) {
  const Trajectory given = read_trajectory(options.trajectory);
  for (const TimedPose& pose : given)
    if (!is_place(pose.world_from_sensor.translation))
      throw Error(ErrorKind::data, options.trajectory.string() + ": a position is beyond 1e12 m");
  const MountSettings mount{options.mount.value_or(Vec3d{}), options.mount_rotation_deg};
  return mounted(given, mount.transform());
}

TimedRecording recording_of(std::span<const CloudPart> parts) {
  TimedRecording recording;
  for (const CloudPart& part : parts)
    if (has_own_times(part))
      recording.add(part.runs.front().file.string(), part.world_positions, part.times_s,
                    part.said_clock);
  return recording;
}

std::uint32_t count_scans(std::span<const CloudPart> parts) {
  std::size_t scans = 0;
  for (const CloudPart& part : parts) scans += part.cloud.scan_poses.size();
  return static_cast<std::uint32_t>(scans);
}

}  // namespace

std::string TimedOrigins::description() const {
  std::array<char, 600> text{};
  std::array<char, 100> sensor{};
  if (is_mounted)
    std::snprintf(sensor.data(), sensor.size(), "the sensor at (%.3f, %.3f, %.3f) m of their frame",
                  mount_m.x, mount_m.y, mount_m.z);
  std::snprintf(
      text.data(), text.size(),
      "origins of %zu points by their times, %.3f to %.3f s, from poses of %.3f to %.3f s "
      "(%s), %s; median range %.1f m; %zu scans of %.3g s",
      points, times_s.first, times_s.last, trajectory_s.first, trajectory_s.last, clock.c_str(),
      is_mounted ? sensor.data() : "taken as the sensor's own since no `mount` is given",
      median_range_m, scans, scan_s);
  return text.data();
}

void require_used(const LoadOptions& options, bool takes_mount, bool takes_offset) {
  const bool mounts = options.mount || !(options.mount_rotation_deg == Vec3d{});
  if ((!mounts || takes_mount) && (!options.time_offset_s || takes_offset)) return;
  throw Error(ErrorKind::usage,
              "`mount`, `mount_rotation` and `time_offset` are for points with times (a column "
              "time, timestamp or gps_time that differs from point to point, and no sensor "
              "positions) and a trajectory that has times; there are none");
}

std::optional<PlacedByTimes> place_by_times(std::span<CloudPart> parts, const LoadOptions& options,
                                            const Executor& executor, ProgressSink& progress) {
  if (options.trajectory.empty() || !has_times(options.trajectory)) return std::nullopt;
  const TimedRecording points = recording_of(parts);
  if (!points.have_times()) return std::nullopt;
  const Trajectory sensor = sensor_track(options);
  progress.begin_step("clocks", 0);
  ClockFinder clocks(points, options.trajectory, sensor, options.time_offset_s, executor);
  const ClockPair clock = clocks.find();
  const Track track = clocks.track(clock);
  clocks.require_no_gaps(clock, track);
  const SweepView seen = clocks.view(clock);
  if (!options.trust_origins) clocks.check(clock, seen, progress);
  progress.end_step();

  PlacedByTimes placed;
  placed.origins = {.points = points.size(),
                    .times_s = clock.in_trajectory(points.span()),
                    .trajectory_s = track.measured_s,
                    .clock = clock.description(),
                    .offset_s = clock.offset_s,
                    .is_mounted = options.mount.has_value(),
                    .mount_m = options.mount.value_or(Vec3d{}),
                    .median_range_m = seen.median_range_m,
                    .share_behind = seen.share_behind};
  ScanNumbers scans(placed.origins.times_s);
  for (CloudPart& part : parts) {
    placed.parts.push_back(has_own_times(part) ? 1 : 0);
    if (placed.parts.back() != 0) place(part, clock, track.poses, scans, executor);
  }
  placed.scan_poses = scans.number(count_scans(parts), track.poses);
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (placed.parts[p] != 0)
      for (std::uint32_t& scan : parts[p].cloud.scan_indices) scan = scans.number_of(scan);
  placed.origins.scans = placed.scan_poses.size();
  placed.origins.scan_s = scans.scan_s();
  progress.warn(points.name() + ": " + placed.origins.description());
  return placed;
}

Trajectory scan_poses_of(std::span<CloudPart> parts, const std::optional<PlacedByTimes>& placed) {
  Trajectory poses;
  bool has_all = true;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Trajectory& own = parts[p].cloud.scan_poses;
    poses.insert(poses.end(), own.begin(), own.end());
    const bool has_poses = !own.empty() || (placed && placed->parts[p] != 0);
    has_all = has_all && (has_poses || parts[p].size() == 0);
    own = {};
  }
  if (placed) poses.insert(poses.end(), placed->scan_poses.begin(), placed->scan_poses.end());
  return has_all ? poses : Trajectory();
}

}  // namespace adasplats
