// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>
#include <string>

#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/cloud/sequence/pose_check.h"
#include "adasplats/core/error.h"

namespace adasplats {

namespace {

constexpr std::size_t kPointBytes = 16;  // of a KITTI scan

std::vector<std::size_t> chosen_scans(const KittiSequence& sequence, const LoadOptions& options) {
  const std::size_t count = sequence.scans.size();
  if (options.first_scan >= count)
    throw Error(ErrorKind::usage, sequence.folder.string() + ": has " + std::to_string(count) +
                                      " scans, the first asked for is number " +
                                      std::to_string(options.first_scan));
  std::vector<std::size_t> chosen;
  // Not `i += stride` up to the end: a huge stride would wrap.
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

void store_scan(const PartRun& run, const KittiScan& scan, PointCloud& cloud) {
  if (scan.positions.size() != run.end - run.begin)
    throw Error(ErrorKind::io, run.file.string() + ": changed while it was read");
  copy_to(cloud.positions, run.begin, scan.positions);
  copy_to(cloud.intensities, run.begin, scan.intensities);
  copy_to(cloud.classes, run.begin, scan.classes);
  copy_to(cloud.instances, run.begin, scan.instances);
}

}  // namespace

CloudPart read_sequence_part(const std::filesystem::path& folder, const LoadOptions& options,
                             std::uint32_t first_scan_index, const Executor& executor,
                             ProgressSink& progress) {
  const KittiSequence sequence = open_kitti_sequence(folder);
  require_poses_that_fit(sequence);
  const std::vector<std::size_t> chosen = chosen_scans(sequence, options);
  CloudPart part;
  part.is_sequence = true;
  if (!options.beams_from_poses) part.beams = recognize_beams(sequence);
  part.runs = runs_of(sequence, chosen);
  const std::size_t points = part.size();
  PointCloud& cloud = part.cloud;
  cloud.positions.resize(points);
  cloud.intensities.resize(points);
  cloud.scan_indices.resize(points);
  if (!sequence.labels.empty()) {
    cloud.classes.resize(points);
    cloud.instances.resize(points);
  }

  progress.begin_step("reading scans", chosen.size());
  std::mutex progress_mutex;
  std::size_t done = 0;
  executor.for_chunks(chosen.size(), 1, [&](std::size_t k, std::size_t) {
    const PartRun& run = part.runs[k];
    store_scan(run, read_kitti_scan(sequence, chosen[k]), cloud);
    std::fill(cloud.scan_indices.begin() + static_cast<std::ptrdiff_t>(run.begin),
              cloud.scan_indices.begin() + static_cast<std::ptrdiff_t>(run.end),
              first_scan_index + static_cast<std::uint32_t>(k));
    const std::lock_guard lock(progress_mutex);
    progress.advance(++done);
  });
  progress.end_step();
  return part;
}

}  // namespace adasplats
