// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "adasplats/city/tile_points.h"
#include "adasplats/jobs/city/point_layer.h"
#include "adasplats/jobs/segment/point_classes.h"

namespace adasplats {

/// Squares that a network classifies, from the lowest to the highest, inclusive: those with their
/// middle in one tile, which may have no points.
struct SquareGroup {
  TileKey tile;
  SegmentSquare low, high;

  bool contains(SegmentSquare square) const {
    return square.x >= low.x && square.x <= high.x && square.y >= low.y && square.y <= high.y;
  }
};

/// The tile of the group that contains a square.
TileKey group_of(SegmentSquare square, const SegmentOptions& options, const LayerWork& work);
/// All squares that may have points, each in one group; by their tiles.
std::vector<SquareGroup> groups_of_squares(const SegmentOptions& options, const LayerWork& work);

/// The classes of the points in the squares, in the order in which the points were read. They equal
/// those of the whole city in one cloud, since a square is classified with its margin. Reads the
/// points of tiles near the squares. Memory: the points of the squares and margins, without
/// attributes. Errors: data (damaged files of points).
SquareClasses classes_of_squares(const SquareGroup& group, const PointClassifier& classifier,
                                 const SegmentOptions& options, const LayerWork& work,
                                 Session& session);

}  // namespace adasplats
