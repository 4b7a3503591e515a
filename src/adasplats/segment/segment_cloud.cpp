// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/segment_cloud.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/segment/network/run_network.h"
#include "adasplats/segment/pyramid/heights_above_ground.h"

namespace adasplats {
namespace {

constexpr double kFull = 0.99;        // intensities are shares of this quantile
constexpr float kFarthest_m = 100e3;  // grids of a cloud have 2^21 cells a side

void require_places(const PointCloud& cloud) {
  const auto is_near = [](float value) { return std::fabs(value) <= kFarthest_m; };  // no NaN
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3f p = cloud.positions[i];
    if (!is_near(p.x) || !is_near(p.y) || !is_near(p.z))
      throw Error(ErrorKind::data, "point " + std::to_string(i) +
                                       " is not finite or farther than 100 km from the others");
  }
}

class Segmenter {
 public:
  Segmenter(const PointCloud& cloud, const Network& network, const SegmentOptions& options,
            const Executor& executor)
      : cloud_(cloud), network_(network), options_(options), executor_(executor) {
    has_intensity_ = options.intensity && !cloud.intensities.empty();
    if (has_intensity_) full_intensity_ = full_intensity();
    wanted_ = std::min(options.wanted, cloud.size());
    result_.classes.resize(wanted_);
    if (options.confidences) result_.confidences.resize(wanted_);
    if (options.probabilities) result_.probabilities.resize(wanted_ * network.classes.size());
  }

  Segmentation run() {
    sort_into_tiles();
    // The points of a tile are in their order.
    for (std::size_t t = 0; t < begins_.size(); ++t)
      if (core_of(t).front() < wanted_) segment(t);
    return std::move(result_);
  }

 private:
  struct TilePlace {
    std::int32_t x, y;
    auto operator<=>(const TilePlace&) const = default;
  };

  float full_intensity() const {
    std::vector<float> known;
    for (const float value : cloud_.intensities)
      if (std::isfinite(value)) known.push_back(value);
    if (known.empty()) return 1;
    const auto place = static_cast<std::ptrdiff_t>(kFull * static_cast<double>(known.size() - 1));
    std::nth_element(known.begin(), known.begin() + place, known.end());
    return std::max(1e-6F, known[static_cast<std::size_t>(place)]);
  }

  TilePlace place_of(Vec3f p) const {
    const auto cell = [&](float value) {
      return static_cast<std::int32_t>(std::floor(static_cast<double>(value) / options_.tile_m));
    };
    return {cell(p.x), cell(p.y)};
  }

  void sort_into_tiles() {
    order_.resize(cloud_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    std::vector<TilePlace> places(cloud_.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = place_of(cloud_.positions[i]);
    std::ranges::stable_sort(
        order_, [&](std::uint32_t a, std::uint32_t b) { return places[a] < places[b]; });
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (k > 0 && places[order_[k]] == places[order_[k - 1]]) continue;
      begins_.push_back(k);
      tiles_.push_back(places[order_[k]]);
    }
  }

  std::span<const std::uint32_t> core_of(std::size_t tile) const {
    const std::size_t end = tile + 1 < begins_.size() ? begins_[tile + 1] : order_.size();
    return std::span(order_).subspan(begins_[tile], end - begins_[tile]);
  }

  /// The points of the tile first, then those of its neighbours that lie in its margin.
  std::vector<std::uint32_t> points_of(std::size_t tile) const {
    const TilePlace place = tiles_[tile];
    const std::span<const std::uint32_t> core = core_of(tile);
    std::vector<std::uint32_t> indices(core.begin(), core.end());
    const double low_x = place.x * options_.tile_m - options_.margin_m;
    const double low_y = place.y * options_.tile_m - options_.margin_m;
    const double size = options_.tile_m + 2 * options_.margin_m;
    const auto reach = static_cast<std::int32_t>(std::ceil(options_.margin_m / options_.tile_m));
    for (std::int32_t dx = -reach; dx <= reach; ++dx) {
      for (std::int32_t dy = -reach; dy <= reach; ++dy) {
        if (dx == 0 && dy == 0) continue;
        const TilePlace other{place.x + dx, place.y + dy};
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

  void segment(std::size_t tile) {
    const std::vector<std::uint32_t> indices = points_of(tile);
    const std::size_t core = core_of(tile).size();
    const Vec3f corner = corner_of(tile);
    std::vector<Vec3f> points;
    points.reserve(indices.size());
    for (const std::uint32_t i : indices) points.push_back(cloud_.positions[i] - corner);
    CellMeans cells = means_by_cell(points, network_.shape.cell_m, executor_);
    std::vector<float> features = features_of(cells, indices);
    result_.cells += cells.means.size();
    ++result_.tiles;
    const std::vector<PyramidLevel> levels =
        make_pyramid(std::move(cells.means), network_.shape, executor_);
    const std::vector<float> logits = run_network(network_, levels, std::move(features), executor_);
    for (std::size_t k = 0; k < core && indices[k] < wanted_; ++k)
      take(indices[k], cells.cell_of[k], logits);
  }

  std::vector<float> features_of(const CellMeans& cells,
                                 const std::vector<std::uint32_t>& indices) const {
    const std::vector<float> heights = heights_above_ground(cells.means);
    const std::vector<float> intensities =
        has_intensity_ ? mean_intensities(cells, indices) : std::vector<float>(heights.size());
    std::vector<float> features;
    features.reserve(heights.size() * network_.features.size());
    for (std::size_t i = 0; i < heights.size(); ++i) {
      for (const PointFeature feature : network_.features) {
        switch (feature) {
          case PointFeature::one: features.push_back(1); break;
          case PointFeature::height: features.push_back(heights[i] / network_.height_unit_m); break;
          case PointFeature::intensity: features.push_back(intensities[i]); break;
          case PointFeature::has_intensity: features.push_back(has_intensity_ ? 1.0F : 0.0F); break;
        }
      }
    }
    return features;
  }

  std::vector<float> mean_intensities(const CellMeans& cells,
                                      const std::vector<std::uint32_t>& indices) const {
    std::vector<float> sums(cells.means.size()), counts(cells.means.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const float value = cloud_.intensities[indices[k]] / full_intensity_;
      if (std::isfinite(value)) sums[cells.cell_of[k]] += std::clamp(value, 0.0F, 1.0F);
      ++counts[cells.cell_of[k]];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
    return sums;
  }

  void take(std::uint32_t point, std::size_t cell, const std::vector<float>& logits) {
    const std::size_t classes = network_.classes.size();
    const float* const own = logits.data() + cell * classes;
    const float* const best = std::max_element(own, own + classes);
    result_.classes[point] = static_cast<std::uint8_t>(best - own);
    if (!options_.confidences && !options_.probabilities) return;
    float sum = 0;
    for (std::size_t c = 0; c < classes; ++c) sum += std::exp(own[c] - *best);
    // Weights that are too large for floats make logits of which nothing is known.
    const float share = std::isfinite(sum) ? 1 / sum : 0;
    if (options_.confidences) result_.confidences[point] = share;
    if (!options_.probabilities) return;
    float* const probabilities = result_.probabilities.data() + point * classes;
    for (std::size_t c = 0; c < classes; ++c)
      probabilities[c] = share > 0 ? share * std::exp(own[c] - *best) : 0;
  }

  const PointCloud& cloud_;
  const Network& network_;
  const SegmentOptions& options_;
  const Executor& executor_;
  std::size_t wanted_ = 0;
  bool has_intensity_ = false;
  float full_intensity_ = 1;
  std::vector<std::uint32_t> order_;  ///< points, tile by tile
  std::vector<std::size_t> begins_;   ///< of the tiles in it
  std::vector<TilePlace> tiles_;
  Segmentation result_;
};

}  // namespace

Segmentation segment_cloud(const PointCloud& cloud, const Network& network,
                           const SegmentOptions& options, const Executor& executor) {
  require_places(cloud);
  return Segmenter(cloud, network, options, executor).run();
}

}  // namespace adasplats
