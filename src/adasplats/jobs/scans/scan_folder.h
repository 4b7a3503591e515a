// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/dataset/rig_writer.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

// Writing of simulated scans into a ResumableFolder, in one run or in many tasks.

/// The scans of one sensor among those of a rig; by default, of the only sensor.
struct SensorOfRig {
  std::string folder;  ///< "NAME/"; empty: the sensor is the only one
  std::size_t sensor = 0, sensors = 1;

  /// The number of a scan for the writer.
  std::size_t number(std::size_t scan) const { return rig_scan_number(scan, sensor, sensors); }
};

/// Casts scans and writes them meanwhile, on the session's threads.
class ScanRecorder {
 public:
  /// Of `options`, `more_files` and `written` are used. `done`: scans that an earlier run wrote,
  /// for the progress. Both references must outlive the recorder.
  ScanRecorder(ScanWriter& writer, ParallelWriteOptions options, std::size_t done,
               Session& session);

  /// Casts `count` scans from `first` on, the first with this number (ScanSimulator::run). By
  /// ascending `first`, for each sensor.
  ReportTimes record(ScanSimulator& simulator, std::span<const ScanMotion> scans, std::size_t first,
                     std::size_t count, std::uint64_t number, const SensorOfRig& sensor = {});
  /// Waits until all scans are written. Call once, last.
  void finish() { files_.finish(); }

  std::size_t rays() const { return rays_; }
  std::size_t hits() const { return hits_; }

 private:
  Session& session_;
  ParallelScanWriter files_;
  std::size_t done_, rays_ = 0, hits_ = 0;
};

/// Announces to a writer the scans that an interrupted run wrote, from the first one up to the
/// first that is missing or damaged, and returns their number. Errors: io.
std::size_t keep_written_scans(ScanWriter& writer, const ResumableFolder& folder,
                               std::span<const ScanMotion> scans, const SensorOfRig& sensor = {});

/// Records written scans in the journal of a folder as soon as one of them has a return: the scans
/// of an interrupted run are never all empty.
class ScanJournal {
 public:
  explicit ScanJournal(ResumableFolder& folder) : folder_(folder) {}
  /// One call at a time.
  void note(std::size_t points, std::span<const FileDigest> files);

 private:
  ResumableFolder& folder_;
  std::vector<FileDigest> held_back_;  ///< of empty scans at the beginning
};

/// Throws io if the disk of `folder` has too little space for the scans even if few of their rays
/// return; the message has the minimum and the maximum that they need.
void require_disk_space(const std::filesystem::path& folder, ScanFormat format, std::size_t scans,
                        std::size_t rays_per_scan, int returns_per_ray);

/// Throws data: none of the rays of these scans hit the model; with the distance of the sensor from
/// it. `question`: the likely cause.
[[noreturn]] void throw_no_returns(std::size_t rays, const ScanScene& scene,
                                   std::span<const ScanMotion> scans, const LidarModel& sensor,
                                   const std::string& question);

/// Rethrows the current exception; to an error of writing it adds where the written scans are.
[[noreturn]] void rethrow_with_kept_scans(const ResumableFolder& folder);

// Spans: scans that one task writes. A task notes them in "spans/FIRST-COUNT.sha256" of the
// unfinished folder: the SHA-256 of every file, the main file of each scan last. The note of a span
// without any return ends with ".empty.sha256": if all spans are empty, that is an error, as in one
// run.

/// Prepares the folder for tasks.
void begin_spans(ResumableFolder& folder);

void note_span(const std::filesystem::path& folder, std::size_t first, std::size_t count,
               std::span<const FileDigest> files, bool is_empty);
/// Whether a span was noted and its files are unchanged since.
bool has_span(const std::filesystem::path& folder, std::size_t first, std::size_t count);

/// Records the files that tasks have noted.
void record_spans(ResumableFolder& folder);
/// The files that are not part of the finished folder.
std::vector<std::string> span_note_files(const std::filesystem::path& folder);

}  // namespace adasplats
