// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/city/tile_grid.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace adasplats {
namespace {

/// Clips [first, last], shares of a segment, to where one coordinate is between low and high.
bool cut(double from, double to, double low, double high, double& first, double& last) {
  const double way = to - from;
  if (way == 0) return from >= low && from <= high;
  const double a = (low - from) / way, b = (high - from) / way;
  first = std::max(first, std::min(a, b));
  last = std::min(last, std::max(a, b));
  return first <= last;
}

}  // namespace

std::string name_of(TileKey tile) {
  return "x" + std::to_string(tile.x) + "_y" + std::to_string(tile.y);
}

std::optional<TileKey> tile_named(std::string_view name) {
  TileKey tile;
  const char* const end = name.data() + name.size();
  if (!name.starts_with('x')) return std::nullopt;
  const auto [column_end, bad_column] = std::from_chars(name.data() + 1, end, tile.x);
  if (bad_column != std::errc() || end - column_end < 3 ||
      !std::string_view(column_end, 2).starts_with("_y"))
    return std::nullopt;
  const auto [row_end, bad_row] = std::from_chars(column_end + 2, end, tile.y);
  // One name per tile: rejects "x01_y2".
  if (bad_row != std::errc() || row_end != end || name_of(tile) != name) return std::nullopt;
  return tile;
}

bool GroundBox::is_crossed(Vec3d from, Vec3d to) const {
  double first = 0, last = 1;
  return cut(from.x, to.x, low_x, high_x, first, last) &&
         cut(from.y, to.y, low_y, high_y, first, last);
}

}  // namespace adasplats
