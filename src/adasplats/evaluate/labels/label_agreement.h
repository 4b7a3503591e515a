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
  /// Original scans before and after the one of the same time whose points are looked at.
  std::size_t window = 10;
  std::size_t every = 1;  ///< takes every n-th simulated scan
};

/// Simulated points whose class is that of the nearest original point.
struct LabelAgreement {
  std::size_t points = 0;
  std::size_t agree = 0;
  double distance_m = 0;  ///< mean, to the nearest original point

  /// 0..1; NaN without points.
  double share() const;
};

struct LabelAgreementResult {
  LabelAgreement all;
  LabelAgreement labelled;                           ///< where both have a class other than 0
  std::map<std::uint16_t, LabelAgreement> by_class;  ///< of the simulated point
  /// Points by (simulated class, original class) where they differ.
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> confusions;
};

/// Compares the labels of a simulated sequence with those of the sequence that it was made from.
/// A scan's counterpart is that of the nearest time. Original points that move (by `labels`) count
/// in their own scan alone: elsewhere they are trails. Errors: data (a sequence without labels or
/// scans), usage (`every` is 0), those of read_kitti_scan.
LabelAgreementResult compare_labels(const KittiSequence& simulated, const KittiSequence& original,
                                    const LabelScheme& labels, const LabelAgreementOptions& options,
                                    const Executor& executor, ProgressSink& progress);

}  // namespace adasplats
