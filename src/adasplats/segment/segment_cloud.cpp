// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/segment_cloud.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/segment/full_intensity.h"
#include "adasplats/segment/segment_engine.h"

namespace adasplats {
namespace {

void require_positions(const PointCloud& cloud) {
  const auto is_near = [](float value) { return std::fabs(value) <= kSegmentReach_m; };  // no NaN
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f p = cloud.positions[i];
    if (!is_near(p.x) || !is_near(p.y) || !is_near(p.z))
      throw Error(ErrorKind::data, "point " + std::to_string(i) +
                                       " is not finite or more than 100 km from the origin");
  }
}

class Segmenter {
 public:
  Segmenter(const PointCloud& cloud, const Network& network, const SegmentOptions& options,
            const Executor& executor)
      : cloud_(cloud), network_(network), options_(options), executor_(executor) {
    wanted_ = std::min(options.wanted, cloud.size());
  }

  Segmentation run(const SegmentEngine& engine) {
    SegmentTask task{cloud_, network_, options_};
    task.has_intensity = options_.intensity && !cloud_.intensities.empty();
    if (task.has_intensity)
      task.full_intensity =
          options_.full_intensity ? *options_.full_intensity : full_intensity(cloud_.intensities);
    const std::unique_ptr<TileSegmenter> tiles = engine.start(task);
    sort_into_tiles();
    // The points of a tile are in ascending order.
    for (std::size_t t = 0; t < begins_.size(); ++t)
      if (core_of(t).front() < wanted_) segment(t, *tiles);
    tiles->finish(result_);
    return std::move(result_);
  }

 private:
  void sort_into_tiles() {
    const auto key_of = [](std::int32_t index) {  // in ascending order of indices
      return static_cast<std::uint32_t>(index) ^ 0x80000000U;
    };
    std::vector<std::uint64_t> keys(cloud_.size());
    executor_.for_chunks(keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SegmentSquare square = square_of(cloud_.positions[i], options_);
        keys[i] = std::uint64_t{key_of(square.x)} << 32 | key_of(square.y);
      }
    });
    executor_.sort_keys(keys, order_);
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (k > 0 && keys[k] == keys[k - 1]) continue;
      begins_.push_back(k);
      tiles_.push_back(square_of(cloud_.positions[order_[k]], options_));
    }
  }

  std::span<const std::uint32_t> core_of(std::size_t tile) const {
    const std::size_t end = tile + 1 < begins_.size() ? begins_[tile + 1] : order_.size();
    return std::span(order_).subspan(begins_[tile], end - begins_[tile]);
  }

  /// The points of the tile first, then those of its neighbours in its margin.
  std::vector<std::uint32_t> points_of(std::size_t tile) const {
    const SegmentSquare square = tiles_[tile];
    const std::span<const std::uint32_t> core = core_of(tile);
    std::vector<std::uint32_t> indices(core.begin(), core.end());
    const double low_x = square.x * options_.tile_m - options_.margin_m;
    const double low_y = square.y * options_.tile_m - options_.margin_m;
    const double size = options_.tile_m + 2 * options_.margin_m;
    const auto reach = static_cast<std::int32_t>(std::ceil(options_.margin_m / options_.tile_m));
    for (std::int32_t dx = -reach; dx <= reach; ++dx) {
      for (std::int32_t dy = -reach; dy <= reach; ++dy) {
        if (dx == 0 && dy == 0) continue;
        const SegmentSquare other{square.x + dx, square.y + dy};
        const auto found = std::lower_bound(tiles_.begin(), tiles_.end(), other);
        if (found == tiles_.end() || !(*found == other)) continue;
        for (const std::uint32_t i : core_of(static_cast<std::size_t>(found - tiles_.begin()))) {
          const double x = static_cast<double>(cloud_.positions[i].x) - low_x;
          const double y = static_cast<double>(cloud_.positions[i].y) - low_y;
          if (x >= 0 && y >= 0 && x < size && y < size) indices.push_back(i);
        }
      }
    }
    return indices;
  }

  /// From a corner of the coarsest grid near the tile, so that cells are the same in every tile.
  Vec3f corner_of(std::size_t tile) const {
    const double coarsest_m =
        static_cast<double>(network_.shape.cell_m) * (1 << (network_.shape.levels - 1));
    const auto snapped = [&](double value) {
      return static_cast<float>(std::floor(value / coarsest_m) * coarsest_m);
    };
    return {snapped(tiles_[tile].x * options_.tile_m), snapped(tiles_[tile].y * options_.tile_m),
            0};
  }

  void segment(std::size_t tile, TileSegmenter& tiles) {
    const std::vector<std::uint32_t> indices = points_of(tile);
    const std::span<const std::uint32_t> core = core_of(tile);
    const auto wanted = static_cast<std::size_t>(
        std::ranges::lower_bound(core, static_cast<std::uint32_t>(wanted_)) - core.begin());
    const double width_m = options_.tile_m + 2 * options_.margin_m;
    result_.cells += tiles.segment({indices, wanted, corner_of(tile), static_cast<float>(width_m)});
    ++result_.tiles;
  }

  const PointCloud& cloud_;
  const Network& network_;
  const SegmentOptions& options_;
  const Executor& executor_;
  std::size_t wanted_ = 0;
  std::vector<std::uint32_t> order_;  ///< points, tile by tile
  std::vector<std::size_t> begins_;   ///< of the tiles in it
  std::vector<SegmentSquare> tiles_;
  Segmentation result_;
};

}  // namespace

SegmentSquare square_of(Vec3f position, const SegmentOptions& options) {
  const auto number = [&](float value) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(value) / options.tile_m));
  };
  return {number(position.x), number(position.y)};
}

Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const SegmentEngine& engine,
                           const Executor& executor) {
  require_positions(cloud);
  return Segmenter(cloud, network, options, executor).run(engine);
}

Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const Executor& executor) {
  return segment_cloud(cloud, network, options, *make_cpu_segment_engine(executor), executor);
}

}  // namespace adasplats
