// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"
#include "adasplats/core/memory.h"

namespace adasplats {

namespace {

constexpr std::size_t kPointBytes = 16;  // in a KITTI scan

std::vector<std::size_t> chosen_scans(const KittiSequence& sequence, const LoadOptions& options) {
  const std::size_t count = sequence.scans.size();
  if (options.first_scan >= count)
    throw Error(ErrorKind::usage, sequence.folder.string() + ": has " + std::to_string(count) +
                                      " scans (numbered from 0), but the first scan is set to " +
                                      std::to_string(options.first_scan));
  std::vector<std::size_t> chosen;
  // Not `i += stride`: a huge stride would wrap.
  for (std::size_t i = 0; i < count - options.first_scan && chosen.size() < options.scan_count; ++i)
    if (i % options.scan_stride == 0) chosen.push_back(options.first_scan + i);
  return chosen;
}

/// The runs of the scans, sized by their files, so that scans can be read in any order.
std::vector<PartRun> runs_of(const KittiSequence& sequence,
                             const std::vector<std::size_t>& chosen) {
  std::vector<PartRun> runs;
  std::size_t begin = 0;
  for (const std::size_t scan : chosen) {
    const std::filesystem::path& file = sequence.scans[scan];
    std::error_code problem;
    const std::uintmax_t bytes = std::filesystem::file_size(file, problem);
    if (problem) throw system_error(ErrorKind::no_input, file, "cannot be read", problem.value());
    const std::size_t end = begin + static_cast<std::size_t>(bytes / kPointBytes);
    runs.push_back({begin, end, file, sequence.trajectory[scan].world_from_sensor, scan});
    begin = end;
  }
  return runs;
}

template <class T>
void copy_to(std::vector<T>& values, std::size_t begin, const std::vector<T>& part) {
  std::ranges::copy(part, values.begin() + static_cast<std::ptrdiff_t>(begin));
}

void store_scan(const PartRun& run, const KittiScan& scan, CloudPart& part) {
  PointCloud& cloud = part.cloud;
  if (scan.positions.size() != run.end - run.begin)
    throw Error(ErrorKind::io, run.file.string() + ": changed while it was read");
  copy_to(cloud.positions, run.begin, scan.positions);
  copy_to(cloud.intensities, run.begin, scan.intensities);
  copy_to(cloud.classes, run.begin, scan.classes);
  copy_to(cloud.instances, run.begin, scan.instances);
  copy_to(part.in_boxes, run.begin, scan.in_boxes);
}

}  // namespace

KittiSequence open_sequence(const std::filesystem::path& folder, const LoadOptions& options,
                            const Executor& executor) {
  KittiSequence sequence = open_kitti_sequence(folder);
  sequence.facts.unchecked = verify_poses(sequence, executor);
  if (!options.beams_from_poses) sequence.beams = recognize_beams(sequence, executor);
  return sequence;
}

namespace {

/// Calls body(k) for every run, in parallel, and reports progress.
template <class Body>
void for_each_scan(std::size_t count, const Executor& executor, ProgressSink& progress,
                   const Body& body) {
  progress.begin_step("reading scans", count);
  std::mutex progress_mutex;
  std::size_t done = 0;
  executor.for_chunks(count, 1, [&](std::size_t k, std::size_t) {
    body(k);
    const std::lock_guard lock(progress_mutex);
    progress.advance(++done);
  });
  progress.end_step();
}

void number_scans(CloudPart& part, std::uint32_t first_scan_index, const Executor& executor) {
  std::vector<std::uint32_t>& scans = part.cloud.scan_indices;
  resize_large(scans, part.size());
  executor.for_chunks(part.runs.size(), 1, [&](std::size_t k, std::size_t) {
    std::fill(scans.begin() + static_cast<std::ptrdiff_t>(part.runs[k].begin),
              scans.begin() + static_cast<std::ptrdiff_t>(part.runs[k].end),
              first_scan_index + static_cast<std::uint32_t>(k));
  });
}

/// Moves one attribute of all scans into `all`, freeing each scan's copy on the way. Leaves `all`
/// empty unless all `points` points have the attribute.
template <class T>
void join(std::vector<KittiScan>& scans, std::vector<T> KittiScan::*attribute, std::size_t points,
          std::vector<T>& all) {
  std::size_t size = 0;
  for (const KittiScan& scan : scans) size += (scan.*attribute).size();
  if (size == points) all.reserve(size);
  prefer_large_pages(all.data(), all.capacity() * sizeof(T));
  for (KittiScan& scan : scans) {
    const std::vector<T> values = std::move(scan.*attribute);
    if (size == points) all.insert(all.end(), values.begin(), values.end());
  }
}

/// Identifies the lasers of a scan's points. If the sensor moved, also brings the points to the
/// scan's frame and sets the origins of their beams.
void identify_lasers(const PartRun& run, CloudPart& part) {
  PointCloud& cloud = part.cloud;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const Vec3d point = vec_cast<double>(cloud.positions[i]);
    if (part.scan_origins.empty()) {
      cloud.lasers[i] = part.beams.laser_of(run.scan, point);
      continue;
    }
    const MeasuredBeam beam = part.beams.beam_of(run.scan, point);
    cloud.lasers[i] = beam.laser;
    cloud.positions[i] = vec_cast<float>(beam.end);
    part.scan_origins[i] = vec_cast<float>(beam.origin);
  }
}

/// Reads scans of a reader, whose point counts are unknown until they are read.
void read_with_reader(const KittiSequence& sequence, const std::vector<std::size_t>& chosen,
                      bool with_times, CloudPart& part, const Executor& executor,
                      ProgressSink& progress) {
  std::vector<KittiScan> scans(chosen.size());
  for_each_scan(chosen.size(), executor, progress, [&](std::size_t k) {
    scans[k] = read_all_returns(sequence, chosen[k]);
    if (!with_times) scans[k].times_s = {};
  });
  std::size_t points = 0;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t end = points + scans[k].positions.size();
    part.runs.push_back({points, end, sequence.scans[chosen[k]],
                         sequence.trajectory[chosen[k]].world_from_sensor, chosen[k]});
    points = end;
  }
  PointCloud& cloud = part.cloud;
  std::vector<double> times_s;
  std::vector<std::function<void()>> tasks;
  const auto add = [&](auto attribute, auto& all) {
    tasks.emplace_back([&scans, &all, attribute, points] { join(scans, attribute, points, all); });
  };
  add(&KittiScan::positions, cloud.positions);
  add(&KittiScan::origins, part.scan_origins);
  add(&KittiScan::intensities, cloud.intensities);
  add(&KittiScan::classes, cloud.classes);
  add(&KittiScan::instances, cloud.instances);
  add(&KittiScan::lasers, cloud.lasers);
  add(&KittiScan::in_boxes, part.in_boxes);
  add(&KittiScan::times_s, times_s);
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) { tasks[task](); });
  if (!times_s.empty()) cloud.others.columns.push_back({"timestamp", std::move(times_s)});
  if (part.beams.from_hdl64) {
    cloud.lasers.resize(points);
    part.scan_origins.resize(part.beams.raw_motions.empty() ? 0 : points);
    executor.for_chunks(part.runs.size(), 1,
                        [&](std::size_t k, std::size_t) { identify_lasers(part.runs[k], part); });
  }
  const auto unknown = [](std::uint16_t laser) { return laser == kNoLaser; };
  if (std::ranges::all_of(cloud.lasers, unknown)) cloud.lasers.clear();
}

/// Sizes the arrays of a part, one thread each: most of the time is spent by the system on
/// providing the memory.
void size_arrays(bool has_labels, CloudPart& part, const Executor& executor) {
  const std::size_t points = part.size();
  PointCloud& cloud = part.cloud;
  std::vector<std::function<void()>> tasks;
  const auto add = [&](auto& values) {
    tasks.emplace_back([&values, points] { resize_large(values, points); });
  };
  add(cloud.positions);
  add(cloud.sensor_positions);
  add(cloud.intensities);
  add(cloud.scan_indices);
  if (part.beams.from_hdl64) add(cloud.lasers);
  if (!part.beams.raw_motions.empty()) add(part.scan_origins);
  if (has_labels) {
    add(cloud.classes);
    add(cloud.instances);
  }
  executor.for_chunks(tasks.size(), 1, [&](std::size_t task, std::size_t) { tasks[task](); });
}

void read_files(const KittiSequence& sequence, const std::vector<std::size_t>& chosen,
                CloudPart& part, const Executor& executor, ProgressSink& progress) {
  part.runs = runs_of(sequence, chosen);
  size_arrays(!sequence.labels.empty(), part, executor);
  if (sequence.boxes) part.in_boxes.resize(part.size());
  for_each_scan(chosen.size(), executor, progress, [&](std::size_t k) {
    const PartRun& run = part.runs[k];
    store_scan(run, read_all_returns(sequence, chosen[k]), part);
    if (!part.cloud.lasers.empty()) identify_lasers(run, part);
  });
}

std::string undetermined_motion_text(const KittiSequence& sequence) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(),
                ": scans are not motion-compensated; the sensor moves %.2f m within each, and the "
                "motion cannot be determined (poses at least 0.5 s apart, or scans that do not "
                "align better with it): assumed to be at rest",
                sequence.beams.unknown_sweep_m);
  return sequence.folder.string() + text.data();
}

}  // namespace

CloudPart read_sequence_part(const KittiSequence& sequence, const LoadOptions& options,
                             std::uint32_t first_scan_index, const Executor& executor,
                             ProgressSink& progress) {
  const std::vector<std::size_t> chosen = chosen_scans(sequence, options);
  CloudPart part;
  part.is_sequence = true;
  part.beams = sequence.beams;
  constexpr double kStill_m = 0.02;
  if (part.beams.unknown_sweep_m > kStill_m) progress.warn(undetermined_motion_text(sequence));
  part.cloud.crs = sequence.facts.crs;
  if (sequence.reader)
    read_with_reader(sequence, chosen, options.other_columns == KeptColumns::all, part, executor,
                     progress);
  else
    read_files(sequence, chosen, part, executor, progress);
  number_scans(part, first_scan_index, executor);
  for (const std::size_t scan : chosen) part.cloud.scan_poses.push_back(sequence.trajectory[scan]);
  return part;
}

}  // namespace adasplats
