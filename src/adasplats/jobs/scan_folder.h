// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// Tells a writer of the scans that an interrupted run wrote, from the first one on, and gives
/// their number: up to the first that is missing or damaged. Errors: io.
std::size_t keep_written_scans(ScanWriter& writer, const ResumableFolder& folder,
                               std::span<const ScanMotion> scans);

/// Notes whole scans in the journal of a folder, once one of them has a return: scans that an
/// interrupted run left are never all empty.
class ScanJournal {
 public:
  explicit ScanJournal(ResumableFolder& folder) : folder_(folder) {}
  /// One call at a time.
  void note(std::size_t points, std::span<const FileDigest> files);

 private:
  ResumableFolder& folder_;
  std::vector<FileDigest> held_back_;  ///< of empty scans at the beginning
};

/// Throws io where the disk of `folder` has no room for the scans even if few of their rays return,
/// with what they need at least and at most.
void require_disk_space(const std::filesystem::path& folder, ScanFormat format, std::size_t scans,
                        std::size_t rays_per_scan, int returns_per_ray);

/// The error of a run that ended early, which says of an error of writing what is kept of it.
[[noreturn]] void rethrow_with_what_is_kept(const ResumableFolder& folder);

}  // namespace adasplats
