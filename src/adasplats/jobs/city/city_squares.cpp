// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_squares.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// What rounding may move a border by.
constexpr double kRounding_m = 0.01;

/// Of the points behind the squares' own.
constexpr std::uint64_t kAround = std::uint64_t{1} << 63;

/// The ground of squares and of their margin, relative to the city's origin, with some more.
GroundBox reach_of(const SquareGroup& group, const SegmentOptions& options) {
  const double side = options.tile_m;
  return GroundBox{group.low.x * side, group.low.y * side, (group.high.x + 1) * side,
                   (group.high.y + 1) * side}
      .grown(options.margin_m + kRounding_m);
}

/// The points of squares and around them, of one tile after another.
class PointsOfSquares {
 public:
  PointsOfSquares(const SquareGroup& group, const SegmentOptions& options, const LayerWork& work)
      : group_(group), options_(options), work_(work), reach_(reach_of(group, options)) {
    GroundBox ground = reach_;
    ground.low_x += work.layer.facts.origin.x;
    ground.high_x += work.layer.facts.origin.x;
    ground.low_y += work.layer.facts.origin.y;
    ground.high_y += work.layer.facts.origin.y;
    cloud_.origin = work.layer.facts.origin;
    for (const TileKey tile : work.tiles.touched(ground)) add(tile);
  }

  /// As one cloud: those in the squares first, each part in the order in which they were read.
  PointCloud in_order(const Executor& executor) {
    std::vector<std::uint64_t> keys = keys_;
    executor.sort_keys(keys, order_);
    return gather(std::exchange(cloud_, {}), order_);
  }
  std::size_t own() const { return own_; }

  /// `ids`: of the first own() points of in_order().
  std::map<TileKey, std::vector<std::uint16_t>> by_tile(const std::vector<std::uint16_t>& ids) {
    std::vector<std::uint16_t> as_read(keys_.size());
    for (std::size_t k = 0; k < own_; ++k) as_read[order_[k]] = ids[k];
    std::map<TileKey, std::vector<std::uint16_t>> found;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      const std::size_t end = t + 1 < tiles_.size() ? tiles_[t + 1].second : keys_.size();
      for (std::size_t i = tiles_[t].second; i < end; ++i)
        if (keys_[i] < kAround) found[tiles_[t].first].push_back(as_read[i]);
    }
    return found;
  }

 private:
  void add(TileKey tile) {
    tiles_.emplace_back(tile, keys_.size());
    const std::vector<std::uint64_t> order = read_tile_order(work_.folder(), tile);
    std::size_t read = 0;
    read_tile_pieces(work_.folder(), tile, [&](const PointCloud& piece) {
      if (piece.size() > order.size() - read) fail(tile);
      for (std::size_t i = 0; i < piece.size(); ++i) add(piece, i, order[read + i]);
      read += piece.size();
    });
    if (read != order.size()) fail(tile);
  }

  void add(const PointCloud& piece, std::size_t i, std::uint64_t number) {
    const Vec3f p = piece.positions[i];
    const bool is_own = group_.contains(square_of(p, options_));
    if (!is_own && !reach_.contains(vec_cast<double>(p))) return;
    if (is_own) ++own_;
    keys_.push_back(is_own ? number : number | kAround);
    cloud_.positions.push_back(p);
    if (!piece.intensities.empty()) cloud_.intensities.push_back(piece.intensities[i]);
  }

  [[noreturn]] void fail(TileKey tile) const {
    throw Error(ErrorKind::data, work_.path(order_file_of(tile)).string() +
                                     ": damaged: not a number for every point");
  }

  const SquareGroup& group_;
  const SegmentOptions& options_;
  const LayerWork& work_;
  GroundBox reach_;
  PointCloud cloud_;
  std::vector<std::uint64_t> keys_;                     ///< as points were read: their order
  std::vector<std::uint32_t> order_;                    ///< numbers of points in keys_, sorted
  std::vector<std::pair<TileKey, std::size_t>> tiles_;  ///< with their first points in keys_
  std::size_t own_ = 0;
};

}  // namespace

TileKey group_of(SegmentSquare square, const SegmentOptions& options, const LayerWork& work) {
  const Vec3d middle = {(square.x + 0.5) * options.tile_m, (square.y + 0.5) * options.tile_m, 0};
  return work.tiles.grid.tile_of(work.layer.facts.origin + middle);
}

std::vector<SquareGroup> groups_of_squares(const SegmentOptions& options, const LayerWork& work) {
  std::map<TileKey, SquareGroup> groups;
  const Vec3d origin = work.layer.facts.origin;
  for (const TileKey tile : work.tiles.tiles) {
    const GroundBox box = work.tiles.grid.box_of(tile).grown(kRounding_m);
    const auto number = [&](double at_m) {
      return static_cast<std::int32_t>(std::floor(at_m / options.tile_m));
    };
    const SegmentSquare last = {number(box.high_x - origin.x), number(box.high_y - origin.y)};
    for (SegmentSquare square = {number(box.low_x - origin.x), 0}; square.x <= last.x; ++square.x)
      for (square.y = number(box.low_y - origin.y); square.y <= last.y; ++square.y) {
        const TileKey name = group_of(square, options, work);
        SquareGroup& group =
            groups.try_emplace(name, SquareGroup{name, square, square}).first->second;
        group.low = {std::min(group.low.x, square.x), std::min(group.low.y, square.y)};
        group.high = {std::max(group.high.x, square.x), std::max(group.high.y, square.y)};
      }
  }
  std::vector<SquareGroup> all;
  all.reserve(groups.size());
  for (const auto& [tile, group] : groups) all.push_back(group);
  return all;
}

SquareClasses classes_of_squares(const SquareGroup& group, const PointClassifier& classifier,
                                 const SegmentOptions& options, const LayerWork& work,
                                 Session& session) {
  PointsOfSquares points(group, options, work);
  if (points.own() == 0) return {};
  SegmentOptions own = options;
  own.wanted = points.own();
  const PointClasses found = classifier.classes_of(points.in_order(session.executor), own, session);
  return {found.tiles, found.cells, points.by_tile(found.ids)};
}

}  // namespace adasplats
