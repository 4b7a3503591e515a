// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "adasplats/gpu/trace/device_scene.h"

namespace adasplats::gpu {

/// Private to gpu/: TiledTracer (trace/tiled_tracer.h) on the device that was the current one when
/// it was made: a tree a tile, and a small one over those that are shown. All calls with that
/// device as the current one.
class TiledScene : public DeviceScene {
 public:
  /// Builds the tree of a tile that has none. May run beside casts, on one thread at a time.
  virtual void build(std::size_t tile, std::span<const Disk> disks) = 0;
  /// Gives back the memory of a tile that is not shown.
  virtual void drop(std::size_t tile) = 0;
  /// Which of the tiles that are built rays meet from now on. Not beside casts, nor beside build().
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// About how much memory a tile takes for each splat, bytes.
inline constexpr std::size_t kTiledSceneBytesASplat = 64;

/// `splats`: of each tile. Errors: data (more than can be told apart), unavailable.
std::unique_ptr<TiledScene> make_tiled_scene(std::span<const std::size_t> splats);

}  // namespace adasplats::gpu
