// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/device_tiles.h"

#include <cuda_runtime_api.h>

namespace adasplats::gpu {
namespace {

std::vector<std::size_t> first_splats(std::span<const std::size_t> splats) {
  std::vector<std::size_t> first = {0};
  for (const std::size_t count : splats) first.push_back(first.back() + count);
  return first;
}

}  // namespace

DeviceTiles::DeviceTiles(std::span<const std::size_t> splats,
                         std::span<const PrimitiveValues> objects)
    : first_(first_splats(splats)),
      scene_(make_tiled_scene(splats)),
      values_(first_.back() + objects.size()) {
  if (objects.empty()) return;
  values_.hold(first_.back(), first_.back() + objects.size());
  cuda_check(cudaMemcpy(values_.data() + first_.back(), objects.data(), objects.size_bytes(),
                        cudaMemcpyHostToDevice),
             "copy objects to the GPU");
}

void DeviceTiles::load(std::size_t tile, std::span<const Disk> disks,
                       std::span<const PrimitiveValues> values) {
  {
    const std::lock_guard lock(mutex_);
    values_.hold(first_[tile], first_[tile + 1]);
  }
  try {
    cuda_check(cudaMemcpyAsync(values_.data() + first_[tile], values.data(), values.size_bytes(),
                               cudaMemcpyHostToDevice, stream_.get()),
               "copy a tile to the GPU");
    stream_.wait("copy a tile to the GPU");
    scene_->build(tile, disks);
  } catch (...) {
    release(tile);
    throw;
  }
}

void DeviceTiles::drop(std::size_t tile) {
  scene_->drop(tile);
  release(tile);
}

void DeviceTiles::release(std::size_t tile) {
  const std::lock_guard lock(mutex_);
  values_.release(first_[tile], first_[tile + 1]);
}

}  // namespace adasplats::gpu
#endif
