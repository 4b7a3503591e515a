// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"

namespace adasplats::gpu {

/// Sums every `strands`-th element, starting at the strand's number.
template <class Sums, class Step>
struct SumStrand {
  Step step;
  std::uint64_t count, strands;
  Sums* sums;  ///< one per strand

  __device__ void operator()(std::uint64_t strand) const {
    Sums sum{};
    for (std::uint64_t i = strand; i < count; i += strands) step(i, sum);
    sums[strand] = sum;
  }
};

template <class Sums>
struct AddPart {
  const Sums* parts;

  __device__ void operator()(std::uint64_t i, Sums& sum) const { sum += parts[i]; }
};

/// Private to gpu/: the GPU counterpart of CpuBackend, which runs the steps of a method and owns
/// their memory: a stream and the memory pool of one GPU. It must outlive its other GPU objects.
class GpuBackend {
 public:
  template <class T>
  using Array = DeviceBuffer<T>;
  template <class T>
  using Lent = DeviceBuffer<T>;
  using Cloud = DeviceCloud;

  /// The device must be current.
  explicit GpuBackend(int device) : device_(device), pool_(device) {}
  /// The pool releases free memory when its guard is destroyed.
  ~GpuBackend() { static_cast<void>(cudaStreamSynchronize(stream())); }
  GpuBackend(const GpuBackend&) = delete;
  GpuBackend& operator=(const GpuBackend&) = delete;

  cudaStream_t stream() const { return stream_.get(); }
  DeviceGuard enter() const { return DeviceGuard(device_); }
  void wait(const char* doing) const { stream_.wait(doing); }

  template <class T>
  DeviceBuffer<T> array(std::size_t size) const {
    return DeviceBuffer<T>(size, stream());
  }
  template <class T>
  DeviceBuffer<T> zeros(std::size_t size) const {
    DeviceBuffer<T> values(size, stream());
    values.fill_bytes(0);
    return values;
  }
  template <class T>
  void resize(DeviceBuffer<T>& values, std::size_t size) const {
    if (values.size() != size) values = DeviceBuffer<T>(size, stream());
  }
  template <class T>
  DeviceBuffer<T> copied(const std::vector<T>& values) const {
    return {std::span<const T>(values), stream()};
  }
  template <class T>
  DeviceBuffer<T> lent(const std::vector<T>& values) const {
    return copied(values);
  }
  template <class Step>
  void for_each(std::size_t count, const char* doing, const Step& step) const {
    gpu::for_each(count, stream(), doing, step);
  }
  /// Waits for the stream.
  template <class Sums, class Step>
  Sums sum(std::size_t count, const char* doing, const Step& step) const {
    // Every thread has a sum in memory: 2^15 threads fill a GPU, and their sums are added quickly.
    constexpr std::size_t kStrands = std::size_t{1} << 15, kParts = std::size_t{1} << 9;
    const DeviceBuffer<Sums> strands = in_strands<Sums>(count, kStrands, doing, step);
    Sums all{};
    for (const Sums& part :
         in_strands<Sums>(strands.size(), kParts, doing, AddPart<Sums>{strands.data()}).download())
      all += part;
    return all;
  }
  template <class OnDevice>
  static auto on_host(const OnDevice& values) {
    return values.download();
  }

  static CurveBox box_of(const PointCloud& cloud) {
    return curve_box_of(cloud.positions, Executor(1));
  }
  DeviceCloud load(const PointCloud& cloud, const CurveBox& box,
                   std::span<const std::uint8_t> removed) const {
    return load_in_order(cloud, box, removed, stream());
  }
  DeviceCloud load(const PointCloud& cloud, std::span<const std::uint8_t> removed) const {
    return load(cloud, box_of(cloud), removed);
  }
  /// In no other order.
  DeviceCloud load_in_given_order(const PointCloud& cloud) const {
    return copy_to_device(cloud, stream());
  }
  template <class Values>
  Values gather(const Values& values, const DeviceBuffer<std::uint32_t>& at) const {
    return gpu::gather(values, at, stream());
  }
  DeviceBuffer<std::uint32_t> sort(DeviceBuffer<std::uint64_t>& keys) const {
    return sort_order(keys, stream());
  }
  void sort(DeviceBuffer<std::uint64_t>& keys, DeviceBuffer<std::uint32_t>& order) const {
    order = sort_order(keys, stream());
  }
  DeviceBuffer<std::uint32_t> run_begins(const DeviceBuffer<std::uint64_t>& sorted_keys) const {
    return gpu::run_begins(sorted_keys.data(), sorted_keys.size(), stream());
  }
  DeviceBuffer<std::uint64_t> running_sums(const DeviceBuffer<std::uint32_t>& counts) const {
    return gpu::running_sums(counts.data(), counts.size(), stream());
  }
  DeviceBuffer<std::uint32_t> flagged(const DeviceBuffer<std::uint8_t>& flags) const {
    return gpu::flagged(flags.data(), flags.size(), stream());
  }

 private:
  template <class Sums, class Step>
  DeviceBuffer<Sums> in_strands(std::size_t count, std::size_t most, const char* doing,
                                const Step& step) const {
    const std::size_t strands = std::min(count, most);
    DeviceBuffer<Sums> sums(strands, stream());
    gpu::for_each(strands, stream(), doing,
                  SumStrand<Sums, Step>{step, count, strands, sums.data()});
    return sums;
  }

  int device_;
  MemoryPoolGuard pool_;
  Stream stream_;
};

}  // namespace adasplats::gpu
