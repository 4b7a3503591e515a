// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "adasplats/core/executor.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// A tracer over the splats of a city of which some tiles are in memory: a tree a tile, and a small
/// tree over those that are shown. Hits are those of a tracer over all splats where what a ray
/// meets is shown: primitives are numbered through the whole city, tile after tile.
class TiledTracer : public Tracer {
 public:
  /// Builds the tree of a tile that has none. May run beside casts, and for several tiles at once.
  /// Throws std::logic_error where it has another number of splats than was said.
  virtual void build(std::size_t tile, std::span<const Disk> disks, const Executor& executor) = 0;
  /// Gives back the memory of a tile that is not shown.
  virtual void drop(std::size_t tile) = 0;
  /// Which of the tiles that are built rays meet from now on. Not beside casts.
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// About how much memory a tile takes for each splat, bytes.
inline constexpr std::size_t kTiledTracerBytesASplat = 80;

/// `splats`: of each tile. Errors: data (more splats than can be told apart), unavailable (no room
/// for their addresses).
std::unique_ptr<TiledTracer> make_tiled_tracer(std::span<const std::size_t> splats);

}  // namespace adasplats
