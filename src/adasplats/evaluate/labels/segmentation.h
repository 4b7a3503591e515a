// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/benchmark_classes.h"
#include "adasplats/core/executor.h"

namespace adasplats {

struct SegmentationOptions {
  /// Classes with a smaller share of the true points are left out of the mean: their IoU is that of
  /// a few objects.
  double min_share = 0.0005;
};

/// Points by their true and their predicted class. Those that truly are of no class are counted and
/// judge nothing; a point of a class that is predicted to be of none is a miss of its class, as in
/// the scripts of SemanticKITTI's benchmark (their accuracy leaves such points out; here they are
/// wrong).
class SegmentationConfusion {
 public:
  explicit SegmentationConfusion(std::size_t classes = 0);

  /// Adds the points of a scan, whose labels are ids of the classes' scheme. Errors: data (another
  /// count of predicted labels than of true ones, an id that the scheme does not have).
  void add(std::span<const std::uint16_t> predicted, std::span<const std::uint16_t> truth,
           const BenchmarkClasses& classes, const Executor& executor);
  /// Adds points by the numbers of their classes; classes(): of none.
  void add(std::size_t truth, std::size_t predicted, std::uint64_t points);
  /// Adds the points of another one, of the same classes.
  SegmentationConfusion& operator+=(const SegmentationConfusion& other);

  std::size_t classes() const { return classes_; }
  /// Points by the numbers of their classes; classes(): of none.
  std::uint64_t count(std::size_t truth, std::size_t predicted) const;
  std::uint64_t points() const;                 ///< that truly are of a class
  std::uint64_t ignored() const;                ///< that truly are of none
  std::uint64_t of_truth(std::size_t c) const;  ///< points that truly are of a class
  /// Points that truly are of any class and predicted to be of this one.
  std::uint64_t of_prediction(std::size_t c) const;

  // Shares from 0 to 1; NaN of nothing.
  double accuracy() const;                ///< points whose class is predicted
  double share(std::size_t c) const;      ///< of a class among the true points
  double recall(std::size_t c) const;     ///< of a class's true points that are predicted
  double precision(std::size_t c) const;  ///< of a class's predicted points that are true
  /// Intersection over union: points of a class that are predicted, of those that are of it or are
  /// predicted to be.
  double iou(std::size_t c) const;
  /// Whether there are true points of a class, but with less than that share.
  bool is_rare(std::size_t c, double min_share) const;
  /// Mean IoU of the classes that there are true points of, but for rare ones.
  double mean_iou(double min_share = 0) const;

 private:
  std::size_t classes_;
  std::vector<std::uint64_t> counts_;  ///< rows of true classes, none last
};

/// "ground", "surface", "linear", "non-surface" (SemanticGroup) of what stays, and "movable".
std::vector<std::string> segmentation_groups();

/// The same points by their groups: within one, another class is no error.
SegmentationConfusion grouped(const SegmentationConfusion& confusion,
                              const BenchmarkClasses& classes);

struct SegmentationResult {
  BenchmarkClasses classes;
  SegmentationConfusion confusion;
  SegmentationOptions options;
};

/// Errors: usage (a least share that is not from 0 to 1).
void check(const SegmentationOptions& options);

}  // namespace adasplats
