// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/open_drive.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
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

/// Why files are scans in the sensor frame rather than tiles of a map, by the first and the last:
/// by their columns, or because both have points on all sides of the origin, and points or
/// poses have no times. Empty: they may be tiles.
std::string evidence_of_scans(const std::vector<std::filesystem::path>& files,
                              const std::filesystem::path& trajectory) {
  std::string because;
  for (const std::filesystem::path& file : {files.front(), files.back()}) {
    if (!can_be_scan(file)) return {};
    ProgressSink silent;
    const CloudPart part = read_file_part(file, {}, silent);
    if (!part.world_sensors.empty()) return {};
    if (part.sensor_frame) return file.string() + ": " + part.sensor_frame->because;
    if (!part.times_s.empty() && has_times(trajectory)) return {};
    constexpr double kMaxRange_m = 500;
    Vec3d low, high;
    for (const Vec3d p : part.world_positions) {
      if (!is_finite(p)) continue;
      low = min(low, p);
      high = max(high, p);
    }
    const bool is_around = low.x < 0 && low.y < 0 && high.x > 0 && high.y > 0;
    if (!is_around || length(low) > kMaxRange_m || length(high) > kMaxRange_m) return {};
    because = "points on all sides of the origin";
  }
  return because;
}

/// Neither times nor names nor the number of poses match files and poses.
Error undetermined_poses(const DriveInput& drive, const std::vector<std::filesystem::path>& files,
                         const std::string& because) {
  const bool timed = has_times(drive.trajectory);
  return {ErrorKind::data,
          drive.folder.string() +
              ": the poses of its scans are undetermined: " + std::to_string(files.size()) +
              " point files, " + std::to_string(read_trajectory(drive.trajectory).size()) +
              (timed ? " poses in " : " poses without times in ") + drive.trajectory.string() +
              ", and neither the file names nor times of points match them; give " +
              (timed ? "`scan_times`"
                     : "one pose per file, or poses with times (a column time, or a times.txt next "
                       "to KITTI's rows) in the clock of the points or with `scan_times`") +
              (because.empty() ? ""
                               : ". The points are assumed to be in the sensor frame (" + because +
                                     "); if they are in world coordinates, set `points_in` to "
                                     "world")};
}

/// Opens files with points in world coordinates.
std::optional<KittiSequence> open_as_world(const DriveInput& drive,
                                           const std::vector<std::filesystem::path>& files,
                                           const Executor& executor, ProgressSink& progress) {
  // With a stated mount the sensor need not be recognised.
  const std::optional<MountSettings> mount = drive.given_mount();
  if ((mount && !drive.is_rig_sensor) || !has_timed_frames(drive.folder)) return std::nullopt;
  if (!has_times(drive.trajectory))
    throw Error(ErrorKind::data,
                drive.trajectory.string() + ": its poses have no times, but the points of " +
                    drive.folder.string() +
                    " do; give poses with times in the clock of the points (a column time, or a "
                    "times.txt next to KITTI's rows)");
  WorldFrames frames;
  frames.files = files;
  frames.vehicle = read_trajectory(drive.trajectory);
  for (TimedPose& pose : frames.vehicle) pose.time_s -= drive.time_offset_s.value_or(0);
  frames.poses_file = drive.trajectory;
  frames.is_stated = mount.has_value();
  if (mount) frames.own_mount = mount->transform();
  auto sequence = open_world_frames(drive, frames, executor, progress);
  if (sequence) sequence->facts.crs = crs_of_files(files, progress);
  return sequence;
}

/// The files of scans of a folder; of a SemanticKITTI sequence without poses those in `velodyne`.
std::vector<std::filesystem::path> files_of_drive(const std::filesystem::path& folder) {
  return scan_files(lacks_poses(folder) ? folder / "velodyne" : folder);
}

/// Scans with labels of SemanticKITTI.
class LabelledScans final : public ScanSource {
 public:
  LabelledScans(std::shared_ptr<const ScanSource> scans, std::filesystem::path labels)
      : scans_(std::move(scans)), labels_(std::move(labels)) {}

  FileScan read(const std::filesystem::path& scan) const override {
    FileScan read = scans_->read(scan);
    const std::filesystem::path file = labels_of(scan);
    const std::vector<std::uint32_t> labels = read_kitti_labels(file);
    if (labels.size() != read.size())
      throw Error(ErrorKind::data, file.string() + ": " + std::to_string(labels.size()) +
                                       " labels, but the scan has " + std::to_string(read.size()) +
                                       " points; expected one per point");
    read.classes.clear();
    read.instances.clear();
    for (const std::uint32_t label : labels) {
      read.classes.push_back(static_cast<std::uint16_t>(label & 0xffffU));
      read.instances.push_back(static_cast<std::uint16_t>(label >> 16U));
    }
    return read;
  }
  std::filesystem::path labels_of(const std::filesystem::path& scan) const {
    return labels_ / (scan.stem().string() + ".label");
  }

 private:
  std::shared_ptr<const ScanSource> scans_;
  std::filesystem::path labels_;
};

/// Adds the labels of scans in a folder `velodyne`, if `labels` next to it has any, as in
/// SemanticKITTI. Errors: data (a scan without labels).
void add_labels_of_sequence(SensorFrames& frames) {
  const std::filesystem::path folder = frames.files.front().parent_path();
  const std::filesystem::path labels = folder.parent_path() / "labels";
  if (std::filesystem::absolute(folder).filename() != "velodyne" ||
      files_by_name(labels, ".label").empty())
    return;
  const auto source = std::make_shared<const LabelledScans>(frames.source, labels);
  for (const std::filesystem::path& scan : frames.files)
    if (!std::filesystem::exists(source->labels_of(scan)))
      throw Error(ErrorKind::data,
                  source->labels_of(scan).string() +
                      ": is missing; other scans have labels, expected one file per scan or none");
  frames.source = source;
  frames.labels = "of " + labels.string();
}

/// Opens a folder of files, one per scan, or a file that is one.
std::optional<KittiSequence> open_files(const DriveInput& drive, const Executor& executor,
                                        ProgressSink& progress) {
  const std::vector<std::filesystem::path> files = files_of_drive(drive.folder);
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
    if (!frames) throw undetermined_poses(drive, files, "");
  } else {
    if (is_single && !(frames && frames->times.fits)) return std::nullopt;
    if (!frames)
      if (const std::string because = evidence_of_scans(files, drive.trajectory); !because.empty())
        throw undetermined_poses(drive, files, because);
    // This reports what is wrong with the times.
    if (!frames) return open_as_world(drive, files, executor, progress);
    progress.begin_step("frame of the points", 0);
    verdict = is_single ? frame_of_single(*frames, executor) : find_frame(*frames, executor);
    progress.end_step();
  }
  if (verdict.points_in == PointsIn::sensor) {
    if (drive.with_classes) add_labels_of_sequence(*frames);
    return open_sensor_frames(drive, *frames, verdict.because, executor, progress);
  }
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
    if (!is_read_by_packets(survey, drive, drive.is_rig_sensor))
      return open_recording_drive(drive, survey, executor, progress);
    return open_packet_drive(drive, survey_packets(survey, drive, progress), executor, progress);
  }
  if (const DataTree* const tree = data_tree_of(drive.folder))
    return open_data_tree(*tree, drive, executor, progress);
  if (is_capture(drive.folder))
    return open_packet_drive(
        drive,
        survey_packets(drive.folder, decoder_of_capture(drive.folder, drive.packet_sensor),
                       progress),
        executor, progress);
  return open_files(drive, executor, progress);
}

}  // namespace adasplats
