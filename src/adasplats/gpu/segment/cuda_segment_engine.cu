// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/gpu/base/engines.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/segment/device_network.h"
#include "adasplats/segment/cell_features.h"

namespace adasplats {
namespace gpu {
namespace {

class CudaTileSegmenter final : public TileSegmenter {
 public:
  CudaTileSegmenter(const SegmentTask& task, int device)
      : task_(task),
        device_(device),
        guard_(device),
        pool_(device),
        network_(task.network, stream_.get()),
        positions_(std::span<const Vec3f>(task.cloud.positions), stream_.get()) {
    if (task.has_intensity)
      intensities_ =
          DeviceBuffer<float>(std::span<const float>(task.cloud.intensities), stream_.get());
    const std::size_t wanted = std::min(task.options.wanted, task.cloud.size());
    classes_ = DeviceBuffer<std::uint8_t>(wanted, stream_.get());
    if (task.options.confidences) confidences_ = DeviceBuffer<float>(wanted, stream_.get());
    if (task.options.probabilities)
      probabilities_ = DeviceBuffer<float>(wanted * task.network.classes.size(), stream_.get());
  }

  std::size_t segment(const SegmentTile& tile) override {
    const DeviceGuard guard(device_);
    const cudaStream_t stream = stream_.get();
    const DeviceBuffer<std::uint32_t> indices(tile.indices, stream);
    DeviceBuffer<Vec3f> points(indices.size(), stream);
    for_each(points.size(), stream, "take the points of a tile",
             [from = positions_.data(), of = indices.data(), to = points.data(),
              corner = tile.corner] __device__(std::uint64_t i) { to[i] = from[of[i]] - corner; });
    DeviceCellMeans cells = means_by_cell(points, task_.network.shape.cell_m, stream);
    const std::size_t count = cells.means.size();
    DeviceBuffer<float> features = features_of(cells, indices);
    const std::vector<DeviceLevel> levels =
        make_pyramid(std::move(cells.means), task_.network.shape, stream);
    take(tile.wanted, indices, cells, network_.logits(levels, std::move(features), stream));
    return count;
  }

  void finish(Segmentation& result) override {
    const DeviceGuard guard(device_);
    result.classes = classes_.download();
    if (task_.options.confidences) result.confidences = confidences_.download();
    if (task_.options.probabilities) result.probabilities = probabilities_.download();
  }

  // Public because nvcc requires it for functions with extended device lambdas.
  DeviceBuffer<float> features_of(const DeviceCellMeans& cells,
                                  const DeviceBuffer<std::uint32_t>& indices) const {
    const cudaStream_t stream = stream_.get();
    const DeviceBuffer<float> heights = heights_above_ground(cells.means, stream);
    const std::size_t width = task_.network.features.size();
    DeviceBuffer<float> features(heights.size() * width, stream);
    for_each(heights.size(), stream, "make features",
             [=, names = network_.features(), heights = heights.data(), of = indices.data(),
              order = cells.order.data(), begins = cells.begins.data(),
              intensities = intensities_.data(), has_intensity = task_.has_intensity,
              full = task_.full_intensity, unit_m = task_.network.height_unit_m,
              to = features.data()] __device__(std::uint64_t cell) {
               CellFacts facts{heights[cell], 0, has_intensity};
               if (has_intensity) {
                 float sum = 0, points = 0;
                 for (std::uint32_t k = begins[cell]; k < begins[cell + 1]; ++k, ++points)
                   sum += intensity_share(intensities[of[order[k]]], full);
                 facts.intensity = sum / points;
               }
               for (std::size_t f = 0; f < width; ++f)
                 to[cell * width + f] = feature_of(names[f], facts, unit_m);
             });
    return features;
  }

  void take(std::size_t wanted, const DeviceBuffer<std::uint32_t>& indices,
            const DeviceCellMeans& cells, const DeviceBuffer<float>& logits) {
    for_each(wanted, stream_.get(), "give points classes",
             [of = indices.data(), cell_of = cells.cell_of.data(), logits = logits.data(),
              count = task_.network.classes.size(), classes = classes_.data(),
              confidences = confidences_.data(),
              probabilities = probabilities_.data()] __device__(std::uint64_t k) {
               const float* const own = logits + cell_of[k] * count;
               const std::uint32_t point = of[k];
               const std::uint8_t best = class_of_logits(own, count);
               classes[point] = best;
               if (confidences == nullptr && probabilities == nullptr) return;
               const float confidence = confidence_of_logits(own, count, best);
               if (confidences != nullptr) confidences[point] = confidence;
               if (probabilities == nullptr) return;
               for (std::size_t c = 0; c < count; ++c)
                 probabilities[point * count + c] = probability_of_logits(own, c, best, confidence);
             });
  }

 private:
  const SegmentTask& task_;
  int device_;
  DeviceGuard guard_;
  MemoryPoolGuard pool_;
  Stream stream_;
  DeviceNetwork network_;
  DeviceBuffer<Vec3f> positions_;
  DeviceBuffer<float> intensities_;
  DeviceBuffer<std::uint8_t> classes_;
  DeviceBuffer<float> confidences_, probabilities_;
};

class CudaSegmentEngine final : public SegmentEngine {
 public:
  explicit CudaSegmentEngine(int device) : device_(device) {
    const DeviceGuard guard = enter_gpu(device, "run networks");  // or throws now
  }

  std::string_view name() const override { return "cuda"; }
  std::unique_ptr<TileSegmenter> start(const SegmentTask& task) const override {
    return std::make_unique<CudaTileSegmenter>(task, device_);
  }

 private:
  int device_;
};

}  // namespace
}  // namespace gpu

std::unique_ptr<SegmentEngine> make_cuda_segment_engine(int device) {
  return std::make_unique<gpu::CudaSegmentEngine>(device);
}

}  // namespace adasplats
