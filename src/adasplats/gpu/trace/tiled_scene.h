// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "adasplats/gpu/trace/device_scene.h"

namespace adasplats::gpu {

/// Private to gpu/: TiledTracer (trace/tiled_tracer.h) on one GPU: a tree per tile, and a small
/// tree over the shown tiles. The device that was current at construction must be current in all
/// calls.
class TiledScene : public DeviceScene {
 public:
  /// Builds the tree of a tile without one. May run during casts, on one thread at a time.
  virtual void build(std::size_t tile, std::span<const Disk> disks) = 0;
  /// Frees the memory of a tile that is not shown.
  virtual void drop(std::size_t tile) = 0;
  /// Selects the built tiles that rays can hit from now on. Not during casts or build().
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// Approximate memory of a tile per splat, bytes.
inline constexpr std::size_t kTiledSceneBytesASplat = 64;

/// `splats`: number of splats of each tile. Errors: data (too many splats), unavailable.
std::unique_ptr<TiledScene> make_tiled_scene(std::span<const std::size_t> splats);

}  // namespace adasplats::gpu
