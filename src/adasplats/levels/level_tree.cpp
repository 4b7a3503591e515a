// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "adasplats/levels/level_merge.h"
#include "adasplats/levels/level_order.h"
#include "adasplats/levels/level_sample.h"

namespace adasplats {
namespace {

/// Number of nodes that are encoded in parallel.
constexpr std::size_t kBatch = 64;
/// A node has at most 1/kMinReduction of the elements that it represents.
constexpr std::size_t kMinReduction = 2;
constexpr float kMinErrorRange_m = 1e-3F;
constexpr float kMaxSignedErrorRange_m = 0.5F;
/// Maximum width of leaves, so that 16 bits give positions to 2 mm.
constexpr float kMaxLeafWidth_m = 256;

void check(const LevelInput& input, const LevelOptions& options) {
  const std::size_t size = input.disks.size() + input.positions.size();
  const auto fits = [size](std::size_t values) { return values == 0 || values == size; };
  if ((!input.disks.empty() && !input.positions.empty()) || !fits(input.classes.size()) ||
      !fits(input.intensities.size()) || !fits(input.errors_m.size()) || !fits(input.colors.size()))
    throw std::logic_error(
        "level tree: the size of an attribute differs from the number of elements");
  if (options.leaf_size < 1 || options.cells_per_side < 2)
    throw std::logic_error(
        "level tree: leaf_size must be at least 1 and cells_per_side at least 2");
}

/// The finite values; their magnitudes if `magnitudes`.
std::vector<float> finite_values(std::span<const float> values, bool magnitudes) {
  std::vector<float> finite;
  finite.reserve(values.size());
  for (const float value : values)
    if (std::isfinite(value)) finite.push_back(magnitudes ? std::fabs(value) : value);
  return finite;
}

/// The percentile of the values, which it reorders.
float percentile(std::vector<float>& values, std::size_t percent) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * percent / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

ByteRange range_of_errors(std::span<const float> errors_m) {
  std::vector<float> values = finite_values(errors_m, true);
  const float max_m =
      values.empty() ? kMinErrorRange_m : std::max(kMinErrorRange_m, percentile(values, 98));
  if (std::ranges::none_of(errors_m, [](float error_m) { return error_m < 0; })) return {0, max_m};
  const float reach = std::min(max_m, kMaxSignedErrorRange_m);
  return {-reach, reach};
}

/// Makes the elements of nodes.
class NodeMaker {
 public:
  NodeMaker(const LevelInput& input, const LevelOptions& options, const LevelOrder& order,
            const Executor& executor)
      : options_(options), order_(order), executor_(executor), values_(input) {}

  std::vector<LevelSample> leaf(const LevelBlock& block) const {
    const ElementValues values = values_of(block.begin, block.end);
    std::vector<LevelSample> samples;
    samples.reserve(block.size());
    for (std::size_t i = block.begin; i < block.end; ++i)
      samples.push_back(order_.has_disks()
                            ? sample_of(order_.disks()[i], values, i - block.begin)
                            : sample_of(order_.position(i), values, i - block.begin));
    return samples;
  }

  /// Sets `spacing_m`, too.
  std::vector<LevelSample> inner(const LevelBlock& block, float& spacing_m) const {
    const int level = cell_level(block);
    spacing_m = block.side_m(level);
    std::vector<std::vector<LevelSample>> parts((block.size() + kGrain - 1) / kGrain);
    executor_.for_chunks(block.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      parts[begin / kGrain] = merged_cells(block, level, block.begin + begin, block.begin + end);
    });
    std::vector<LevelSample> samples;
    for (const auto& part : parts) samples.insert(samples.end(), part.begin(), part.end());
    return samples;
  }

 private:
  ElementValues values_of(std::size_t begin, std::size_t end) const {
    return {values_.classes, values_.intensities, values_.errors_m, values_.colors,
            order_.sources().subspan(begin, end - begin)};
  }

  /// Level of the grid's cells: the finest that merges enough elements.
  int cell_level(const LevelBlock& block) const {
    const std::vector<std::size_t> cells = order_.occupied(block, executor_);
    const std::size_t max_cells = std::min(options_.leaf_size, block.size() / kMinReduction);
    const int finest = std::bit_width(static_cast<unsigned>(options_.cells_per_side)) - 1;
    int level = std::min(block.level + finest, kHilbertBits);
    while (level > block.level + 1 && cells[static_cast<std::size_t>(level)] > max_cells) --level;
    return level;
  }

  /// Merges the cells that begin within [begin, end).
  std::vector<LevelSample> merged_cells(const LevelBlock& block, int level, std::size_t begin,
                                        std::size_t end) const {
    std::vector<LevelSample> samples;
    CellMerger merger;
    if (begin > block.begin) begin = order_.run_end(begin - 1, block.end, level);
    for (std::size_t i = begin; i < end;) {
      const std::size_t cell_end = order_.run_end(i, block.end, level);
      const ElementValues values = values_of(i, cell_end);
      if (order_.has_disks()) {
        merger.merge(order_.disks().subspan(i, cell_end - i), values, samples);
      } else {
        const std::size_t chosen = nearest_to_middle(block, level, i, cell_end);
        samples.push_back(sample_of(order_.position(chosen), values, chosen - i));
      }
      i = cell_end;
    }
    return samples;
  }

  /// The point of a cell that is nearest to its centre.
  std::size_t nearest_to_middle(const LevelBlock& block, int level, std::size_t begin,
                                std::size_t end) const {
    const float side_m = block.side_m(level);
    const Vec3<std::uint32_t> cell = block.grid.cell(order_.position(begin));
    Vec3f middle = block.grid.low;
    for (int axis = 0; axis < 3; ++axis)
      middle[axis] += (static_cast<float>(cell[axis] >> (kHilbertBits - level)) + 0.5F) * side_m;
    std::size_t nearest = begin;
    float min_squared = HUGE_VALF;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f offset = order_.position(i) - middle;
      const float squared = dot(offset, offset);
      if (squared < min_squared) {
        min_squared = squared;
        nearest = i;
      }
    }
    return nearest;
  }

  const LevelOptions& options_;
  const LevelOrder& order_;
  const Executor& executor_;
  const LevelInput& values_;
};

}  // namespace

ByteRange range_of_intensities(std::span<const float> intensities) {
  std::vector<float> values = finite_values(intensities, false);
  if (values.empty()) return {0, 1};
  const float low = percentile(values, 2), high = percentile(values, 98);
  return low < high ? ByteRange{low, high} : ByteRange{0, 1};
}

LevelTree::LevelTree(const LevelInput& input, const LevelOptions& options, const Executor& executor)
    : input_size_(input.disks.size() + input.positions.size()) {
  check(input, options);
  intensity_range_ =
      options.intensity_range ? *options.intensity_range : range_of_intensities(input.intensities);
  error_range_m_ = range_of_errors(input.errors_m);
  LevelOrder order(input.disks, input.positions, executor);
  const NodeMaker maker(input, options, order, executor);
  std::vector<LevelBlock> blocks = {order.whole()};
  nodes_.resize(1);
  firsts_ = {0};
  while (firsts_.size() <= blocks.size()) {
    // Blocks of a batch are disjoint: sorting one does not change the others.
    const std::size_t first = firsts_.size() - 1;
    const std::size_t last = std::min(first + kBatch, blocks.size());
    for (std::size_t n = first; n < last; ++n) {
      LevelBlock& block = blocks[n];
      if (block.size() <= options.leaf_size && order.box_side_m(block) <= kMaxLeafWidth_m) continue;
      order.tighten(block, executor);
      const bool join = block.side_m(block.level) <= kMaxLeafWidth_m;
      const std::vector<LevelBlock> parts = order.split(block, join ? options.leaf_size : 0);
      nodes_[n].first_child = static_cast<std::uint32_t>(blocks.size());
      nodes_[n].child_count = static_cast<std::uint32_t>(parts.size());
      blocks.insert(blocks.end(), parts.begin(), parts.end());
      nodes_.resize(blocks.size(), LevelNode{.level = nodes_[n].level + 1});
    }
    std::vector<std::vector<LevelElement>> made(last - first);
    std::vector<std::vector<LevelColor>> colors(made.size());
    executor.for_chunks(made.size(), 1, [&](std::size_t k, std::size_t) {
      LevelNode& node = nodes_[first + k];
      const LevelBlock& block = blocks[first + k];
      const std::vector<LevelSample> samples =
          node.child_count == 0 ? maker.leaf(block) : maker.inner(block, node.spacing_m);
      made[k] = encode(samples, intensity_range_, error_range_m_, node);
      if (!input.colors.empty()) colors[k] = encode_colors(samples);
    });
    for (const std::vector<LevelColor>& of_node : colors)
      colors_.insert(colors_.end(), of_node.begin(), of_node.end());
    for (const std::vector<LevelElement>& elements : made) {
      elements_.insert(elements_.end(), elements.begin(), elements.end());
      firsts_.push_back(elements_.size());
    }
  }
  elements_.shrink_to_fit();
  colors_.shrink_to_fit();
}

std::span<const LevelElement> LevelTree::elements(std::size_t n) const {
  return std::span(elements_).subspan(firsts_[n], firsts_[n + 1] - firsts_[n]);
}

std::span<const LevelColor> LevelTree::colors(std::size_t n) const {
  if (colors_.empty()) return {};
  return std::span(colors_).subspan(firsts_[n], firsts_[n + 1] - firsts_[n]);
}

LevelPiece merged_node(const LevelInput& input, const LevelOptions& options,
                       const Executor& executor) {
  check(input, options);
  if (input.disks.empty() || !options.intensity_range)
    throw std::logic_error("merged node: no splats, or no intensity_range");
  LevelOrder order(input.disks, input.positions, executor);
  LevelBlock block = order.whole();
  order.tighten(block, executor);
  LevelPiece piece;
  const NodeMaker maker(input, options, order, executor);
  const std::vector<LevelSample> samples = maker.inner(block, piece.node.spacing_m);
  piece.elements =
      encode(samples, *options.intensity_range, range_of_errors(input.errors_m), piece.node);
  if (!input.colors.empty()) piece.colors = encode_colors(samples);
  return piece;
}

void add_splats(const LevelNode& node, std::span<const LevelElement> elements,
                ByteRange intensities, LevelSplats& splats) {
  for (const LevelElement& element : elements) {
    Disk disk;
    for (int axis = 0; axis < 3; ++axis)
      disk.center[axis] = node.low[axis] + (node.high[axis] - node.low[axis]) *
                                               static_cast<float>(element.position[axis]) / 65535;
    disk.radius = node.largest_radius_m * static_cast<float>(element.radius) / 65535;
    disk.normal = normal_of({element.normal[0], element.normal[1]});
    splats.disks.push_back(disk);
    splats.classes.push_back(element.class_id);
    splats.intensities.push_back(intensities.low + (intensities.high - intensities.low) *
                                                       static_cast<float>(element.intensity) / 255);
  }
}

std::string nodes_bytes(std::span<const LevelNode> nodes) {
  // As characters, for the body of a reply.
  return {reinterpret_cast<const char*>(nodes.data()), nodes.size_bytes()};
}

}  // namespace adasplats
