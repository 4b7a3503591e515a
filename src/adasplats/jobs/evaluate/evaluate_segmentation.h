// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "adasplats/evaluate/labels/segmentation.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

struct SegmentationJob {
  std::filesystem::path predicted;  ///< files and folders as pair_label_files takes them
  std::filesystem::path truth;
  std::string labels = "semantickitti";  ///< of both
  ScanRange scans;                       ///< of each true sequence
  SegmentationOptions options;
};

/// How well predicted classes agree with the true ones, point by point, over all files together.
/// Errors: those of pair_label_files and SegmentationConfusion::add (with both files); data where
/// no true point is of a class.
SegmentationResult evaluate_segmentation(const SegmentationJob& job, Session& session);

/// The same of points in memory.
SegmentationResult evaluate_segmentation(std::span<const std::uint16_t> predicted,
                                         std::span<const std::uint16_t> truth,
                                         const std::string& labels,
                                         const SegmentationOptions& options, Session& session);

}  // namespace adasplats
