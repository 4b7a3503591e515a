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
  /// Classes with a smaller share of the true points are left out of the mean, because few objects
  /// determine their IoU.
  double min_share = 0.0005;
};

/// Points by true and predicted class. Points without a true class are counted, but do not affect
/// the metrics. A point of a class that is predicted to have none is a miss of its class, as in the
/// scripts of SemanticKITTI's benchmark (whose accuracy leaves such points out; here they are
/// wrong).
class SegmentationConfusion {
 public:
  explicit SegmentationConfusion(std::size_t classes = 0);

  /// Adds the points of a scan; labels are ids of the scheme of `classes`. Errors: data (different
  /// numbers of labels, an id that the scheme does not have).
  void add(std::span<const std::uint16_t> predicted, std::span<const std::uint16_t> truth,
           const BenchmarkClasses& classes, const Executor& executor);
  /// Adds points by the indices of their classes; classes(): no class.
  void add(std::size_t truth, std::size_t predicted, std::uint64_t points);
  /// Adds the points of another confusion of the same classes.
  SegmentationConfusion& operator+=(const SegmentationConfusion& other);

  std::size_t classes() const { return classes_; }
  /// Points by the indices of their classes; classes(): no class.
  std::uint64_t count(std::size_t truth, std::size_t predicted) const;
  std::uint64_t points() const;                 ///< with a true class
  std::uint64_t ignored() const;                ///< without a true class
  std::uint64_t of_truth(std::size_t c) const;  ///< points of this true class
  /// Points with any true class that are predicted to be of this one.
  std::uint64_t of_prediction(std::size_t c) const;

  // Shares from 0 to 1; NaN without points.
  double accuracy() const;                ///< points with a correct prediction
  double share(std::size_t c) const;      ///< of a class among the true points
  double recall(std::size_t c) const;     ///< of a class's true points that are predicted
  double precision(std::size_t c) const;  ///< of a class's predicted points that are true
  /// Intersection over union: correctly predicted points of a class, divided by the points that are
  /// of the class or predicted to be.
  double iou(std::size_t c) const;
  /// Whether a class has true points, but a smaller share than `min_share`.
  bool is_rare(std::size_t c, double min_share) const;
  /// Mean IoU of the classes with true points, without rare ones.
  double mean_iou(double min_share = 0) const;

 private:
  std::size_t classes_;
  std::vector<std::uint64_t> counts_;  ///< rows of true classes, no class last
};

/// "ground", "surface", "linear", "non-surface" (SemanticGroup) of static classes, and "movable".
std::vector<std::string> segmentation_groups();

/// The same points by group: another class of the same group is not an error.
SegmentationConfusion grouped(const SegmentationConfusion& confusion,
                              const BenchmarkClasses& classes);

struct SegmentationResult {
  BenchmarkClasses classes;
  SegmentationConfusion confusion;
  SegmentationOptions options;
};

/// Errors: usage (a minimum share outside 0 to 1).
void check(const SegmentationOptions& options);

}  // namespace adasplats
