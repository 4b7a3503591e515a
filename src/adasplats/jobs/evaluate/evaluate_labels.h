// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "adasplats/evaluate/labels/label_agreement.h"
#include "adasplats/evaluate/labels/segmentation.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// How many simulated points have the class of the nearest measured one?
struct LabelAgreementJob {
  std::filesystem::path simulated;  ///< sequence folder with labels
  std::filesystem::path original;   ///< the sequence that it was made from
  std::string labels = "semantickitti";
  LabelAgreementOptions options;
};

LabelAgreementResult evaluate_labels(const LabelAgreementJob& job, Session& session);
nlohmann::ordered_json to_json(const LabelAgreementResult& result);

/// How well do predicted classes agree with the true ones, point by point?
///
/// Either side is a file (.label, or points with a class column); a sequence folder with
/// labels/NNNNNN.label (for predictions, predictions/NNNNNN.label come first); a folder of .label
/// files; a tree of these (FOLDER/sequences/NAME or FOLDER/NAME); or a folder of point files. Two
/// files form a pair whatever their names. Otherwise sequences and scans are matched by name (a
/// single sequence on each side matches whatever its name).
struct SegmentationJob {
  std::filesystem::path predicted;
  std::filesystem::path truth;
  std::string labels = "semantickitti";  ///< scheme of both sides
  ScanRange scans;                       ///< of each true sequence
  SegmentationOptions options;
};

/// Counts all files together; every point takes part. Errors: no_input; data (no labels, a sequence
/// or, without `scans`, a scan that only one side has, no true point with a class); usage (`scans`
/// with two files); those of SegmentationConfusion::add, with both files, and of the readers.
SegmentationResult evaluate_segmentation(const SegmentationJob& job, Session& session);

/// The same for points in memory.
SegmentationResult evaluate_segmentation(std::span<const std::uint16_t> predicted,
                                         std::span<const std::uint16_t> truth,
                                         const std::string& labels,
                                         const SegmentationOptions& options, Session& session);
nlohmann::ordered_json to_json(const SegmentationResult& result);

}  // namespace adasplats
