// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/base/sparse_device_array.h"
#include "adasplats/gpu/trace/tiled_scene.h"
#include "adasplats/simulate/scan/firing_report.h"

namespace adasplats::gpu {

/// Private to gpu/: the tiles of a city that are loaded on one device: their trees (TiledScene) and
/// the attributes of their splats. The device must be current in all calls. load() is not
/// thread-safe.
class DeviceTiles {
 public:
  /// `splats`: number of splats of each tile. `objects`: attributes of the primitives numbered
  /// after all splats. Errors: those of make_tiled_scene().
  DeviceTiles(std::span<const std::size_t> splats, std::span<const PrimitiveValues> objects);

  TiledScene& scene() { return *scene_; }
  const PrimitiveValues* values() const { return values_.data(); }

  /// May run during casts. Errors: unavailable (not enough memory; the tile is not loaded).
  void load(std::size_t tile, std::span<const Disk> disks, std::span<const PrimitiveValues> values);
  void drop(std::size_t tile);

 private:
  void release(std::size_t tile);

  std::vector<std::size_t> first_;  ///< first splat of each tile
  Stream stream_;
  std::unique_ptr<TiledScene> scene_;
  SparseDeviceArray<PrimitiveValues> values_;
  std::mutex mutex_;  ///< of its pages
};

}  // namespace adasplats::gpu
