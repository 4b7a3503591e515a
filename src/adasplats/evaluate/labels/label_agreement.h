// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/progress.h"

namespace adasplats {

struct LabelAgreementOptions {
  /// Number of original scans searched before and after the scan of the same time.
  std::size_t window = 10;
  std::size_t every = 1;  ///< use every n-th simulated scan
};

/// Simulated points that have the class of the nearest original point.
struct LabelAgreement {
  std::size_t points = 0;
  std::size_t agree = 0;
  double distance_m = 0;  ///< mean, to the nearest original point

  /// 0..1; NaN without points.
  double share() const;
};

struct LabelAgreementResult {
  LabelAgreement all;
  LabelAgreement labelled;  ///< points with a class other than 0 on both sides
  std::map<std::uint16_t, LabelAgreement> by_class;  ///< of the simulated point
  /// Points by (simulated class, original class), if these differ.
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> confusions;
};

/// Compares the labels of a simulated sequence with those of the sequence that it was made from. A
/// scan is compared with the original scan of the nearest time. Original points of moving classes
/// (by `labels`) count only in their own scan: in others they are trails. Errors: data (a sequence
/// without labels or scans), usage (`every` is 0), those of read_kitti_scan.
LabelAgreementResult compare_labels(const KittiSequence& simulated, const KittiSequence& original,
                                    const LabelScheme& labels, const LabelAgreementOptions& options,
                                    const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
