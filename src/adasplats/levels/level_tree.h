// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Splats or points for a viewer; attributes are empty or have one value an element.
struct LevelInput {
  std::span<const Disk> disks;       ///< splats; else empty
  std::span<const Vec3f> positions;  ///< points; else empty
  std::span<const std::uint16_t> classes;
  std::span<const float> intensities;
  std::span<const float> errors_m;  ///< signed; NaN: not known
};

/// The ends of what an attribute's bytes stand for: intensities 0 and 255, errors 1 and 255 (0: not
/// known).
struct ByteRange {
  float low = 0;
  float high = 1;
  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

struct LevelOptions {
  std::size_t leaf_size = 16'384;  ///< most elements of a leaf
  /// Grid over an inner node's cube, of which each occupied cell has an element; rounded down to a
  /// power of two. Coarser where more than leaf_size cells, or more than half as many as elements,
  /// would be occupied, so that a node is never much larger than a leaf.
  int cells_per_side = 64;
  /// Instead of range_of_intensities(), for trees that are parts of a whole.
  std::optional<ByteRange> intensity_range = std::nullopt;
};

/// 2nd and 98th percentile of those that are finite; {0, 1} without any or where they are equal.
ByteRange range_of_intensities(std::span<const float> intensities);

/// One node as the page reads it (docs/viewer_protocol.md, "A layer's tree").
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

/// One splat or point as the page reads it, likewise.
struct LevelElement {
  std::uint16_t position[3];
  std::uint16_t radius;
  std::int16_t normal[2];
  std::uint16_t class_id;
  std::uint8_t intensity;
  std::uint8_t error;
};
static_assert(sizeof(LevelElement) == 16);

/// An octree with level of detail by replacement: a node's elements stand for those of all its
/// leaves. Leaves hold the input's elements; an inner node has, for every occupied cell of a grid
/// over its cube, for splats one disk (two where the cell's disks face two ways, as at a corner)
/// with the sum of the areas as far as the cell's disks reach, their mean center and normal, and
/// the class of most area; for points the one nearest to the cell's middle.
///
/// A node's cube is the smallest that holds its elements, so far outliers cost a level or two and
/// no more; octants with few elements share a leaf; equal positions are parted by their order, so
/// that no leaf exceeds leaf_size. Positions are off by at most half a 65535th of the node's box (2
/// mm in a leaf, which is no wider than 256 m), radii by half a 65535th of its largest.
class LevelTree {
 public:
  /// The same bytes on any number of threads. An empty input gives one empty leaf. Positions and
  /// radii are finite, normals of unit length. Memory beside the input: about 60 bytes a splat and
  /// 45 a point, of which about 20 stay. Errors: std::logic_error where an attribute has another
  /// size than the elements, or both disks and positions are given.
  LevelTree(const LevelInput& input, const LevelOptions& options, const Executor& executor);

  std::span<const LevelNode> nodes() const { return nodes_; }
  /// Of node `n` (< nodes().size()).
  std::span<const LevelElement> elements(std::size_t n) const;
  /// Of all nodes, one after another.
  std::span<const LevelElement> elements() const { return elements_; }
  std::size_t input_size() const { return input_size_; }
  ByteRange intensity_range() const { return intensity_range_; }
  ByteRange error_range_m() const { return error_range_m_; }

 private:
  std::size_t input_size_ = 0;
  std::vector<LevelNode> nodes_;
  std::vector<std::size_t> firsts_;  ///< of each node in `elements_`, and the end
  std::vector<LevelElement> elements_;
  ByteRange intensity_range_;
  /// To the 98th percentile of the errors' magnitudes, at least a millimetre; where any error is
  /// negative from the negative of that, which is half a metre then at most: few ghosts must not
  /// take the colours from all others.
  ByteRange error_range_m_;
};

/// A node by itself.
struct LevelPiece {
  LevelNode node;
  std::vector<LevelElement> elements;
};

/// An inner node that stands for all of the splats `input` (one or more), merged as a LevelTree's
/// are; without children. `options.intensity_range` must be given.
LevelPiece merged_node(const LevelInput& input, const LevelOptions& options,
                       const Executor& executor);

/// The splats that a node's elements say, to the precision of their bytes.
struct LevelSplats {
  std::vector<Disk> disks;
  std::vector<std::uint16_t> classes;
  std::vector<float> intensities;
};
/// Adds a node's splats to `splats`.
void add_splats(const LevelNode& node, std::span<const LevelElement> elements,
                ByteRange intensities, LevelSplats& splats);

/// Rows of a layer's table, as the page reads them.
std::string nodes_bytes(std::span<const LevelNode> nodes);

/// The octahedral code of a unit vector, and back to 1e-4.
struct OctahedralNormal {
  std::int16_t u, v;
};
OctahedralNormal octahedral(Vec3f normal);
Vec3f normal_of(OctahedralNormal code);

}  // namespace adasplats
