// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/imls.h"

#include "adasplats/core/error.h"
#ifdef ADASPLATS_HAVE_OPENVDB

#include <openvdb/Grid.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using MaskLeaf = openvdb::MaskTree::LeafNodeType;
using Plane = std::uint64_t;  // bit 8 y + z
static_assert(Leaf::DIM == ImlsField::kSide);

constexpr int kLeafSide = ImlsField::kSide;

/// The field as a sparse grid.
struct SparseField {
  openvdb::FloatGrid::Ptr values;   ///< active where the field has values, else outside
  openvdb::MaskTree inside{false};  ///< on where the value is below 0
};

/// Moves leaves into a tree, in their order.
template <class Tree, class TreeLeaf>
void add_leaves(Tree& tree, std::vector<std::unique_ptr<TreeLeaf>>& leaves) {
  for (auto& leaf : leaves) {
    if (leaf && !leaf->isEmpty()) tree.addLeaf(leaf.release());
  }
}

SparseField sparse_field(const ImlsField& field, const ImlsOptions& options,
                         const Executor& executor) {
  const auto outside = static_cast<float>(options.voxel_m * options.truncation_voxels);
  std::vector<std::unique_ptr<Leaf>> leaves(field.size());
  std::vector<std::unique_ptr<MaskLeaf>> inside(field.size());
  const ProgressPass pass(executor, leaves.size());
  executor.for_chunks(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ImlsField::Block block = field.block(i);
      const openvdb::Coord corner(block.corner[0], block.corner[1], block.corner[2]);
      leaves[i] = std::make_unique<Leaf>(corner, outside, false);
      inside[i] = std::make_unique<MaskLeaf>(corner);
      for (openvdb::Index v = 0; v < Leaf::SIZE; ++v) {
        if ((block.known[v / 64] >> (v % 64) & 1U) == 0) continue;
        leaves[i]->setValueOn(v, block.values[v]);
        if (block.values[v] < 0.0F) inside[i]->setValueOn(v);
      }
    }
  });
  SparseField sparse{openvdb::FloatGrid::create(outside)};
  sparse.values->setGridClass(openvdb::GRID_LEVEL_SET);  // negative is inside
  add_leaves(sparse.values->tree(), leaves);
  add_leaves(sparse.inside, inside);
  return sparse;
}

/// The active voxels of a leaf and of its upper neighbours.
template <class Tree>
class UpwardBits {
 public:
  UpwardBits(const Tree& tree, openvdb::Coord corner) {
    for (int n = 0; n < 8; ++n) {
      leaves_[static_cast<std::size_t>(n)] = tree.probeConstLeaf(
          corner.offsetBy(kLeafSide * (n >> 2), kLeafSide * (n >> 1 & 1), kLeafSide * (n & 1)));
    }
  }
  /// Plane x in 0..8; bit 8 y + z is that of (x, y + up_y, z + up_z), steps of 0 or 1.
  Plane at(int x, int up_y, int up_z) const {
    const auto row = [&](int y) {
      constexpr Plane kFirstColumn = 0x0101010101010101;
      const Plane here = word(x, y, 0);
      if (up_z == 0) return here;
      return (here >> 1 & ~(kFirstColumn << 7)) | (word(x, y, 1) & kFirstColumn) << 7;
    };
    return up_y == 0 ? row(0) : row(0) >> 8 | row(1) << 56;
  }

 private:
  Plane word(int x, int y, int z) const {
    const int n = 4 * (x / kLeafSide) + 2 * y + z;
    const auto* leaf = leaves_[static_cast<std::size_t>(n)];
    const auto plane = static_cast<openvdb::Index>(x % kLeafSide);
    return leaf == nullptr ? 0 : leaf->getValueMask().template getWord<Plane>(plane);
  }

  std::array<const typename Tree::LeafNodeType*, 8> leaves_{};
};

/// Cells, by their lowest corner, with values at all eight corners.
openvdb::MaskTree whole_cells(const openvdb::FloatTree& tree, const Executor& executor) {
  std::vector<const Leaf*> leaves;
  tree.getNodes(leaves);
  std::vector<std::unique_ptr<MaskLeaf>> whole(leaves.size());
  executor.for_chunks(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const UpwardBits known(tree, leaves[i]->origin());
      whole[i] = std::make_unique<MaskLeaf>(leaves[i]->origin());
      openvdb::util::NodeMask<3> cells;
      for (int x = 0; x < kLeafSide; ++x) {
        Plane& plane = cells.getWord<Plane>(static_cast<openvdb::Index>(x));
        plane = ~Plane{0};
        for (int n = 0; n < 8; ++n) plane &= known.at(x + (n >> 2), n >> 1 & 1, n & 1);
      }
      whole[i]->setValueMask(cells);
    }
  });
  openvdb::MaskTree tree_of_cells(false);
  add_leaves(tree_of_cells, whole);
  return tree_of_cells;
}

/// Whether the four cells around the edge that leaves a voxel upward along an axis are whole.
template <class Accessor>
bool is_edge_within(const Accessor& whole, openvdb::Coord voxel, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  for (int n = 0; n < 4; ++n) {
    openvdb::Coord cell = voxel;
    cell[u] -= n & 1;
    cell[v] -= n >> 1;
    if (!whole.isValueOn(cell)) return false;
  }
  return true;
}

/// The voxels with upward edges that OpenVDB may use: the four cells around each crossed edge are
/// complete. OpenVDB makes a face for each edge with a sign change, with a vertex in each of the
/// four cells; at the end of the values it would use `outside` as a value.
openvdb::BoolGrid::Ptr surface_mask(const SparseField& field, const Executor& executor) {
  using Flags = openvdb::BoolTree::LeafNodeType;
  const openvdb::MaskTree whole = whole_cells(field.values->tree(), executor);
  std::vector<const Leaf*> leaves;
  field.values->tree().getNodes(leaves);
  std::vector<std::unique_ptr<Flags>> masks(leaves.size());
  executor.for_chunks(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
    const openvdb::tree::ValueAccessor<const openvdb::MaskTree> is_whole(whole);
    for (std::size_t i = begin; i < end; ++i) {
      masks[i] = std::make_unique<Flags>(leaves[i]->origin(), false, false);
      const UpwardBits inside(field.inside, leaves[i]->origin());
      for (int x = 0; x < kLeafSide; ++x) {
        const Plane own = inside.at(x, 0, 0);
        const std::array<Plane, 3> crossed = {own ^ inside.at(x + 1, 0, 0),
                                              own ^ inside.at(x, 1, 0), own ^ inside.at(x, 0, 1)};
        for (Plane rest = crossed[0] | crossed[1] | crossed[2]; rest != 0; rest &= rest - 1) {
          const int bit = std::countr_zero(rest);
          const auto voxel = static_cast<openvdb::Index>(64 * x + bit);
          bool within = true;
          for (int axis = 0; axis < 3; ++axis) {
            if ((crossed[static_cast<std::size_t>(axis)] >> bit & 1U) == 0) continue;
            within =
                within && is_edge_within(is_whole, leaves[i]->offsetToGlobalCoord(voxel), axis);
          }
          if (within) masks[i]->setValueOn(voxel);
        }
      }
    }
  });
  auto mask = openvdb::BoolGrid::create(false);
  add_leaves(mask->tree(), masks);
  return mask;
}

/// Converts OpenVDB's polygons to triangles, and keeps the points that they use.
TriangleMesh to_triangles(openvdb::tools::VolumeToMesh& extracted, double voxel_m) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> new_index(extracted.pointListSize(), kUnused);
  TriangleMesh mesh;
  const auto vertex = [&](openvdb::Index32 old) {
    if (new_index[old] == kUnused) {
      new_index[old] = static_cast<std::uint32_t>(mesh.vertices.size());
      const openvdb::Vec3s p = extracted.pointList()[old];
      const Vec3d voxels = {static_cast<double>(p.x()), static_cast<double>(p.y()),
                            static_cast<double>(p.z())};
      mesh.vertices.push_back(vec_cast<float>(voxel_m * voxels));
    }
    return new_index[old];
  };
  for (std::size_t pool = 0; pool < extracted.polygonPoolListSize(); ++pool) {
    openvdb::tools::PolygonPool& polygons = extracted.polygonPoolList()[pool];
    for (std::size_t k = 0; k < polygons.numQuads(); ++k) {
      const openvdb::Vec4I& q = polygons.quad(k);
      const std::array<std::uint32_t, 4> v = {vertex(q[0]), vertex(q[1]), vertex(q[2]),
                                              vertex(q[3])};
      // OpenVDB's faces are clockwise.
      mesh.triangles.push_back({v[0], v[2], v[1]});
      mesh.triangles.push_back({v[0], v[3], v[2]});
    }
    for (std::size_t k = 0; k < polygons.numTriangles(); ++k) {
      const openvdb::Vec3I& t = polygons.triangle(k);
      mesh.triangles.push_back({vertex(t[0]), vertex(t[2]), vertex(t[1])});
    }
    polygons.clearQuads();
    polygons.clearTriangles();
  }
  return mesh;
}

}  // namespace

TriangleMesh imls_surface(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                          const ImlsOptions& options, const Executor& executor) {
  const SparseField field =
      sparse_field(ImlsField(points, normals, options, executor), options, executor);
  openvdb::tools::VolumeToMesh extracted(0.0, 0.0);
  extracted.setSurfaceMask(surface_mask(field, executor));
  // OpenVDB uses the threads of its caller: a loop of two chunks runs the call on the executor's.
  executor.for_chunks(2, 1, [&](std::size_t begin, std::size_t) {
    if (begin == 0) extracted(*field.values);
  });
  field.values->clear();
  return to_triangles(extracted, options.voxel_m);
}

}  // namespace adasplats

#else

namespace adasplats {

TriangleMesh imls_surface(std::span<const Vec3f>, std::span<const Vec3f>, const ImlsOptions&,
                          const Executor&) {
  throw Error(ErrorKind::unavailable,
              "this program was built without OpenVDB, which IMLS needs; install libopenvdb-dev "
              "and libboost-dev and build again");
}

}  // namespace adasplats

#endif
