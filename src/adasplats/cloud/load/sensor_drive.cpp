// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/load/drive_boxes.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"

namespace adasplats {

namespace {

constexpr std::size_t kSampleScans = 5,
                      kEveryPointOf = 7;  // scans, and points of each, to recognise the sensor
constexpr double kClearly = 1.1;          // ratio of the angles to the cones that is conclusive
constexpr double kNoMotion_m = 0.02;
constexpr double kSeenAt_m = 10;  // a rotation counts as the motion at this range

std::string formatted(const char* format, double a, double b) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), format, a, b);
  return text.data();
}

bool is_nothing(Vec3d p) { return p.x == 0 && p.y == 0 && p.z == 0; }

/// The attributes that do not depend on the frame. A point at the sensor is a missing return.
KittiScan scan_of(FileScan&& file) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  KittiScan scan;
  scan.positions.reserve(file.size());
  for (const Vec3d p : file.positions)
    scan.positions.push_back(is_nothing(p) ? Vec3f{kNone, kNone, kNone} : vec_cast<float>(p));
  scan.intensities = std::move(file.intensities);
  scan.classes = std::move(file.classes);
  scan.instances = std::move(file.instances);
  return scan;
}

class RawReader final : public ScanReader {
 public:
  explicit RawReader(std::shared_ptr<const ScanSource> source) : source_(std::move(source)) {}
  KittiScan read(const std::filesystem::path& file) const override {
    return scan_of(source_->read(file));
  }

 private:
  std::shared_ptr<const ScanSource> source_;
};

class SweepReader final : public ScanReader {
 public:
  SweepReader(const SensorFrames& frames, SweepFinding finding, bool with_classes)
      : source_(frames.source),
        with_classes_(with_classes),
        track_(frames.poses.track),
        times_(frames.times),
        has_times_(frames.times.kind != PointTimes::Kind::none && frames.poses.has_times),
        finding_(std::move(finding)) {
    for (std::size_t k = 0; k < frames.files.size(); ++k)
      poses_[frames.files[k].string()] = finding_.scan_poses[k];
  }

  KittiScan read(const std::filesystem::path& file) const override {
    FileScan points = source_->read(file);
    const std::vector<double> times = std::move(points.times);
    std::vector<std::uint16_t> lasers = std::move(points.lasers);
    const std::vector<Vec3d> given = points.positions;
    KittiScan scan = scan_of(std::move(points));
    if (!with_classes_) scan.classes = {}, scan.instances = {};
    const bool moves = finding_.way != SweepPoints::found;
    if (moves && times.size() != given.size())
      throw Error(
          ErrorKind::data,
          file.string() +
              ": its points have no times, unlike other files; remove the file, or add the column");
    const TimedPose& pose = poses_.at(file.string());
    if (finding_.sensor) scan.lasers = std::move(lasers);
    if (moves || finding_.sensor) add_beams(file, given, times, pose, scan);
    if (has_times_ && times.size() == given.size())
      for (const double time : times) scan.times_s.push_back(times_.time_s(time, pose.time_s));
    return scan;
  }

 private:
  static void require_time(const std::filesystem::path& file, double time, std::size_t i) {
    if (!std::isfinite(time))
      throw Error(ErrorKind::data, file.string() + ": the time of point " + std::to_string(i) +
                                       " (from 0) is not finite");
  }

  void add_beams(const std::filesystem::path& file, const std::vector<Vec3d>& given,
                 const std::vector<double>& times, const TimedPose& pose, KittiScan& scan) const {
    const bool moves = finding_.way != SweepPoints::found;
    const RigidTransform scan_from_world = pose.world_from_sensor.inverse();
    for (std::size_t i = 0; i < given.size(); ++i) {
      RigidTransform scan_from_then;
      if (moves && is_finite(scan.positions[i])) {
        require_time(file, times[i], i);
        scan_from_then =
            scan_from_world * interpolate(track_, times_.time_s(times[i], pose.time_s));
      }
      add_beam(given[i], scan_from_then, i, scan);
    }
  }

  /// The laser of a point in the sensor's frame, and its position there. Known lasers: of packets.
  std::pair<std::uint16_t, Vec3d> laser_of(Vec3d in_sensor, std::uint16_t known) const {
    const SensorCones& cones = finding_.sensor->cones;
    if (known == kNoLaser && cones.cones.empty()) return {kNoLaser, {}};
    const std::uint16_t laser = known == kNoLaser ? cones.nearest(in_sensor).first : known;
    // A mirror's beams have no cones.
    if (laser >= cones.cones.size()) return {laser, {}};
    return {laser, cones.origin_of(laser, in_sensor)};
  }

  void add_beam(Vec3d given, const RigidTransform& scan_from_then, std::size_t i,
                KittiScan& scan) const {
    const RigidTransform mount =
        finding_.sensor ? finding_.sensor->vehicle_from_sensor : RigidTransform{};
    const bool is_raw = finding_.way == SweepPoints::measured;
    const Vec3d then = is_raw ? given : scan_from_then.inverse() * given;
    if (is_raw && is_finite(scan.positions[i]))
      scan.positions[i] = vec_cast<float>(scan_from_then * given);
    Vec3d origin;  // in the sensor frame
    std::uint16_t laser = kNoLaser;
    const bool is_known = i < scan.lasers.size();
    if (finding_.sensor && is_finite(scan.positions[i]))
      std::tie(laser, origin) =
          laser_of(mount.inverse() * then, is_known ? scan.lasers[i] : kNoLaser);
    scan.origins.push_back(vec_cast<float>(scan_from_then * (mount * origin)));
    if (!is_known) scan.lasers.push_back(laser);
  }

  std::shared_ptr<const ScanSource> source_;
  bool with_classes_;
  std::map<std::string, TimedPose> poses_;
  Trajectory track_;
  PointTimes times_;
  bool has_times_;  ///< in the clock of the poses
  SweepFinding finding_;
};

/// One hypothesis for the state of the points.
struct Way {
  SweepPoints points;
  Trajectory scan_poses;
  const char* frame;  ///< in words
};

/// Poses of the track at a fraction of each file's time span.
Trajectory poses_within(const SensorFrames& frames, double part) {
  Trajectory poses;
  for (const TimeSpan span : frames.spans_s) {
    const double time_s = span.first + part * (span.last - span.first);
    poses.push_back({time_s, interpolate(frames.poses.track, time_s)});
  }
  return poses;
}

std::vector<Way> possible_ways(const SensorFrames& frames, SweepPoints stated) {
  std::vector<Way> ways;
  const bool timed = frames.times.kind != PointTimes::Kind::none && frames.poses.has_times &&
                     !frames.poses.track.empty();
  if (!timed) return {{SweepPoints::found, frames.poses.of_scans, ""}};
  if (stated != SweepPoints::compensated)
    ways.push_back({SweepPoints::measured, frames.poses.of_scans, ""});
  if (stated == SweepPoints::measured) return ways;
  if (frames.poses_are_matched)
    ways.push_back({SweepPoints::compensated, frames.poses.of_scans, "the pose of the scan"});
  if (frames.times.kind != PointTimes::Kind::absolute) return ways;
  ways.push_back({SweepPoints::compensated, poses_within(frames, 0.5), "the middle of its times"});
  ways.push_back({SweepPoints::compensated, poses_within(frames, 0), "its first time"});
  ways.push_back({SweepPoints::compensated, poses_within(frames, 1), "its last time"});
  return ways;
}

/// Some scans of a drive, in memory.
class Sample {
 public:
  explicit Sample(const SensorFrames& frames) : frames_(frames) {
    const std::size_t count = std::min(kSampleScans, frames.files.size());
    for (std::size_t k = 0; k < count; ++k) {
      indices_.push_back((2 * k + 1) * frames.files.size() / (2 * count));
      scans_.push_back(frames.source->read(frames.files[indices_.back()]));
    }
  }

  /// The points in the frame of the sensor at their own times.
  std::vector<Vec3d> as_cast(const Way& way) const {
    std::vector<Vec3d> points;
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const TimedPose& pose = way.scan_poses[indices_[k]];
      for (std::size_t i = 0; i < scans_[k].size(); i += kEveryPointOf) {
        const Vec3d p = scans_[k].positions[i];
        if (!is_valid_position(p)) continue;
        const auto time_s = time_of(k, i, pose.time_s);
        const bool undo = way.points == SweepPoints::compensated && time_s;
        points.push_back(undo ? interpolate(frames_.poses.track, *time_s).inverse() *
                                    (pose.world_from_sensor * p)
                              : p);
      }
    }
    return points;
  }

  /// Maximum motion of the frame within a scan.
  double moved_m() const {
    double max_m = 0;
    for (std::size_t k = 0; k < scans_.size(); ++k) {
      const TimeSpan span = scans_[k].time_span();
      const double scan_s = frames_.poses.of_scans[indices_[k]].time_s;
      const auto at = [&](double time) {
        return interpolate(frames_.poses.track, frames_.times.time_s(time, scan_s));
      };
      const RigidTransform way = at(span.first).inverse() * at(span.last);
      max_m = std::max(max_m,
                       length(way.translation) + kSeenAt_m * angle_between(way.rotation, Mat3d{}));
    }
    return max_m;
  }

 private:
  std::optional<double> time_of(std::size_t k, std::size_t i, double scan_s) const {
    if (scans_[k].times.size() != scans_[k].size() || frames_.poses.track.empty() ||
        !std::isfinite(scans_[k].times[i]))
      return std::nullopt;
    return frames_.times.time_s(scans_[k].times[i], scan_s);
  }

  const SensorFrames& frames_;
  std::vector<std::size_t> indices_;
  std::vector<FileScan> scans_;
};

/// How close each hypothesis brings the points to the cones of one sensor.
struct Residuals {
  std::optional<Recognition> best;
  std::size_t way = 0;
  double best_rad = std::numeric_limits<double>::infinity();
  double other_rad = std::numeric_limits<double>::infinity();  ///< of hypotheses of the other kind
};

Residuals residuals_of(const Sample& sample, const std::vector<Way>& ways,
                       const Executor& executor) {
  std::vector<SensorCones> tables = library_cones();
  std::vector<std::optional<Recognition>> found(ways.size());
  std::size_t first = 0;
  for (; first < ways.size(); ++first) {
    found[first] = recognize_sensor(sample.as_cast(ways[first]), tables, executor);
    if (found[first]) break;
  }
  Residuals residuals;
  if (first == ways.size()) return residuals;
  // Only this sensor for the others: motion does not bring points closer to other sensors' cones.
  tables = {found[first]->cones};
  for (std::size_t w = 0; w < ways.size(); ++w)
    if (w > first) found[w] = recognize_sensor(sample.as_cast(ways[w]), tables, executor);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    if (!found[w] || found[w]->residual_rad >= residuals.best_rad) continue;
    residuals.best_rad = found[w]->residual_rad;
    residuals.best = found[w];
    residuals.way = w;
  }
  for (std::size_t w = 0; w < ways.size(); ++w)
    if (found[w] && ways[w].points != ways[residuals.way].points)
      residuals.other_rad = std::min(residuals.other_rad, found[w]->residual_rad);
  return residuals;
}

std::string motion_text(const Way& way, double moved_m) {
  const std::string moved = formatted("; the sensor moves up to %.2f m within a sweep", moved_m, 0);
  if (way.points == SweepPoints::measured)
    return "points as measured, each brought to the frame of its scan by the poses" + moved;
  return std::string("already compensated in the points (frame of ") + way.frame + ")" + moved;
}

}  // namespace

std::shared_ptr<const ScanReader> raw_reader(std::shared_ptr<const ScanSource> source) {
  return std::make_shared<RawReader>(std::move(source));
}

std::shared_ptr<const ScanReader> sweep_reader(const SensorFrames& frames, SweepFinding finding,
                                               bool with_classes) {
  return std::make_shared<SweepReader>(frames, std::move(finding), with_classes);
}

SweepFinding analyze_sweeps(const SensorFrames& frames, SweepPoints stated,
                            const Executor& executor) {
  const std::vector<Way> ways = possible_ways(frames, stated);
  const Sample sample(frames);
  Residuals residuals;
  if (!frames.sensor) residuals = residuals_of(sample, ways, executor);
  SweepFinding finding;
  finding.sensor = residuals.best;
  if (frames.sensor) finding.sensor = Recognition{*frames.sensor, {}, 0, 0, 0};
  finding.scan_poses = frames.poses.of_scans;
  if (ways.front().points == SweepPoints::found) {  // no times
    if (stated == SweepPoints::measured)
      throw Error(ErrorKind::usage,
                  frames.files.front().parent_path().string() +
                      ": `sweep_points` measured needs times of points and poses");
    if (stated == SweepPoints::compensated) {
      finding.motion = "already compensated in the points, as stated";
      return finding;
    }
    finding.motion = std::string("unknown, since the ") +
                     (frames.times.kind == PointTimes::Kind::none
                          ? "points have no times"
                          : "poses have no times in the clock of the points") +
                     "; the sensor is assumed to be at rest during a scan";
    return finding;
  }
  finding.moved_m = sample.moved_m();
  const Way& way = ways[residuals.way];
  const bool is_clear = residuals.best && residuals.other_rad > kClearly * residuals.best_rad;
  if (is_clear || stated != SweepPoints::found || finding.moved_m < kNoMotion_m) {
    finding.way = way.points;
    finding.scan_poses = way.scan_poses;
    finding.motion = motion_text(way, finding.moved_m);
    if (stated != SweepPoints::found)
      finding.motion += ", as stated";
    else if (!is_clear)
      finding.motion =
          "negligible within a sweep" + finding.motion.substr(finding.motion.find(';'));
    else
      finding.motion += formatted(
          " (%.3f deg from the cones of its beams, otherwise at least %.3f)",
          residuals.best_rad / kDegree, std::min(residuals.other_rad, 0.5 * kDegree) / kDegree);
    return finding;
  }
  finding.motion = formatted(residuals.best ? "undetermined: points are %.3f deg from the cones of "
                                              "the beams by one hypothesis, %.3f by the other"
                                            : "unknown, since no sensor is recognised",
                             residuals.best_rad / kDegree, residuals.other_rad / kDegree);
  finding.motion += formatted(
      "; the sensor is assumed to be at rest, although it moves up to %.2f m within a sweep (give "
      "`sweep_points`)",
      finding.moved_m, 0);
  return finding;
}

namespace {

std::string beams_text(const SweepFinding& finding) {
  const Vec3d at = finding.sensor->vehicle_from_sensor.translation;
  constexpr double kDegrees = 57.29577951308232;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s at %.3f, %.3f, %.3f m in the points' frame (beams %.3f deg from its cones%s)",
                finding.sensor->cones.sensor.c_str(), at.x, at.y, at.z,
                finding.sensor->residual_rad * kDegrees,
                finding.way == SweepPoints::found ? "" : ", each point at its own time");
  return text.data();
}

}  // namespace

std::vector<TimeSpan> spans_of_scans(const SensorFrames& frames, const Executor& executor,
                                     ProgressSink& progress) {
  const std::vector<std::filesystem::path>& files = frames.files;
  const PointTimes& times = frames.times;
  std::vector<TimeSpan> spans_s(files.size());
  progress.begin_step("times of scans", files.size());
  std::mutex mutex;
  std::size_t done = 0;
  executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    const TimeSpan span = frames.source->read(files[k]).time_span();
    spans_s[k] = {times.time_s(span.first, 0), times.time_s(span.last, 0)};
    const std::lock_guard lock(mutex);
    progress.advance(++done);
  });
  progress.end_step();
  return spans_s;
}

void report_drive(const KittiSequence& sequence, ProgressSink& progress) {
  // The evidence of a fact follows in parentheses or after a semicolon; 'info' lists it.
  const auto conclusion_of = [](const std::string& fact) {
    return fact.substr(0, std::min(fact.find(" ("), fact.find(';')));
  };
  const DriveFacts& facts = sequence.facts;
  std::string text = sequence.folder.string() + ": points in the " +
                     conclusion_of(facts.points_in) + ", beams from " +
                     conclusion_of(sequence.beams.description()) + " (evidence: adasplats info)";
  if (facts.is_motion_assumed) text += "; motion within a sweep: " + facts.motion;
  if (!facts.is_clock_checked) text += "; " + facts.clock;
  if (!facts.unchecked.empty()) text += "; " + facts.unchecked;
  if (!facts.intensities.empty()) text += "; intensities " + facts.intensities;
  if (!facts.labels.empty()) text += "; labels " + facts.labels;
  if (!facts.left_out.empty()) text += "; skipped: " + facts.left_out;
  progress.warn(text);
}

std::string motion_text(const ScanBeams& beams) {
  if (!beams.sweeps_m.empty())
    return "already compensated in the points (by the cones of the beams)";
  return beams.raw_motions.empty()
             ? "points as measured; the sensor is assumed to be at rest during a scan"
             : "points as measured, compensated by the poses, which other scans confirm";
}

KittiSequence open_sensor_frames(const DriveInput& drive, const SensorFrames& frames,
                                 const std::string& because, const Executor& executor,
                                 ProgressSink& progress) {
  KittiSequence sequence;
  sequence.folder = drive.folder;
  sequence.scans = frames.files;
  sequence.trajectory = frames.poses.of_scans;
  if (frames.poses.has_times) sequence.track = frames.poses.track;
  sequence.has_times = frames.poses.has_times;
  sequence.reader = raw_reader(frames.source);
  sequence.facts.points_in = "sensor's frame (" + because + ")";
  sequence.facts.poses =
      frames.poses.by + (drive.given_mount() ? ", with the stated mount"
                                             : ", assumed to be those of the points' frame");
  sequence.facts.unchecked = verify_poses(sequence, executor);
  const bool has_point_times = frames.times.kind != PointTimes::Kind::none;
  if (has_point_times && !frames.times.fits)
    throw Error(ErrorKind::data, drive.folder.string() +
                                     ": the times of its points are neither offsets within a sweep "
                                     "(5 ms to 1 s, in s, ms, us or ns) nor in the clock of " +
                                     drive.trajectory.string() +
                                     "; give `time_offset` if the clocks differ");
  SweepFinding finding;
  finding.scan_poses = frames.poses.of_scans;
  progress.begin_step("recognise the sensor", 0);
  if (!drive.beams_from_poses && !has_point_times && drive.sweep_points != SweepPoints::measured)
    sequence.beams = recognize_beams(sequence, executor);
  if (drive.beams_from_poses) {
    sequence.facts.motion = "not analysed: beams start at the poses";
  } else if (sequence.beams.from_hdl64) {
    sequence.facts.motion = motion_text(sequence.beams);
    sequence.facts.is_motion_assumed =
        sequence.beams.sweeps_m.empty() && sequence.beams.raw_motions.empty();
  } else {
    finding = analyze_sweeps(frames, drive.sweep_points, executor);
    sequence.facts.motion = finding.motion;
    sequence.facts.is_motion_assumed =
        finding.way == SweepPoints::found && drive.sweep_points == SweepPoints::found;
    sequence.trajectory = finding.scan_poses;
    if (finding.sensor) {
      sequence.beams.sensor = finding.sensor->cones.sensor;
      sequence.beams.recognised =
          frames.sensor ? finding.sensor->cones.sensor + ", the sensor of the packets, by its file"
                        : beams_text(finding);
    }
  }
  progress.end_step();
  sequence.facts.intensities = frames.intensities;
  sequence.facts.labels = frames.labels;
  sequence.reader = sweep_reader(frames, std::move(finding), drive.with_classes);
  add_boxes(drive, {}, sequence, executor, progress);
  report_drive(sequence, progress);
  return sequence;
}

std::vector<std::size_t> covered_scans(std::span<const TimeSpan> spans_s, const Track& track,
                                       const std::filesystem::path& path, const char* scans,
                                       ProgressSink& progress) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < spans_s.size(); ++k)
    if (track.covers(spans_s[k])) kept.push_back(k);
  const std::size_t all = spans_s.size();
  if (kept.size() == all) return kept;
  std::array<char, 320> text{};
  std::snprintf(
      text.data(), text.size(),
      ": %zu of %zu %s (%.3f to %.3f s) have no pose (poses cover %.3f to %.3f s, with %zu gaps)",
      all - kept.size(), all, scans, spans_s.front().first, spans_s.back().last,
      track.measured_s.first, track.measured_s.last, track.gaps.size());
  if (2 * kept.size() < all)
    throw Error(
        ErrorKind::data,
        path.string() + text.data() +
            "; the clocks differ (give `time_offset`), or the poses belong to another drive");
  progress.warn(path.string() + text.data() + " and are skipped");
  return kept;
}

}  // namespace adasplats
