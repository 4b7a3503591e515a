// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/gpu/segment/device_network.h"
#include "adasplats/segment/network/run_network.h"

namespace adasplats::gpu {
namespace {

constexpr std::uint32_t kConvolveWarps = 4;                 // per block
constexpr std::uint32_t kAtOnce = 16;                       // kernel points at a time
constexpr std::size_t kMaxWeighted = std::size_t{1} << 26;  // numbers in memory at a time

/// Neighbours of a layer's points.
struct ReachView {
  const Vec3f* points;
  const Vec3f* supports;
  const std::uint32_t* table;
  const Vec3f* kernel;
  std::uint32_t slots, kernel_points;
  float cell_m, sigma_m;
};

struct Influences {
  float of[kWarpLanes][kAtOnce];
  std::uint32_t index[kWarpLanes];
};

/// Lane k computes the weights of neighbour slot + k for `kAtOnce` kernel points; returns the
/// number of these neighbours.
__device__ std::uint32_t fill(const ReachView& reach, std::uint64_t point, std::uint32_t slot,
                              std::uint32_t first_kernel, Influences& mine) {
  const std::uint32_t lane = lane_of_thread();
  const std::uint32_t index = slot + lane < reach.slots
                                  ? reach.table[point * reach.slots + slot + lane]
                                  : NeighborTable::kNone;
  const bool is_there = index != NeighborTable::kNone;
  __syncwarp();
  if (is_there) {
    mine.index[lane] = index;
    const Vec3f way = reach.supports[index] - reach.points[point];
    for (std::uint32_t k = 0; k < kAtOnce; ++k)
      mine.of[lane][k] = first_kernel + k < reach.kernel_points
                             ? fmaxf(0.0F, kernel_influence(way, reach.kernel[first_kernel + k],
                                                            reach.cell_m, reach.sigma_m))
                             : 0.0F;
  }
  __syncwarp();
  return __popc(__ballot_sync(kAllLanes, is_there));
}

/// Weighted sums over the neighbours of points [first, first + count) for each kernel point: a warp
/// per point, a lane per channel; with fewer channels, groups of lanes share the neighbours.
__global__ void __launch_bounds__(kConvolveWarps* kWarpLanes)
    weighted_kernel(ReachView reach, std::uint64_t first, std::uint32_t count, const float* values,
                    std::uint32_t channels, float* weighted) {
  __shared__ Influences shared[kConvolveWarps];
  Influences& mine = shared[threadIdx.x / kWarpLanes];
  const std::uint32_t row = blockIdx.x * kConvolveWarps + threadIdx.x / kWarpLanes;
  if (row >= count) return;
  std::uint32_t width = kWarpLanes;
  while (width / 2 >= channels) width /= 2;
  const std::uint32_t groups = kWarpLanes / width, group = lane_of_thread() / width;
  float* const out = weighted + std::size_t{row} * reach.kernel_points * channels;
  for (std::uint32_t k0 = 0; k0 < reach.kernel_points; k0 += kAtOnce) {
    for (std::uint32_t c0 = 0; c0 < channels; c0 += width) {
      const std::uint32_t channel = c0 + lane_of_thread() % width;
      float sums[kAtOnce] = {};
      for (std::uint32_t slot = 0; slot < reach.slots; slot += kWarpLanes) {
        const std::uint32_t found = fill(reach, first + row, slot, k0, mine);
        for (std::uint32_t h = group; h < found; h += groups) {
          const float value =
              channel < channels ? values[std::size_t{mine.index[h]} * channels + channel] : 0;
#pragma unroll
          for (std::uint32_t k = 0; k < kAtOnce; ++k) sums[k] += mine.of[h][k] * value;
        }
      }
#pragma unroll
      for (std::uint32_t k = 0; k < kAtOnce; ++k) {
        for (std::uint32_t apart = width; apart < kWarpLanes; apart *= 2)
          sums[k] += __shfl_xor_sync(kAllLanes, sums[k], apart);
        if (group == 0 && channel < channels && k0 + k < reach.kernel_points)
          out[std::size_t{k0 + k} * channels + channel] = sums[k];
      }
    }
  }
}

constexpr std::uint32_t kTile = 64, kInner = 16, kOwn = 4, kProductThreads = 256;

struct Product {
  const float* a;  // (rows, inner)
  const float* b;  // (inner, columns)
  const float* bias;
  float* c;
  std::uint64_t rows;
  std::uint32_t inner, columns;
  float slope;
};

/// c = activated(a * b + bias), 64 x 64 per block, 4 x 4 per thread; each sum in the order of
/// `inner`.
__global__ void __launch_bounds__(kProductThreads) product_kernel(Product product) {
  __shared__ float of_a[kInner][kTile + 4];
  __shared__ float of_b[kInner][kTile];
  const std::uint64_t row0 = std::uint64_t{blockIdx.x} * kTile;
  const std::uint32_t column0 = blockIdx.y * kTile;
  const std::uint32_t x = threadIdx.x % 16, y = threadIdx.x / 16;
  float sums[kOwn][kOwn] = {};
  for (std::uint32_t inner0 = 0; inner0 < product.inner; inner0 += kInner) {
    for (std::uint32_t i = threadIdx.x; i < kTile * kInner; i += kProductThreads) {
      const std::uint32_t k = i % kInner, r = i / kInner;
      const bool is_there = row0 + r < product.rows && inner0 + k < product.inner;
      of_a[k][r] = is_there ? product.a[(row0 + r) * product.inner + inner0 + k] : 0;
    }
    for (std::uint32_t i = threadIdx.x; i < kTile * kInner; i += kProductThreads) {
      const std::uint32_t k = i / kTile, c = i % kTile;
      const bool is_there = inner0 + k < product.inner && column0 + c < product.columns;
      of_b[k][c] =
          is_there ? product.b[std::size_t{inner0 + k} * product.columns + column0 + c] : 0;
    }
    __syncthreads();
#pragma unroll
    for (std::uint32_t k = 0; k < kInner; ++k) {
      const float4 a = *reinterpret_cast<const float4*>(&of_a[k][kOwn * y]);
      const float4 b = *reinterpret_cast<const float4*>(&of_b[k][kOwn * x]);
      const float rows[kOwn] = {a.x, a.y, a.z, a.w}, columns[kOwn] = {b.x, b.y, b.z, b.w};
      for (std::uint32_t r = 0; r < kOwn; ++r)
        for (std::uint32_t c = 0; c < kOwn; ++c) sums[r][c] = fmaf(rows[r], columns[c], sums[r][c]);
    }
    __syncthreads();
  }
  for (std::uint32_t r = 0; r < kOwn; ++r) {
    for (std::uint32_t c = 0; c < kOwn; ++c) {
      const std::uint64_t row = row0 + kOwn * y + r;
      const std::uint32_t column = column0 + kOwn * x + c;
      if (row < product.rows && column < product.columns)
        product.c[row * product.columns + column] =
            activated(sums[r][c] + product.bias[column], product.slope);
    }
  }
}

void multiply(const Product& product, cudaStream_t stream) {
  if (product.rows == 0) return;
  const dim3 blocks(static_cast<unsigned>((product.rows + kTile - 1) / kTile),
                    (product.columns + kTile - 1) / kTile);
  product_kernel<<<blocks, kProductThreads, 0, stream>>>(product);
  cuda_check(cudaGetLastError(), "multiply matrices");
}

/// Numbers of the points of a level, point by point.
struct DeviceValues {
  std::size_t width = 0;
  DeviceBuffer<float> numbers;
};

}  // namespace

/// One run of a network.
class DeviceRun {
 public:
  DeviceRun(const DeviceNetwork& network, std::span<const DeviceLevel> levels, cudaStream_t stream)
      : device_(network),
        network_(network.network_),
        levels_(levels),
        stream_(stream),
        values_(network.network_.values),
        last_use_(last_uses(network.network_)) {}

  DeviceBuffer<float> logits(DeviceBuffer<float> features) {
    values_[0] = {network_.features.size(), std::move(features)};
    for (std::size_t k = 0; k < network_.layers.size(); ++k) {
      const Layer& layer = network_.layers[k];
      values_[layer.output] = result_of(layer);
      for (std::size_t v = 0; v < values_.size(); ++v)
        if (last_use_[v] == k && v != layer.output) values_[v] = {};
    }
    return std::move(values_[network_.layers.back().output].numbers);
  }

  // Public because nvcc requires it for functions with extended device lambdas.
  const DeviceLevel& level(int k) const { return levels_[static_cast<std::size_t>(k)]; }

  DeviceValues result_of(const Layer& layer) const {
    switch (layer.kind) {
      case LayerKind::convolution: return convolution(layer);
      case LayerKind::unary: return unary(layer);
      case LayerKind::largest: return largest(layer);
      case LayerKind::add: return sum(layer);
      case LayerKind::upsample: return upsampled(layer);
      case LayerKind::join: return joined(layer);
    }
    return {};
  }

  DeviceValues room_for(const Layer& layer, std::size_t width) const {
    return {width, DeviceBuffer<float>(level(layer.level).points.size() * width, stream_)};
  }

  Product product_of(const Layer& layer, const float* a, float* c, std::uint64_t rows) const {
    const Weights& weight = network_.weights[layer.weight];
    return {a,
            device_.weights_[layer.weight].data(),
            device_.weights_[layer.bias].data(),
            c,
            rows,
            static_cast<std::uint32_t>(weight.rows),
            static_cast<std::uint32_t>(weight.columns),
            layer.slope};
  }

  DeviceValues unary(const Layer& layer) const {
    DeviceValues result = room_for(layer, network_.weights[layer.weight].columns);
    multiply(product_of(layer, values_[layer.input].numbers.data(), result.numbers.data(),
                        level(layer.level).points.size()),
             stream_);
    return result;
  }

  ReachView reach_of(const Layer& layer) const {
    const bool is_strided = layer.strided || layer.kind == LayerKind::largest;
    const DeviceLevel& supports = level(is_strided ? layer.level - 1 : layer.level);
    return {level(layer.level).points.data(),
            supports.points.data(),
            (is_strided ? supports.pooled : supports.neighbors).data(),
            device_.kernel_.data(),
            network_.shape.neighbors,
            static_cast<std::uint32_t>(network_.kernel.size()),
            supports.cell_m,
            network_.sigma * supports.cell_m};
  }

  DeviceValues convolution(const Layer& layer) const {
    const DeviceValues& input = values_[layer.input];
    const Weights& weight = network_.weights[layer.weight];
    const ReachView reach = reach_of(layer);
    DeviceValues result = room_for(layer, weight.columns);
    const std::size_t points = level(layer.level).points.size();
    const std::size_t at_once =
        std::min(points, std::max<std::size_t>(1, kMaxWeighted / weight.rows));
    const DeviceBuffer<float> weighted(at_once * weight.rows, stream_);
    for (std::size_t first = 0; first < points; first += at_once) {
      const auto count = static_cast<std::uint32_t>(std::min(at_once, points - first));
      weighted_kernel<<<(count + kConvolveWarps - 1) / kConvolveWarps, kConvolveWarps * kWarpLanes,
                        0, stream_>>>(reach, first, count, input.numbers.data(),
                                      static_cast<std::uint32_t>(input.width), weighted.data());
      cuda_check(cudaGetLastError(), "weigh neighbours");
      multiply(
          product_of(layer, weighted.data(), result.numbers.data() + first * weight.columns, count),
          stream_);
    }
    return result;
  }

  DeviceValues largest(const Layer& layer) const {
    const DeviceValues& input = values_[layer.input];
    DeviceValues result = room_for(layer, input.width);
    for_each(result.numbers.size(), stream_, "pool neighbours",
             [reach = reach_of(layer), width = input.width, from = input.numbers.data(),
              to = result.numbers.data()] __device__(std::uint64_t i) {
               const std::uint32_t* const row = reach.table + i / width * reach.slots;
               const bool is_full = row[reach.slots - 1] != NeighborTable::kNone;
               float best = is_full ? -HUGE_VALF : 0.0F;
               for (std::uint32_t h = 0; h < reach.slots && row[h] != NeighborTable::kNone; ++h)
                 best = fmaxf(best, from[row[h] * width + i % width]);
               to[i] = best;
             });
    return result;
  }

  DeviceValues sum(const Layer& layer) const {
    const DeviceValues &first = values_[layer.input], &second = values_[layer.second];
    DeviceValues result = room_for(layer, first.width);
    for_each(result.numbers.size(), stream_, "add values",
             [slope = layer.slope, a = first.numbers.data(), b = second.numbers.data(),
              to = result.numbers.data()] __device__(std::uint64_t i) {
               to[i] = activated(a[i] + b[i], slope);
             });
    return result;
  }

  DeviceValues upsampled(const Layer& layer) const {
    const DeviceValues& input = values_[layer.input];
    DeviceValues result = room_for(layer, input.width);
    for_each(result.numbers.size(), stream_, "copy values to the finer grid",
             [width = input.width, coarser = level(layer.level).coarser.data(),
              from = input.numbers.data(), to = result.numbers.data()] __device__(std::uint64_t i) {
               to[i] = from[coarser[i / width] * width + i % width];
             });
    return result;
  }

  DeviceValues joined(const Layer& layer) const {
    const DeviceValues &first = values_[layer.input], &second = values_[layer.second];
    const std::size_t width = first.width + second.width;
    DeviceValues result = room_for(layer, width);
    for_each(result.numbers.size(), stream_, "join values",
             [width, of_first = first.width, of_second = second.width, a = first.numbers.data(),
              b = second.numbers.data(), to = result.numbers.data()] __device__(std::uint64_t i) {
               const std::uint64_t point = i / width, column = i % width;
               to[i] = column < of_first ? a[point * of_first + column]
                                         : b[point * of_second + column - of_first];
             });
    return result;
  }

 private:
  const DeviceNetwork& device_;
  const Network& network_;
  std::span<const DeviceLevel> levels_;
  cudaStream_t stream_;
  std::vector<DeviceValues> values_;
  std::vector<std::size_t> last_use_;
};

DeviceNetwork::DeviceNetwork(const Network& network, cudaStream_t stream)
    : network_(network),
      kernel_(std::span<const Vec3f>(network.kernel), stream),
      features_(std::span<const PointFeature>(network.features), stream) {
  for (const Weights& weight : network.weights)
    weights_.emplace_back(std::span<const float>(weight.values), stream);
}

DeviceBuffer<float> DeviceNetwork::logits(std::span<const DeviceLevel> levels,
                                          DeviceBuffer<float> features, cudaStream_t stream) const {
  return DeviceRun(*this, levels, stream).logits(std::move(features));
}

}  // namespace adasplats::gpu
