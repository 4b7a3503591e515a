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
#include "adasplats/cloud/poses/pose_jump.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kScan_s = 0.1;
constexpr std::size_t kMaxScans = 10'000;  // separate poses that a calibration supports

bool has_own_times(const CloudPart& part) {
  return !part.is_sequence && part.size() > 0 && part.times_s.size() == part.size() &&
         part.world_sensors.empty();
}

/// Cuts times into scans: at pauses of half a scan, and between pauses into equal parts of about
/// 0.1 s. Parts of a fixed clock would cut the scans of a recording with pauses, and a sliver of a
/// scan cannot constrain a pose.
class ScanCut {
 public:
  explicit ScanCut(TimeSpan times_s) : begin_s_(times_s.first) {
    constexpr double kMaxBins = 4e7;
    const double length_s = times_s.last - times_s.first;
    bin_s_ = std::max(kScan_s / 100, length_s / kMaxBins);
    is_used_.resize(static_cast<std::size_t>(length_s / bin_s_) + 1);
  }
  void add(double time_s) { is_used_[bin_of(time_s)] = 1; }

  /// Call after all times are added.
  void cut() {
    const auto pause = static_cast<std::size_t>(std::ceil(0.5 * kScan_s / bin_s_));
    std::vector<TimeSpan> runs;
    double measured_s = 0;
    for (std::size_t bin = 0; bin < is_used_.size(); ++bin) {
      if (is_used_[bin] == 0) continue;
      const std::size_t begin = bin;
      std::size_t last = bin;
      for (; bin < is_used_.size() && bin - last < pause; ++bin)
        if (is_used_[bin] != 0) last = bin;
      runs.push_back({begin_s_ + static_cast<double>(begin) * bin_s_,
                      begin_s_ + static_cast<double>(last + 1) * bin_s_});
      measured_s += runs.back().last - runs.back().first;
      --bin;
    }
    is_used_ = {};
    scan_s_ = std::max(kScan_s, measured_s / static_cast<double>(kMaxScans));
    for (const TimeSpan run : runs) {
      const double length_s = run.last - run.first;
      const auto pieces = static_cast<std::size_t>(std::max(1.0, std::round(length_s / scan_s_)));
      const double piece_s = length_s / static_cast<double>(pieces);
      for (std::size_t k = 0; k < pieces; ++k) {
        begins_s_.push_back(run.first + static_cast<double>(k) * piece_s);
        middles_s_.push_back(begins_s_.back() + 0.5 * piece_s);
      }
    }
  }
  std::uint32_t scan_of(double time_s) const {
    const auto behind = std::ranges::upper_bound(begins_s_, time_s) - begins_s_.begin();
    return static_cast<std::uint32_t>(std::max<std::ptrdiff_t>(1, behind) - 1);
  }
  /// The poses at the middles of the scans.
  Trajectory poses(const Trajectory& track) const {
    Trajectory poses;
    for (const double middle_s : middles_s_)
      poses.push_back({middle_s, interpolate(track, middle_s)});
    return poses;
  }
  double scan_s() const { return scan_s_; }

 private:
  std::size_t bin_of(double time_s) const {
    const double bin = (time_s - begin_s_) / bin_s_;
    return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(is_used_.size() - 1)));
  }

  double begin_s_, bin_s_ = 0, scan_s_ = kScan_s;
  std::vector<std::uint8_t> is_used_;
  std::vector<double> begins_s_, middles_s_;
};

void place(CloudPart& part, const ClockPair& clock, const Trajectory& poses, const ScanCut& scans,
           std::uint32_t first_scan, const Executor& executor) {
  part.world_sensors.resize(part.size());
  part.cloud.scan_indices.resize(part.size());
  executor.for_chunks(part.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(part.times_s[i]))
        continue;  // a point without a valid position, dropped later
      const double time_s = clock.in_trajectory(part.times_s[i]);
      part.world_sensors[i] = interpolate(poses, time_s).translation;
      part.cloud.scan_indices[i] = first_scan + scans.scan_of(time_s);
    }
  });
  part.times_s = {};
}

Trajectory sensor_track(const LoadOptions& options) {
  const Trajectory given = read_trajectory(options.trajectory);
  for (const TimedPose& pose : given)
    if (!is_valid_position(pose.world_from_sensor.translation))
      throw Error(ErrorKind::data,
                  options.trajectory.string() + ": a position is beyond 1e12 m; expected metres");
  const MountSettings mount{options.mount.value_or(Vec3d{}), options.mount_rotation_deg};
  return mounted(given, mount.transform());
}

TimedRecording recording_of(std::span<const CloudPart> parts) {
  TimedRecording recording;
  for (const CloudPart& part : parts)
    if (has_own_times(part))
      recording.add(part.runs.front().file.string(), part.world_positions, part.times_s,
                    part.declared_clock);
  return recording;
}

/// Throws data if the sensor jumps between the scans.
void require_steady_track(const std::filesystem::path& trajectory, const Trajectory& scan_poses) {
  const auto jump = find_pose_jump(scan_poses, true);
  if (!jump) return;
  std::array<char, 100> times{};
  std::snprintf(times.data(), times.size(), ": between %.3f and %.3f s",
                scan_poses[jump->later - 1].time_s, scan_poses[jump->later].time_s);
  throw Error(ErrorKind::data,
              trajectory.string() + times.data() + " the poses jump by " + jump->text() +
                  "; check that all poses are of this drive and the times seconds");
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
      "(%s), %s; median range %.1f m; %zu scans of about %.3g s",
      points, times_s.first, times_s.last, trajectory_s.first, trajectory_s.last, clock.c_str(),
      is_mounted ? sensor.data() : "taken as the sensor's own since no `mount` is given",
      median_range_m, scans, scan_s);
  return text.data();
}

void require_options_used(const LoadOptions& options, bool uses_mount, bool uses_offset) {
  const bool mounts = options.mount || !(options.mount_rotation_deg == Vec3d{});
  if ((!mounts || uses_mount) && (!options.time_offset_s || uses_offset)) return;
  throw Error(ErrorKind::usage,
              "`mount`, `mount_rotation` and `time_offset` need points with times (a column time, "
              "timestamp or gps_time that varies, and no sensor positions) and a trajectory with "
              "times; no input has both");
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
  ScanCut scans(placed.origins.times_s);
  for (const CloudPart& part : parts) {
    placed.parts.push_back(has_own_times(part) ? 1 : 0);
    for (std::size_t i = 0; placed.parts.back() != 0 && i < part.size(); ++i)
      if (std::isfinite(part.times_s[i])) scans.add(clock.in_trajectory(part.times_s[i]));
  }
  scans.cut();
  const std::uint32_t first_scan = count_scans(parts);
  for (std::size_t p = 0; p < parts.size(); ++p)
    if (placed.parts[p] != 0) place(parts[p], clock, track.poses, scans, first_scan, executor);
  placed.scan_poses = scans.poses(track.poses);
  require_steady_track(options.trajectory, placed.scan_poses);
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
