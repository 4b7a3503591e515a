// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Column and row of a tile: x and y of world coordinates in units of the tile's side.
struct TileKey {
  std::int32_t x = 0;
  std::int32_t y = 0;

  auto operator<=>(const TileKey&) const = default;
};

/// "x12_y-3", the base name of a tile's files.
std::string name_of(TileKey tile);
/// The tile with this name; nullopt for other names.
std::optional<TileKey> tile_named(std::string_view name);

/// A ground rectangle in world coordinates, m: includes its low sides but not its high ones.
struct GroundBox {
  double low_x = 0, low_y = 0, high_x = 0, high_y = 0;

  bool contains(double x, double y) const {
    return x >= low_x && x < high_x && y >= low_y && y < high_y;
  }
  bool contains(Vec3d world) const { return contains(world.x, world.y); }
  GroundBox grown(double by_m) const {
    return {low_x - by_m, low_y - by_m, high_x + by_m, high_y + by_m};
  }
  /// The smallest box that contains both.
  GroundBox with(const GroundBox& other) const {
    return {std::min(low_x, other.low_x), std::min(low_y, other.low_y),
            std::max(high_x, other.high_x), std::max(high_y, other.high_y)};
  }
  /// Whether the closed boxes intersect.
  bool touches(const GroundBox& other) const {
    return low_x <= other.high_x && other.low_x <= high_x && low_y <= other.high_y &&
           other.low_y <= high_y;
  }
  /// Whether the segment from `from` to `to` crosses the box, seen from above.
  bool is_crossed(Vec3d from, Vec3d to) const;
};

/// Empty; with() returns the other box.
inline constexpr GroundBox kNoGround = {
    std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

/// Square tiles that cover the ground, counted from the origin of world coordinates.
struct TileGrid {
  double side_m = 64;

  TileKey tile_of(Vec3d world) const { return {number(world.x), number(world.y)}; }
  GroundBox box_of(TileKey tile) const {
    return {tile.x * side_m, tile.y * side_m, (tile.x + 1) * side_m, (tile.y + 1) * side_m};
  }

 private:
  std::int32_t number(double at_m) const {
    return static_cast<std::int32_t>(std::floor(at_m / side_m));
  }
};

}  // namespace adasplats
