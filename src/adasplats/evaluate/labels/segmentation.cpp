// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/labels/segmentation.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/share.h"

namespace adasplats {
namespace {

constexpr std::size_t kMovableGroup = kSemanticGroups;

/// No scheme has this id: ids have 16 bits.
constexpr std::uint32_t kNoId = std::numeric_limits<std::uint32_t>::max();

/// The counts of a chunk of points, and the smallest ids that the scheme does not have, so the
/// error does not depend on the order of chunks.
struct ChunkCounts {
  SegmentationConfusion confusion;
  std::uint32_t unknown_prediction = kNoId;
  std::uint32_t unknown_truth = kNoId;

  ChunkCounts& operator+=(const ChunkCounts& other) {
    confusion += other.confusion;
    unknown_prediction = std::min(unknown_prediction, other.unknown_prediction);
    unknown_truth = std::min(unknown_truth, other.unknown_truth);
    return *this;
  }
};

void require_known(std::uint32_t unknown, const char* of, const BenchmarkClasses& classes) {
  if (unknown == kNoId) return;
  throw Error(ErrorKind::data, "class " + std::to_string(unknown) + " of the " + of +
                                   " labels is not in the label scheme '" + classes.scheme() + "'");
}

std::size_t group_of(const BenchmarkClass& c) {
  return c.is_movable ? kMovableGroup : static_cast<std::size_t>(c.group);
}

}  // namespace

SegmentationConfusion::SegmentationConfusion(std::size_t classes)
    : classes_(classes), counts_((classes + 1) * (classes + 1)) {}

void SegmentationConfusion::add(std::span<const std::uint16_t> predicted,
                                std::span<const std::uint16_t> truth,
                                const BenchmarkClasses& classes, const Executor& executor) {
  assert(classes.classes().size() == classes_);
  if (predicted.size() != truth.size())
    throw Error(ErrorKind::data, std::to_string(predicted.size()) + " predicted labels, " +
                                     std::to_string(truth.size()) + " true ones");
  const ChunkCounts none{SegmentationConfusion(classes_)};
  const auto count_chunk = [&](std::size_t begin, std::size_t end) {
    ChunkCounts counts = none;
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<std::size_t> has = classes.find(predicted[i]);
      const std::optional<std::size_t> expected = classes.find(truth[i]);
      if (!has)
        counts.unknown_prediction =
            std::min<std::uint32_t>(counts.unknown_prediction, predicted[i]);
      if (!expected) counts.unknown_truth = std::min<std::uint32_t>(counts.unknown_truth, truth[i]);
      if (has && expected) counts.confusion.add(*expected, *has, 1);
    }
    return counts;
  };
  const ChunkCounts counts = executor.sum_chunks(truth.size(), kCoarseGrain, none, count_chunk);
  require_known(counts.unknown_prediction, "predicted", classes);
  require_known(counts.unknown_truth, "true", classes);
  *this += counts.confusion;
}

void SegmentationConfusion::add(std::size_t truth, std::size_t predicted, std::uint64_t points) {
  assert(truth <= classes_ && predicted <= classes_);
  counts_[truth * (classes_ + 1) + predicted] += points;
}

SegmentationConfusion& SegmentationConfusion::operator+=(const SegmentationConfusion& other) {
  assert(other.classes_ == classes_);
  for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += other.counts_[k];
  return *this;
}

std::uint64_t SegmentationConfusion::count(std::size_t truth, std::size_t predicted) const {
  return counts_[truth * (classes_ + 1) + predicted];
}

std::uint64_t SegmentationConfusion::of_truth(std::size_t c) const {
  std::uint64_t points = 0;
  for (std::size_t k = 0; k <= classes_; ++k) points += count(c, k);
  return points;
}

std::uint64_t SegmentationConfusion::of_prediction(std::size_t c) const {
  std::uint64_t points = 0;
  for (std::size_t k = 0; k < classes_; ++k) points += count(k, c);
  return points;
}

std::uint64_t SegmentationConfusion::points() const {
  std::uint64_t points = 0;
  for (std::size_t c = 0; c < classes_; ++c) points += of_truth(c);
  return points;
}

std::uint64_t SegmentationConfusion::ignored() const { return of_truth(classes_); }

double SegmentationConfusion::accuracy() const {
  std::uint64_t right = 0;
  for (std::size_t c = 0; c < classes_; ++c) right += count(c, c);
  return share_of(right, points());
}

double SegmentationConfusion::share(std::size_t c) const { return share_of(of_truth(c), points()); }

double SegmentationConfusion::recall(std::size_t c) const {
  return share_of(count(c, c), of_truth(c));
}

double SegmentationConfusion::precision(std::size_t c) const {
  return share_of(count(c, c), of_prediction(c));
}

double SegmentationConfusion::iou(std::size_t c) const {
  return share_of(count(c, c), of_truth(c) + of_prediction(c) - count(c, c));
}

bool SegmentationConfusion::is_rare(std::size_t c, double min_share) const {
  return of_truth(c) > 0 && share(c) < min_share;
}

double SegmentationConfusion::mean_iou(double min_share) const {
  double sum = 0;
  std::size_t averaged = 0;
  for (std::size_t c = 0; c < classes_; ++c) {
    if (of_truth(c) == 0 || is_rare(c, min_share)) continue;
    sum += iou(c);
    ++averaged;
  }
  return averaged == 0 ? kNaN : sum / static_cast<double>(averaged);
}

std::vector<std::string> segmentation_groups() {
  std::vector<std::string> names;
  names.reserve(kMovableGroup + 1);
  for (int group = 0; group < kSemanticGroups; ++group)
    names.emplace_back(name_of(static_cast<SemanticGroup>(group)));
  names.emplace_back("movable");
  return names;
}

SegmentationConfusion grouped(const SegmentationConfusion& confusion,
                              const BenchmarkClasses& classes) {
  std::vector<std::size_t> groups;
  for (const BenchmarkClass& c : classes.classes()) groups.push_back(group_of(c));
  groups.push_back(kMovableGroup + 1);  // none
  SegmentationConfusion result(kMovableGroup + 1);
  for (std::size_t truth = 0; truth < groups.size(); ++truth)
    for (std::size_t predicted = 0; predicted < groups.size(); ++predicted)
      result.add(groups[truth], groups[predicted], confusion.count(truth, predicted));
  return result;
}

void check(const SegmentationOptions& options) {
  if (options.min_share >= 0 && options.min_share <= 1) return;
  throw Error(ErrorKind::usage,
              "`min_share` must be from 0 to 1, found " + std::to_string(options.min_share));
}

}  // namespace adasplats
