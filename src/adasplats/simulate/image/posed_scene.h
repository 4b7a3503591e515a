// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/scene/scene.h"
#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// A scene and the objects of its world at one time, as one geometry, for pictures. Splats come
/// first (the scene's, then those of each object), then triangles in the same order. Objects of a
/// single scan are left out.
class PosedScene {
 public:
  /// `place`: the scene without its objects; its labels must outlive this.
  PosedScene(const ImageScene& place, const World& world, double time_s);

  /// Views of this object.
  ImageScene scene() const;

 private:
  /// Values of the primitives; dropped at the end if no piece has them.
  template <class T>
  struct Values {
    std::vector<T> all;
    bool any = false;
    void add(std::span<const T> of, std::size_t first, std::size_t count, T missing);
    std::span<const T> view() const { return any ? std::span<const T>(all) : std::span<const T>(); }
  };
  struct Piece;

  void add_disks(const Piece& piece, bool soft);
  void add_triangles(const Piece& piece);
  void add_values(const Piece& piece, std::size_t first, std::size_t count);

  const LabelScheme* labels_;
  Vec3d origin_;
  std::vector<Disk> disks_;
  std::vector<float> opacities_;
  TriangleMesh mesh_;
  Values<std::uint16_t> classes_;
  Values<float> intensities_;
  Values<SemanticGroup> groups_;
  Values<ColorBytes> colors_;
};

}  // namespace adasplats
