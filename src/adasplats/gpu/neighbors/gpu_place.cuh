// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"

namespace adasplats::gpu {

/// Private to gpu/: where the steps of a method run and what they keep is, as CpuPlace: a stream
/// and the memory of one GPU. Nothing else of the GPU may live longer than the place.
class GpuPlace {
 public:
  template <class T>
  using Array = DeviceBuffer<T>;
  using Cloud = DeviceCloud;

  /// The device must be the current one.
  explicit GpuPlace(int device) : device_(device), pool_(device) {}
  /// The pool gives back what is free when its guard ends.
  ~GpuPlace() { static_cast<void>(cudaStreamSynchronize(stream())); }
  GpuPlace(const GpuPlace&) = delete;
  GpuPlace& operator=(const GpuPlace&) = delete;

  cudaStream_t stream() const { return stream_.get(); }
  DeviceGuard enter() const { return DeviceGuard(device_); }
  void wait(const char* doing) const { stream_.wait(doing); }

  template <class T>
  DeviceBuffer<T> array(std::size_t size) const {
    return DeviceBuffer<T>(size, stream());
  }
  template <class Step>
  void for_each(std::size_t count, const char* doing, const Step& step) const {
    gpu::for_each(count, stream(), doing, step);
  }
  template <class OnDevice>
  static auto on_host(const OnDevice& values) {
    return values.download();
  }

  DeviceCloud load(const PointCloud& cloud, std::span<const std::uint8_t> removed) const {
    return load_in_order(cloud, removed, stream());
  }
  template <class Values>
  Values gather(const Values& values, const DeviceBuffer<std::uint32_t>& at) const {
    return gpu::gather(values, at, stream());
  }
  DeviceBuffer<std::uint32_t> flagged(const DeviceBuffer<std::uint8_t>& flags) const {
    return gpu::flagged(flags.data(), flags.size(), stream());
  }

 private:
  int device_;
  MemoryPoolGuard pool_;
  Stream stream_;
};

}  // namespace adasplats::gpu
