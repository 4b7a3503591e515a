// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/cell_features.h"
#include "adasplats/segment/network/run_network.h"
#include "adasplats/segment/pyramid/pyramid.h"
#include "adasplats/segment/segment_engine.h"

namespace adasplats {
namespace {

class CpuTileSegmenter final : public TileSegmenter {
 public:
  CpuTileSegmenter(const SegmentTask& task, const Executor& executor)
      : task_(task), executor_(executor) {
    const std::size_t wanted = std::min(task.options.wanted, task.cloud.size());
    result_.classes.resize(wanted);
    if (task.options.confidences) result_.confidences.resize(wanted);
    if (task.options.probabilities)
      result_.probabilities.resize(wanted * task.network.classes.size());
  }

  std::size_t segment(const SegmentTile& tile) override {
    std::vector<Vec3f> points;
    points.reserve(tile.indices.size());
    for (const std::uint32_t i : tile.indices)
      points.push_back(task_.cloud.positions[i] - tile.corner);
    CellMeans cells = means_by_cell(points, task_.network.shape.cell_m, executor_);
    std::vector<float> features = features_of(cells, tile.indices);
    const std::size_t count = cells.means.size();
    const std::vector<PyramidLevel> levels =
        make_pyramid(std::move(cells.means), task_.network.shape, executor_);
    const std::vector<float> logits =
        run_network(task_.network, levels, std::move(features), executor_);
    for (std::size_t k = 0; k < tile.wanted; ++k) take(tile.indices[k], cells.cell_of[k], logits);
    return count;
  }

  void finish(Segmentation& result) override {
    result.classes = std::move(result_.classes);
    result.confidences = std::move(result_.confidences);
    result.probabilities = std::move(result_.probabilities);
  }

 private:
  std::vector<float> features_of(const CellMeans& cells,
                                 std::span<const std::uint32_t> indices) const {
    const std::vector<float> heights = heights_above_ground(cells.means);
    const std::vector<float> intensities =
        task_.has_intensity ? mean_intensities(cells, indices) : std::vector<float>(heights.size());
    std::vector<float> features;
    features.reserve(heights.size() * task_.network.features.size());
    for (std::size_t i = 0; i < heights.size(); ++i)
      for (const PointFeature feature : task_.network.features)
        features.push_back(feature_of(feature, {heights[i], intensities[i], task_.has_intensity},
                                      task_.network.height_unit_m));
    return features;
  }

  std::vector<float> mean_intensities(const CellMeans& cells,
                                      std::span<const std::uint32_t> indices) const {
    std::vector<float> sums(cells.means.size()), counts(cells.means.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
      sums[cells.cell_of[k]] +=
          intensity_share(task_.cloud.intensities[indices[k]], task_.full_intensity);
      ++counts[cells.cell_of[k]];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
    return sums;
  }

  void take(std::uint32_t point, std::size_t cell, const std::vector<float>& logits) {
    const std::size_t classes = task_.network.classes.size();
    const float* const own = logits.data() + cell * classes;
    const std::uint8_t best = class_of_logits(own, classes);
    result_.classes[point] = best;
    if (!task_.options.confidences && !task_.options.probabilities) return;
    const float confidence = confidence_of_logits(own, classes, best);
    if (task_.options.confidences) result_.confidences[point] = confidence;
    if (!task_.options.probabilities) return;
    for (std::size_t c = 0; c < classes; ++c)
      result_.probabilities[point * classes + c] = probability_of_logits(own, c, best, confidence);
  }

  const SegmentTask& task_;
  const Executor& executor_;
  Segmentation result_;
};

class CpuSegmentEngine final : public SegmentEngine {
 public:
  explicit CpuSegmentEngine(const Executor& executor) : executor_(executor) {}

  std::string_view name() const override { return "cpu"; }
  std::unique_ptr<TileSegmenter> start(const SegmentTask& task) const override {
    require_products();
    return std::make_unique<CpuTileSegmenter>(task, executor_);
  }

 private:
  const Executor& executor_;
};

}  // namespace

std::unique_ptr<SegmentEngine> make_cpu_segment_engine(const Executor& executor) {
  return std::make_unique<CpuSegmentEngine>(executor);
}

}  // namespace adasplats
