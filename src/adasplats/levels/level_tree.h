// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// Splats or points for a viewer; attributes are empty or have one value per element.
struct LevelInput {
  std::span<const Disk> disks;       ///< splats; else empty
  std::span<const Vec3f> positions;  ///< points; else empty
  std::span<const std::uint16_t> classes;
  std::span<const float> intensities;
  std::span<const float> errors_m;                      ///< signed; NaN: unknown
  std::span<const std::array<std::uint8_t, 3>> colors;  ///< RGB
};

/// Range of an attribute's bytes: intensities from 0 to 255, errors from 1 to 255 (0: unknown).
struct ByteRange {
  float low = 0;
  float high = 1;
  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

struct LevelOptions {
  std::size_t leaf_size = 16'384;  ///< maximum number of elements of a leaf
  /// Grid over an inner node's cube, with one element per occupied cell; rounded down to a power of
  /// two. Coarser if more than leaf_size cells, or more than half as many as elements, would be
  /// occupied, so that a node is never much larger than a leaf.
  int cells_per_side = 64;
  /// Replaces range_of_intensities(), for trees that are parts of a city.
  std::optional<ByteRange> intensity_range = std::nullopt;
};

/// 2nd and 98th percentile of the finite intensities; {0, 1} without any or if both are equal.
ByteRange range_of_intensities(std::span<const float> intensities);

/// One node in the layout of the viewer's page (docs/viewer_protocol.md, "A layer's tree").
struct LevelNode {
  Vec3f low, high;
  float spacing_m = 0;
  float largest_radius_m = 0;
  std::uint32_t first_child = 0;
  std::uint32_t child_count = 0;
  std::uint32_t count = 0;
  std::uint32_t level = 0;
};
static_assert(sizeof(LevelNode) == 48);

/// One splat or point in the layout of the viewer's page.
struct LevelElement {
  std::uint16_t position[3];
  std::uint16_t radius;
  std::int16_t normal[2];
  std::uint16_t class_id;
  std::uint8_t intensity;
  std::uint8_t error;
};
static_assert(sizeof(LevelElement) == 16);

/// The colour of an element, RGB and 255, in the layout of the viewer's page.
using LevelColor = std::array<std::uint8_t, 4>;

/// An octree with level of detail by replacement: a node's elements represent those of all its
/// leaves. Leaves hold the input's elements. An inner node has elements for every occupied cell of
/// a grid over its cube: for splats the merged disks of the cell (CellMerger; two at corners), for
/// points the point nearest to the cell's centre.
///
/// A node's cube is the smallest that contains its elements, so distant outliers cost only a level
/// or two. Octants with few elements share a leaf; equal positions are divided by their order, so
/// that no leaf exceeds leaf_size. Positions are rounded to 1/65535 of the node's box (errors of at
/// most 2 mm in a leaf, which is at most 256 m wide), radii to 1/65535 of its largest.
class LevelTree {
 public:
  /// Gives the same bytes on any number of threads, and one empty leaf for an empty input.
  /// Positions and radii must be finite, normals of unit length. Memory in addition to the input:
  /// about 60 bytes per splat and 45 per point; about 20 of them remain (25 with colours). Errors:
  /// std::logic_error if the size of an attribute is wrong, or both disks and positions are given.
  LevelTree(const LevelInput& input, const LevelOptions& options, const Executor& executor);

  std::span<const LevelNode> nodes() const { return nodes_; }
  /// Elements of node `n` (< nodes().size()).
  std::span<const LevelElement> elements(std::size_t n) const;
  bool has_colors() const { return !colors_.empty(); }
  /// Colours of the elements of node `n`; empty without colours.
  std::span<const LevelColor> colors(std::size_t n) const;
  /// Elements of all nodes, one node after another.
  std::span<const LevelElement> elements() const { return elements_; }
  std::size_t input_size() const { return input_size_; }
  ByteRange intensity_range() const { return intensity_range_; }
  ByteRange error_range_m() const { return error_range_m_; }

 private:
  std::size_t input_size_ = 0;
  std::vector<LevelNode> nodes_;
  std::vector<std::size_t> firsts_;  ///< first element of each node, and the end
  std::vector<LevelElement> elements_;
  std::vector<LevelColor> colors_;
  ByteRange intensity_range_;
  /// From 0 to the 98th percentile of the errors' magnitudes, at least 1 mm. If any error is
  /// negative: symmetric and at most 0.5 m, so that a few ghosts do not use up the colours.
  ByteRange error_range_m_;
};

/// A single node with its elements, and their colours if the input has colours.
struct LevelPiece {
  LevelNode node;
  std::vector<LevelElement> elements;
  std::vector<LevelColor> colors;
};

/// Makes an inner node without children that represents all splats of `input` (at least one),
/// merged as in a LevelTree. `options.intensity_range` must be set.
LevelPiece merged_node(const LevelInput& input, const LevelOptions& options,
                       const Executor& executor);

/// Splats decoded from a node's elements.
struct LevelSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;
  std::vector<float> intensities;
};
/// Decodes a node's splats and appends them to `splats`.
void add_splats(const LevelNode& node, std::span<const LevelElement> elements,
                ByteRange intensities, LevelSplats& splats);

/// Rows of a layer's table, in the layout of the viewer's page.
std::string nodes_bytes(std::span<const LevelNode> nodes);

/// The octahedral code of a unit vector; decoding it is accurate to 1e-4.
struct OctahedralNormal {
  std::int16_t u, v;
};
OctahedralNormal octahedral(Vec3f normal);
Vec3f normal_of(OctahedralNormal code);

}  // namespace adasplats
