// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/gpu/base/device_memory.h"

namespace adasplats::gpu {

/// Private to gpu/: sorts, selections and sums of device memory on a stream. CUB, which is slow to
/// compile, is included only here. All results are the same on every run and every GPU.
/// At most 2^31 - 1 values.

/// Encodes a float, also a negative one, as bits in the same order; -0 and 0 are equal.
ADASPLATS_HD inline std::uint32_t sortable_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return bits >> 31 != 0 ? ~bits : bits | 0x80000000U;
}

ADASPLATS_HD inline float from_sortable_bits(std::uint32_t bits) {
  return std::bit_cast<float>(bits >> 31 != 0 ? bits & 0x7fffffffU : ~bits);
}

/// Stable sort of keys and their values. Bits outside [first_bit, end_bit) must be equal in all
/// keys.
void sort_pairs(DeviceBuffer<std::uint64_t>& keys, DeviceBuffer<std::uint32_t>& values,
                cudaStream_t stream, int first_bit = 0, int end_bit = 64);
void sort_pairs(DeviceBuffer<std::uint32_t>& keys, DeviceBuffer<std::uint32_t>& values,
                cudaStream_t stream, int first_bit = 0, int end_bit = 32);

/// 0, 1, 2, ...
DeviceBuffer<std::uint32_t> ascending_numbers(std::size_t count, cudaStream_t stream);

/// Sorts the keys and returns the permutation: order[i] is the index before sorting. Stable, as
/// Executor::sort_keys.
DeviceBuffer<std::uint32_t> sort_order(DeviceBuffer<std::uint64_t>& keys, cudaStream_t stream,
                                       int first_bit = 0, int end_bit = 64);

/// Indices of flags that are not 0, ascending. Waits for the stream.
DeviceBuffer<std::uint32_t> flagged(const std::uint8_t* flags, std::size_t count,
                                    cudaStream_t stream);

/// Begins of the runs of equal keys in sorted keys, ascending, followed by `count`; {0} for no
/// keys. Waits for the stream.
DeviceBuffer<std::uint32_t> run_begins(const std::uint64_t* sorted_keys, std::size_t count,
                                       cudaStream_t stream);

/// sums[i] = counts[0] + ... + counts[i - 1] for i in [0, count]: count + 1 entries.
DeviceBuffer<std::uint64_t> running_sums(const std::uint32_t* counts, std::size_t count,
                                         cudaStream_t stream);

/// Exclusive prefix sum, in place.
void sum_in_place(std::uint64_t* values, std::size_t count, cudaStream_t stream);

/// Sum of floats in double, bit-identical to Executor::sum_chunks over chunks of 4096. Waits for
/// the stream.
double sum_in_chunks(const float* values, std::size_t count, cudaStream_t stream);
/// Sum of integers. Waits for the stream.
std::uint64_t sum_of(const std::uint32_t* values, std::size_t count, cudaStream_t stream);

/// Copies one value from the device. Waits for the stream.
template <class T>
T read_value(const T* value, cudaStream_t stream) {
  T result{};
  cuda_check(cudaMemcpyAsync(&result, value, sizeof(T), cudaMemcpyDeviceToHost, stream),
             "copy from the GPU");
  cuda_check(cudaStreamSynchronize(stream), "copy from the GPU");
  return result;
}

}  // namespace adasplats::gpu
