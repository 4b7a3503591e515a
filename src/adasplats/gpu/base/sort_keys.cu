// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"

namespace adasplats::gpu {
namespace {

/// Calls a CUB algorithm twice: for the size of its scratch memory, and to run it.
template <class F>
void with_scratch(cudaStream_t stream, const char* doing, F&& algorithm) {
  std::size_t bytes = 0;
  cuda_check(algorithm(nullptr, bytes), doing);
  DeviceBuffer<unsigned char> scratch(bytes, stream);
  cuda_check(algorithm(scratch.data(), bytes), doing);
}

template <class Key>
void sort_pairs_of(DeviceBuffer<Key>& keys, DeviceBuffer<std::uint32_t>& values,
                   cudaStream_t stream, int first_bit, int end_bit) {
  if (keys.empty()) return;
  DeviceBuffer<Key> other_keys(keys.size(), stream);
  DeviceBuffer<std::uint32_t> other_values(values.size(), stream);
  cub::DoubleBuffer<Key> both_keys(keys.data(), other_keys.data());
  cub::DoubleBuffer<std::uint32_t> both_values(values.data(), other_values.data());
  with_scratch(stream, "sort on the GPU", [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(scratch, bytes, both_keys, both_values,
                                           static_cast<int>(keys.size()), first_bit, end_bit,
                                           stream);
  });
  if (both_keys.Current() != keys.data()) std::swap(keys, other_keys);
  if (both_values.Current() != values.data()) std::swap(values, other_values);
}

struct IsFlagged {
  const std::uint8_t* flags;
  __device__ bool operator()(std::uint32_t i) const { return flags[i] != 0; }
};

struct BeginsRun {
  const std::uint64_t* keys;
  __device__ bool operator()(std::uint32_t i) const { return i == 0 || keys[i] != keys[i - 1]; }
};

/// Numbers below `count` for which `is_wanted` holds, followed by `spare` entries.
template <class F>
DeviceBuffer<std::uint32_t> numbers_where(std::size_t count, std::size_t spare, F is_wanted,
                                          cudaStream_t stream) {
  if (count == 0) return DeviceBuffer<std::uint32_t>(spare, stream);
  DeviceBuffer<std::uint32_t> found(count, stream);
  DeviceBuffer<std::uint32_t> found_count(1, stream);
  with_scratch(stream, "select on the GPU", [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceSelect::If(scratch, bytes, thrust::counting_iterator<std::uint32_t>(0),
                                 found.data(), found_count.data(), static_cast<int>(count),
                                 is_wanted, stream);
  });
  const std::size_t size = read_value(found_count.data(), stream);
  DeviceBuffer<std::uint32_t> result(size + spare, stream);
  cuda_check(cudaMemcpyAsync(result.data(), found.data(), size * sizeof(std::uint32_t),
                             cudaMemcpyDeviceToDevice, stream),
             "select on the GPU");
  return result;
}

struct Widened {
  __host__ __device__ std::uint64_t operator()(std::uint32_t value) const { return value; }
};
using WideCounts = thrust::transform_iterator<Widened, const std::uint32_t*, std::uint64_t>;

}  // namespace

void sort_pairs(DeviceBuffer<std::uint64_t>& keys, DeviceBuffer<std::uint32_t>& values,
                cudaStream_t stream, int first_bit, int end_bit) {
  sort_pairs_of(keys, values, stream, first_bit, end_bit);
}

void sort_pairs(DeviceBuffer<std::uint32_t>& keys, DeviceBuffer<std::uint32_t>& values,
                cudaStream_t stream, int first_bit, int end_bit) {
  sort_pairs_of(keys, values, stream, first_bit, end_bit);
}

DeviceBuffer<std::uint32_t> ascending_numbers(std::size_t count, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> numbers(count, stream);
  for_each(count, stream, "number on the GPU", [to = numbers.data()] __device__(std::uint64_t i) {
    to[i] = static_cast<std::uint32_t>(i);
  });
  return numbers;
}

DeviceBuffer<std::uint32_t> sort_order(DeviceBuffer<std::uint64_t>& keys, cudaStream_t stream,
                                       int first_bit, int end_bit) {
  DeviceBuffer<std::uint32_t> order = ascending_numbers(keys.size(), stream);
  sort_pairs(keys, order, stream, first_bit, end_bit);
  return order;
}

DeviceBuffer<std::uint32_t> flagged(const std::uint8_t* flags, std::size_t count,
                                    cudaStream_t stream) {
  return numbers_where(count, 0, IsFlagged{flags}, stream);
}

DeviceBuffer<std::uint32_t> run_begins(const std::uint64_t* sorted_keys, std::size_t count,
                                       cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> begins = numbers_where(count, 1, BeginsRun{sorted_keys}, stream);
  for_each(1, stream, "select on the GPU",
           [last = begins.data() + begins.size() - 1, count] __device__(std::uint64_t) {
             *last = static_cast<std::uint32_t>(count);
           });
  return begins;
}

DeviceBuffer<std::uint64_t> running_sums(const std::uint32_t* counts, std::size_t count,
                                         cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> sums(count + 1, stream);
  cuda_check(cudaMemsetAsync(sums.data(), 0, sizeof(std::uint64_t), stream), "add on the GPU");
  if (count == 0) return sums;
  with_scratch(stream, "add on the GPU", [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceScan::InclusiveSum(scratch, bytes, WideCounts(counts, Widened{}),
                                         sums.data() + 1, static_cast<int>(count), stream);
  });
  return sums;
}

void sum_in_place(std::uint64_t* values, std::size_t count, cudaStream_t stream) {
  with_scratch(stream, "add on the GPU", [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceScan::ExclusiveSum(scratch, bytes, values, values, static_cast<int>(count),
                                         stream);
  });
}

double sum_in_chunks(const float* values, std::size_t count, cudaStream_t stream) {
  constexpr std::size_t kGrain = 4096;
  const std::size_t chunks = (count + kGrain - 1) / kGrain;
  DeviceBuffer<double> parts(chunks, stream);
  for_each(chunks, stream, "add on the GPU",
           [values, count, to = parts.data()] __device__(std::uint64_t chunk) {
             const std::size_t end = ::min(std::size_t{count}, (chunk + 1) * kGrain);
             double sum = 0;
             for (std::size_t i = chunk * kGrain; i < end; ++i)
               sum += static_cast<double>(values[i]);
             to[chunk] = sum;
           });
  double total = 0;
  for (const double part : parts.download()) total += part;
  return total;
}

std::uint64_t sum_of(const std::uint32_t* values, std::size_t count, cudaStream_t stream) {
  if (count == 0) return 0;
  DeviceBuffer<std::uint64_t> total(1, stream);
  with_scratch(stream, "add on the GPU", [&](void* scratch, std::size_t& bytes) {
    return cub::DeviceReduce::Sum(scratch, bytes, WideCounts(values, Widened{}), total.data(),
                                  static_cast<int>(count), stream);
  });
  return read_value(total.data(), stream);
}

}  // namespace adasplats::gpu
