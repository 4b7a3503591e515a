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

/// A tracer for a city with some of its tiles in memory: one tree per tile, and a small tree over
/// the shown tiles. Hits equal those of a tracer over all splats if the tiles that a ray crosses
/// are shown. Primitive indices count through the entire city, tile after tile.
class TiledTracer : public Tracer {
 public:
  /// Builds the tree of a tile that has none. May run during casts, and for several tiles at once.
  /// Throws std::logic_error if the number of splats differs from that in make_tiled_tracer().
  virtual void build(std::size_t tile, std::span<const Disk> disks, const Executor& executor) = 0;
  /// Frees the memory of a tile that is not shown.
  virtual void drop(std::size_t tile) = 0;
  /// Sets the tiles that rays can hit, which must be built. Must not run during casts.
  virtual void show(std::span<const std::size_t> tiles) = 0;
};

/// Approximate memory of a tile per splat, bytes.
inline constexpr std::size_t kTiledTracerBytesASplat = 80;

/// `splats`: number of splats of each tile. Errors: data (more than 2^30 splats), unavailable (no
/// address space).
std::unique_ptr<TiledTracer> make_tiled_tracer(std::span<const std::size_t> splats);

}  // namespace adasplats
