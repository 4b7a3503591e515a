// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/open_drive.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/data_tree.h"
#include "adasplats/cloud/load/file_scan.h"
#include "adasplats/cloud/load/frame_evidence.h"
#include "adasplats/cloud/load/nuscenes_drive.h"
#include "adasplats/cloud/load/packet_drive.h"
#include "adasplats/cloud/load/recording_drive.h"
#include "adasplats/cloud/load/scan_stamps.h"
#include "adasplats/cloud/load/sensor_drive.h"
#include "adasplats/cloud/load/world_drive.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/core/error.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

/// Throws data if a file was measured outside the track.
void require_track_of(const SensorFrames& frames, const Track& track,
                      const std::filesystem::path& trajectory) {
  for (std::size_t k = 0; k < frames.files.size(); ++k) {
    const TimeSpan span = frames.spans_s[k];
    if (track.covers(span)) continue;
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(),
                  ": its points cover %.3f to %.3f s, but the trajectory %.3f to %.3f s%s; the "
                  "clocks differ (give `time_offset`), or the trajectory belongs to another drive",
                  span.first, span.last, track.measured_s.first, track.measured_s.last,
                  is_in_gap(track.gaps, span) ? ", with a gap there" : "");
    throw Error(ErrorKind::data,
                frames.files[k].string() + text.data() + " (" + trajectory.string() + ")");
  }
}

/// Whether the times of the matched poses agree with those of the files' points.
bool are_of_the_points(const SensorFrames& frames, double apart_s) {
  for (std::size_t k = 0; k < frames.spans_s.size(); ++k) {
    const double time_s = frames.poses.of_scans[k].time_s;
    if (time_s < frames.spans_s[k].first - apart_s || time_s > frames.spans_s[k].last + apart_s)
      return false;
  }
  return true;
}

/// The files with their poses and the meaning of their times; nothing if they have no poses.
std::optional<SensorFrames> sensor_frames_of(const DriveInput& drive,
                                             std::vector<std::filesystem::path> files,
                                             const Executor& executor, ProgressSink& progress) {
  SensorFrames frames;
  const Trajectory given = read_trajectory(drive.trajectory);
  std::optional<Track> track;
  if (has_times(drive.trajectory)) track = track_of(given);
  const TimeSpan covered = track ? track->covered_s() : TimeSpan{};
  const TimeSpan* const covered_s = track ? &covered : nullptr;
  const double offset_s = drive.time_offset_s.value_or(0);
  const TimeSpan first_s = read_file_scan(files.front()).time_span();
  frames.times = files.size() == 1
                     ? meaning_of_times(first_s, covered_s, offset_s)
                     : meaning_of_times(first_s, read_file_scan(files.back()).time_span(),
                                        covered_s, offset_s);
  auto poses = poses_of_files(files, drive.trajectory, drive.scan_times, drive.time_offset_s);
  const bool is_absolute = frames.times.kind == PointTimes::Kind::absolute && frames.times.fits;
  if (!poses && !(is_absolute && track)) return std::nullopt;
  frames.files = std::move(files);
  if (poses) frames.poses = std::move(*poses);
  const RigidTransform mount = drive.given_mount().value_or(MountSettings{}).transform();
  if (is_absolute && track) {
    frames.spans_s = spans_of_scans(frames, executor, progress);
    require_track_of(frames, *track, drive.trajectory);
    if (frames.poses.of_scans.empty() || !are_of_the_points(frames, pose_distance_s(given))) {
      frames.poses_are_matched = false;
      frames.poses = {{}, track->poses, "at the middles of the points' times", true};
      for (const TimeSpan span : frames.spans_s) {
        const double middle_s = 0.5 * (span.first + span.last);
        frames.poses.of_scans.push_back({middle_s, interpolate(track->poses, middle_s)});
      }
    }
  }
  frames.poses.of_scans = mounted(std::move(frames.poses.of_scans), mount);
  frames.poses.track = mounted(std::move(frames.poses.track), mount);
  return frames;
}

}  // namespace

bool is_self_contained_drive(const std::filesystem::path& path) {
  return is_recording(path) || is_capture(path) || data_tree_of(path) != nullptr;
}

bool has_timed_frames(const std::filesystem::path& folder) {
  const auto files = scan_files(folder);
  if (files.size() < 2) return false;
  constexpr double kLongestScan_s = 1;
  const FileScan first = read_file_scan(files.front());
  if (first.times.empty()) return false;
  const auto [begin, end] = std::ranges::minmax(first.times);
  return !(end - begin > kLongestScan_s);
}

namespace {

/// The coordinate system of files in world coordinates. Errors: those of SharedCrs.
Crs crs_of_files(const std::vector<std::filesystem::path>& files, ProgressSink& progress) {
  SharedCrs crs;
  for (const std::filesystem::path& file : files) crs.add(file, read_crs(file));
  if (const std::string warning = crs.warning(); !warning.empty()) progress.warn(warning);
  return crs.crs();
}

/// Whether a file is small enough for one scan: half a million points of 64 bytes. Larger files
/// are not read twice.
bool can_be_scan(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxBytesOfScan = std::uintmax_t{1} << 25;
  std::error_code problem;
  const std::uintmax_t bytes = std::filesystem::file_size(file, problem);
  return !problem && bytes <= kMaxBytesOfScan;
}

/// The frame of a single file: by its columns, else as find_frame().
FrameVerdict frame_of_single(const SensorFrames& frames, const Executor& executor) {
  ProgressSink silent;
  const CloudPart part = read_file_part(frames.files.front(), {}, silent);
  if (!part.world_sensors.empty()) return {PointsIn::world, "it has sensor positions"};
  const bool looks_like_scan = part.sensor_frame && part.sensor_frame->by_points;
  if (part.sensor_frame && !looks_like_scan) return {PointsIn::sensor, part.sensor_frame->because};
  FrameVerdict verdict{PointsIn::found, "a single pose is no evidence"};
  if (!frames.poses.by_order) verdict = find_frame(frames, executor);
  if (verdict.points_in != PointsIn::found || !looks_like_scan) return verdict;
  // World points measured from near the origin look like a scan from there, too.
  const RigidTransform& pose = frames.poses.of_scans.front().world_from_sensor;
  std::vector<Vec3d> from_pose = part.world_positions;
  for (Vec3d& p : from_pose) p = pose.inverse() * p;
  constexpr double kSame_m = 0.05;
  if (length(pose.translation) > kSame_m && scan_pattern_of(from_pose, executor)) return verdict;
  return {PointsIn::sensor, part.sensor_frame->because};
}

/// Opens files with points in world coordinates.
std::optional<KittiSequence> open_as_world(const DriveInput& drive,
                                           const std::vector<std::filesystem::path>& files,
                                           const Executor& executor, ProgressSink& progress) {
  // With a stated mount the sensor need not be recognised.
  if (drive.given_mount() || !has_timed_frames(drive.folder)) return std::nullopt;
  WorldFrames frames;
  frames.files = files;
  frames.vehicle = read_trajectory(drive.trajectory);
  for (TimedPose& pose : frames.vehicle) pose.time_s -= drive.time_offset_s.value_or(0);
  frames.poses_file = drive.trajectory;
  auto sequence = open_world_frames(drive, frames, executor, progress);
  if (sequence) sequence->facts.crs = crs_of_files(files, progress);
  return sequence;
}

/// Opens a folder of files, one per scan, or a file that is one.
std::optional<KittiSequence> open_files(const DriveInput& drive, const Executor& executor,
                                        ProgressSink& progress) {
  const std::vector<std::filesystem::path> files = scan_files(drive.folder);
  const bool is_single = files.size() == 1 && drive.points_in == PointsIn::found;
  if (is_single && !can_be_scan(files.front())) return std::nullopt;
  if (files.size() < 2 && !is_single && drive.points_in != PointsIn::sensor) return std::nullopt;
  if (drive.points_in == PointsIn::world) {
    auto sequence = open_as_world(drive, files, executor, progress);
    if (sequence) {
      sequence->facts.points_in = "world (as stated)";
      report_drive(*sequence, progress);
    }
    return sequence;
  }
  std::optional<SensorFrames> frames;
  if (!files.empty()) frames = sensor_frames_of(drive, files, executor, progress);
  FrameVerdict verdict{PointsIn::sensor, "as stated"};
  if (drive.points_in == PointsIn::sensor) {
    if (!frames)
      throw Error(
          ErrorKind::data,
          drive.folder.string() +
              ": the poses of its scans are undetermined: " + std::to_string(files.size()) +
              " point files, " + std::to_string(read_trajectory(drive.trajectory).size()) +
              " poses in " + drive.trajectory.string() +
              ", and neither the file names nor times of points match them; give `scan_times`");
  } else {
    if (is_single && !(frames && frames->times.fits)) return std::nullopt;
    // This reports what is wrong with the times.
    if (!frames) return open_as_world(drive, files, executor, progress);
    progress.begin_step("frame of the points", 0);
    verdict = is_single ? frame_of_single(*frames, executor) : find_frame(*frames, executor);
    progress.end_step();
  }
  if (verdict.points_in == PointsIn::sensor)
    return open_sensor_frames(drive, *frames, verdict.because, executor, progress);
  // A file that is not shown to be a scan is a cloud in world coordinates.
  if (is_single) return std::nullopt;
  if (verdict.points_in == PointsIn::found)
    throw Error(ErrorKind::data, drive.folder.string() +
                                     ": cannot determine whether its points are in the sensor "
                                     "frame or in world coordinates (" +
                                     verdict.because +
                                     "); check the units, axes and clock of the poses, or set "
                                     "`points_in` to sensor or world");
  auto sequence = open_as_world(drive, files, executor, progress);
  if (sequence) {
    sequence->facts.points_in = "world (" + verdict.because + ")";
    report_drive(*sequence, progress);
  }
  return sequence;
}

}  // namespace

std::optional<KittiSequence> open_drive(const DriveInput& drive, const Executor& executor,
                                        ProgressSink& progress) {
  if (!drive.scene.empty() && !is_nuscenes_root(drive.folder))
    throw Error(ErrorKind::usage,
                drive.folder.string() + ": is not a nuScenes data root, which `scene` needs");
  if (is_recording(drive.folder)) {
    const RecordingSurvey survey = survey_recording(drive.folder, progress);
    if (!is_read_by_packets(survey, drive))
      return open_recording_drive(drive, survey, executor, progress);
    return open_packet_drive(drive, survey_packets(survey, drive, progress), executor, progress);
  }
  if (const DataTree* const tree = data_tree_of(drive.folder))
    return open_data_tree(*tree, drive, executor, progress);
  if (is_capture(drive.folder))
    return open_packet_drive(
        drive,
        survey_packets(drive.folder, decoder_of_capture(drive.folder, drive.packets_of), progress),
        executor, progress);
  return open_files(drive, executor, progress);
}

}  // namespace adasplats
