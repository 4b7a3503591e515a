// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_segmentation.h"

#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/jobs/evaluate/label_files.h"

namespace adasplats {
namespace {

SegmentationResult no_points_of(const std::string& labels, const SegmentationOptions& options) {
  check(options);
  BenchmarkClasses classes(load_label_scheme(labels));
  SegmentationConfusion confusion(classes.classes().size());
  return {std::move(classes), std::move(confusion), options};
}

void add_files(const LabelFilePair& files, Session& session, SegmentationResult& result) {
  const std::vector<std::uint16_t> predicted = read_point_classes(files.predicted, session);
  const std::vector<std::uint16_t> truth = read_point_classes(files.truth, session);
  try {
    result.confusion.add(predicted, truth, result.classes, session.executor);
  } catch (const Error& error) {
    throw Error(error.kind(),
                files.predicted.string() + " and " + files.truth.string() + ": " + error.what());
  }
}

void require_judged(const SegmentationResult& result) {
  if (result.confusion.points() > 0) return;
  throw Error(ErrorKind::data, "none of the " + std::to_string(result.confusion.ignored()) +
                                   " true points is of a class that counts");
}

}  // namespace

SegmentationResult evaluate_segmentation(const SegmentationJob& job, Session& session) {
  SegmentationResult result = no_points_of(job.labels, job.options);
  const std::vector<LabelFilePair> pairs = pair_label_files(job.predicted, job.truth, job.scans);
  session.progress.begin_step("compare labels", pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    session.executor.check_interruption();
    add_files(pairs[i], session, result);
    session.progress.advance(i + 1);
  }
  session.progress.end_step();
  require_judged(result);
  return result;
}

SegmentationResult evaluate_segmentation(std::span<const std::uint16_t> predicted,
                                         std::span<const std::uint16_t> truth,
                                         const std::string& labels,
                                         const SegmentationOptions& options, Session& session) {
  SegmentationResult result = no_points_of(labels, options);
  result.confusion.add(predicted, truth, result.classes, session.executor);
  require_judged(result);
  return result;
}

}  // namespace adasplats
