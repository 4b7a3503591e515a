// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/network/run_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adasplats/core/error.h"

#ifdef ADASPLATS_OPENBLAS
#include <cblas.h>
#endif

namespace adasplats {

#ifdef ADASPLATS_OPENBLAS

void require_products() {
  // Its own threads would compete with ours, and the order of sums would depend on them.
  static const bool kAlone = [] {
    openblas_set_num_threads(1);
    return true;
  }();
  static_cast<void>(kAlone);
}

void multiply(const float* a, const float* b, float* c, std::size_t rows, std::size_t inner,
              std::size_t columns) {
  require_products();
  const auto m = static_cast<blasint>(rows), k = static_cast<blasint>(inner),
             n = static_cast<blasint>(columns);
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, m, n, k, 1.0F, a, k, b, n, 0.0F, c, n);
}

#else

void require_products() {
  throw Error(ErrorKind::unavailable,
              "this program was built without OpenBLAS, which networks need; install "
              "libopenblas-dev and build again");
}

void multiply(const float*, const float*, float*, std::size_t, std::size_t, std::size_t) {
  require_products();
}

#endif

namespace {

constexpr std::size_t kRows = 256;  // points per product
constexpr std::size_t kMaxKernel = 64;

/// Numbers of the points of a level, point by point.
struct Values {
  std::size_t width = 0;
  std::vector<float> numbers;

  const float* of(std::size_t point) const { return numbers.data() + point * width; }
};

/// One run of a network.
class Run {
 public:
  Run(const Network& network, std::span<const PyramidLevel> levels, const Executor& executor)
      : network_(network),
        levels_(levels),
        executor_(executor),
        values_(network.values),
        last_use_(last_uses(network)) {}

  std::vector<float> logits(std::vector<float> features) {
    values_[0] = {network_.features.size(), std::move(features)};
    for (std::size_t k = 0; k < network_.layers.size(); ++k) {
      const Layer& layer = network_.layers[k];
      values_[layer.output] = result_of(layer);
      for (Values& value : values_)
        if (last_use_[static_cast<std::size_t>(&value - values_.data())] == k &&
            &value != &values_[layer.output])
          value = {};
    }
    return std::move(values_[network_.layers.back().output].numbers);
  }

 private:
  const PyramidLevel& level(int k) const { return levels_[static_cast<std::size_t>(k)]; }

  Values result_of(const Layer& layer) const {
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

  /// Calls body(point, numbers) for all points of the layer's level.
  template <class Body>
  Values each_point(const Layer& layer, std::size_t width, Body&& body) const {
    Values result{width, std::vector<float>(level(layer.level).points.size() * width)};
    executor_.for_chunks(level(layer.level).points.size(), kRows,
                         [&](std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i)
                             body(i, result.numbers.data() + i * width);
                         });
    return result;
  }

  void finish(const Layer& layer, float* numbers, std::size_t rows, std::size_t columns) const {
    const std::vector<float>& bias = network_.weights[layer.bias].values;
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c, ++numbers)
        *numbers = activated(*numbers + bias[c], layer.slope);
  }

  Values unary(const Layer& layer) const {
    const Values& input = values_[layer.input];
    const Weights& weight = network_.weights[layer.weight];
    const std::size_t points = level(layer.level).points.size();
    Values result{weight.columns, std::vector<float>(points * weight.columns)};
    executor_.for_chunks(points, kRows, [&](std::size_t begin, std::size_t end) {
      float* const out = result.numbers.data() + begin * weight.columns;
      multiply(input.of(begin), weight.values.data(), out, end - begin, weight.rows,
               weight.columns);
      finish(layer, out, end - begin, weight.columns);
    });
    return result;
  }

  /// Neighbours of a layer's points, and their level.
  struct Reach {
    const NeighborTable* table;
    const PyramidLevel* supports;
  };
  Reach reach_of(const Layer& layer) const {
    const bool strided = layer.strided || layer.kind == LayerKind::largest;
    const PyramidLevel& supports = level(strided ? layer.level - 1 : layer.level);
    return {strided ? &supports.pooled : &supports.neighbors, &supports};
  }

  Values convolution(const Layer& layer) const {
    const Values& input = values_[layer.input];
    const Weights& weight = network_.weights[layer.weight];
    const Reach reach = reach_of(layer);
    const std::vector<Vec3f>& points = level(layer.level).points;
    Values result{weight.columns, std::vector<float>(points.size() * weight.columns)};
    executor_.for_chunks(points.size(), kRows, [&](std::size_t begin, std::size_t end) {
      std::vector<float> weighted((end - begin) * weight.rows);
      for (std::size_t i = begin; i < end; ++i)
        add_neighbors(points[i], reach, reach.table->of(i), input,
                      weighted.data() + (i - begin) * weight.rows);
      float* const out = result.numbers.data() + begin * weight.columns;
      multiply(weighted.data(), weight.values.data(), out, end - begin, weight.rows,
               weight.columns);
      finish(layer, out, end - begin, weight.columns);
    });
    return result;
  }

  /// Adds the neighbours, weighted for each kernel point (KPConv, equations 2 and 3).
  void add_neighbors(Vec3f point, const Reach& reach, std::span<const std::uint32_t> neighbors,
                     const Values& input, float* weighted) const {
    const float cell_m = reach.supports->cell_m;
    const float sigma_m = network_.sigma * cell_m;
    std::array<float, kMaxKernel> influences{};
    for (const std::uint32_t j : neighbors) {
      if (j == NeighborTable::kNone) break;
      const Vec3f way = reach.supports->points[j] - point;
      for (std::size_t k = 0; k < network_.kernel.size(); ++k)
        influences[k] = kernel_influence(way, network_.kernel[k], cell_m, sigma_m);
      const float* const of_neighbor = input.of(j);
      for (std::size_t k = 0; k < network_.kernel.size(); ++k) {
        const float influence = influences[k];
        if (!(influence > 0)) continue;
        float* const own = weighted + k * input.width;
        for (std::size_t c = 0; c < input.width; ++c) own[c] += influence * of_neighbor[c];
      }
    }
  }

  Values largest(const Layer& layer) const {
    const Values& input = values_[layer.input];
    const Reach reach = reach_of(layer);
    return each_point(layer, input.width, [&](std::size_t i, float* own) {
      const std::span<const std::uint32_t> neighbors = reach.table->of(i);
      const bool is_full = neighbors.back() != NeighborTable::kNone;
      std::fill_n(own, input.width, is_full ? -std::numeric_limits<float>::infinity() : 0.0F);
      for (const std::uint32_t j : neighbors) {
        if (j == NeighborTable::kNone) break;
        for (std::size_t c = 0; c < input.width; ++c) own[c] = std::max(own[c], input.of(j)[c]);
      }
    });
  }

  Values sum(const Layer& layer) const {
    const Values &first = values_[layer.input], &second = values_[layer.second];
    return each_point(layer, first.width, [&](std::size_t i, float* own) {
      for (std::size_t c = 0; c < first.width; ++c)
        own[c] = activated(first.of(i)[c] + second.of(i)[c], layer.slope);
    });
  }

  Values upsampled(const Layer& layer) const {
    const Values& input = values_[layer.input];
    return each_point(layer, input.width, [&](std::size_t i, float* own) {
      std::copy_n(input.of(level(layer.level).coarser[i]), input.width, own);
    });
  }

  Values joined(const Layer& layer) const {
    const Values &first = values_[layer.input], &second = values_[layer.second];
    return each_point(layer, first.width + second.width, [&](std::size_t i, float* own) {
      std::copy_n(second.of(i), second.width, std::copy_n(first.of(i), first.width, own));
    });
  }

  const Network& network_;
  std::span<const PyramidLevel> levels_;
  const Executor& executor_;
  std::vector<Values> values_;
  std::vector<std::size_t> last_use_;  ///< layer after which a value is freed
};

}  // namespace

std::vector<float> run_network(const Network& network, std::span<const PyramidLevel> levels,
                               std::vector<float> features, const Executor& executor) {
  require_products();
  return Run(network, levels, executor).logits(std::move(features));
}

}  // namespace adasplats
