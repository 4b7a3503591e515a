// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/sensor_drive.h"

#include <array>
#include <cstdio>
#include <mutex>
#include <utility>

#include "adasplats/cloud/load/moving_boxes.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

std::string beams_text(const SweepFinding& finding) {
  const Vec3d at = finding.sensor->vehicle_from_sensor.translation;
  constexpr double kDegrees = 57.29577951308232;
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "%s found at (%.3f, %.3f, %.3f) m of the points' frame, beams %.3f deg from its "
                "cones%s",
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

void tell_of_drive(const KittiSequence& sequence, ProgressSink& progress) {
  const DriveFacts& facts = sequence.facts;
  progress.warn(sequence.folder.string() + ": points in the " + facts.points_in + "; poses " +
                facts.poses + "; beams from " + sequence.beams.description() +
                "; motion within a sweep: " + facts.motion +
                (facts.clock.empty() ? "" : "; " + facts.clock) +
                (facts.intensities.empty() ? "" : "; intensities " + facts.intensities) +
                (facts.labels.empty() ? "" : "; labels " + facts.labels) +
                (facts.left_out.empty() ? "" : "; left out: " + facts.left_out));
}

std::string motion_text(const ScanBeams& beams) {
  if (!beams.sweeps_m.empty()) return "taken out of the points, by the cones of its beams";
  return beams.raw_motions.empty() ? "in the points, as measured; scans as if standing still"
                                   : "in the points, as measured, and taken out by the poses, "
                                     "which points of other scans "
                                     "confirm";
}

KittiSequence open_sensor_frames(const FrameDrive& drive, const SensorFrames& frames,
                                 const std::string& because, const Executor& executor,
                                 ProgressSink& progress) {
  KittiSequence sequence;
  sequence.folder = drive.folder;
  sequence.scans = frames.files;
  sequence.trajectory = frames.poses.of_scans;
  sequence.reader = raw_reader(frames.source);
  sequence.facts.points_in = "sensor's frame (" + because + ")";
  sequence.facts.poses = frames.poses.by + (drive.mount ? ", with the stated mount"
                                                        : ", taken as those of the points' frame");
  sequence.facts.unchecked = require_poses_that_fit(sequence, executor);
  MovingBoxes boxes;
  if (!drive.boxes.empty()) boxes = MovingBoxes(drive.boxes);
  const bool has_point_times = frames.times.kind != PointTimes::Kind::none;
  if (has_point_times && !frames.times.fits)
    throw Error(ErrorKind::data,
                drive.folder.string() +
                    ": the times of its points are neither offsets within a sweep (5 ms to 1 s) "
                    "in s, ms, us or ns nor of the clock of " +
                    drive.trajectory.string() + "; `time_offset` states what they lack to it");
  SweepFinding finding;
  finding.scan_poses = frames.poses.of_scans;
  progress.begin_step("recognise the sensor", 0);
  if (!drive.beams_from_poses && !has_point_times && drive.sweep_points == SweepPoints::found)
    sequence.beams = recognize_beams(sequence, executor);
  if (drive.beams_from_poses) {
    sequence.facts.motion = "not looked for: beams from the poses";
  } else if (sequence.beams.from_hdl64) {
    sequence.facts.motion = motion_text(sequence.beams);
  } else {
    finding = look_at_sweeps(frames, drive.sweep_points, executor);
    sequence.facts.motion = finding.motion;
    sequence.trajectory = finding.scan_poses;
    if (finding.sensor) {
      sequence.beams.sensor = finding.sensor->cones.sensor;
      sequence.beams.recognised = beams_text(finding);
    }
  }
  progress.end_step();
  sequence.facts.intensities = frames.intensities;
  sequence.facts.labels = frames.labels;
  sequence.reader = sweep_reader(frames, std::move(finding), std::move(boxes), drive.with_classes);
  tell_of_drive(sequence, progress);
  return sequence;
}

}  // namespace adasplats
