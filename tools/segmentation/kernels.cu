// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What training spends its time in, without the tables of (points, neighbours, kernel points) that
// PyTorch's own operations need: neighbours of cell means, sums over kernel points and largest
// values of neighbourhoods, and the gradients of both. kernels.py builds and calls them. A warp
// takes one point; neighbours come first in a row of a table, then indices >= `supports`.
#include <cuda_bf16.h>
#include <cuda_runtime.h>

#include <cstdint>

namespace adasplats_training {

struct Grid {
  float low[3];
  float radius;
  std::int64_t size_y, size_z;

  __device__ std::int64_t cell(const float* p, int axis) const {
    return static_cast<std::int64_t>(floorf((p[axis] - low[axis]) / radius));
  }
  __device__ std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (x * size_y + y) * size_z + z;
  }
};

struct Reach {
  const float* queries;
  const float* supports;
  const std::int32_t* table;
  const float* kernel;  // (15, 3)
  std::int64_t count, supports_count;
  int slots;
  float sigma;
};

}  // namespace adasplats_training

using adasplats_training::Grid;
using adasplats_training::Reach;

namespace {

constexpr int kLanes = 32;
constexpr int kWarps = 4;
constexpr int kKernel = 15;
constexpr int kPadded = 16;
constexpr unsigned kAll = 0xffffffffU;

__global__ void keys_kernel(const float* points, std::int64_t count, Grid grid,
                            std::int64_t* keys) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count) return;
  const float* p = points + 3 * i;
  keys[i] = grid.key(grid.cell(p, 0), grid.cell(p, 1), grid.cell(p, 2));
}

__device__ std::int64_t first_not_below(const std::int64_t* keys, std::int64_t count,
                                        std::int64_t key) {
  std::int64_t low = 0, high = count;
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (keys[middle] < key)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

struct Candidate {
  float squared;
  std::int32_t index;
  __device__ bool operator<(const Candidate& other) const {
    return squared != other.squared ? squared < other.squared : index < other.index;
  }
};

__global__ void neighbors_kernel(const float* queries, std::int64_t count, const float* supports,
                                 const std::int64_t* keys, const std::int64_t* order,
                                 std::int64_t supports_count, Grid grid, int slots, int capacity,
                                 std::int32_t* table) {
  extern __shared__ Candidate shared[];
  const int warp = threadIdx.x / kLanes, lane = threadIdx.x % kLanes;
  const std::int64_t query = std::int64_t{blockIdx.x} * kWarps + warp;
  if (query >= count) return;
  Candidate* const found = shared + warp * capacity;
  const float* q = queries + 3 * query;
  const std::int64_t x = grid.cell(q, 0), y = grid.cell(q, 1), z = grid.cell(q, 2);
  // Lane k < 9 knows where the k-th column of cells begins and ends.
  std::int64_t begin = 0, end = 0;
  if (lane < 9) {
    const std::int64_t key = grid.key(x + lane / 3 - 1, y + lane % 3 - 1, z - 1);
    begin = first_not_below(keys, supports_count, key);
    end = first_not_below(keys, supports_count, key + 3);
  }
  int total = 0;
  for (int column = 0; column < 9; ++column) {
    const std::int64_t first = __shfl_sync(kAll, begin, column);
    const std::int64_t last = __shfl_sync(kAll, end, column);
    for (std::int64_t at = first; at < last; at += kLanes) {
      Candidate own{INFINITY, 0};
      if (at + lane < last) {
        own.index = static_cast<std::int32_t>(order[at + lane]);
        const float* s = supports + 3 * std::int64_t{own.index};
        const float dx = s[0] - q[0], dy = s[1] - q[1], dz = s[2] - q[2];
        own.squared = dx * dx + dy * dy + dz * dz;
      }
      const bool inside = own.squared < grid.radius * grid.radius;
      const unsigned ballot = __ballot_sync(kAll, inside);
      const int place = total + __popc(ballot & ((1U << lane) - 1));
      if (inside && place < capacity) found[place] = own;
      total += __popc(ballot);
    }
  }
  __syncwarp();
  total = min(total, capacity);
  std::int32_t* const row = table + query * slots;
  for (int k = total + lane; k < slots; k += kLanes)
    row[k] = static_cast<std::int32_t>(supports_count);
  for (int k = lane; k < total; k += kLanes) {
    const Candidate own = found[k];
    int rank = 0;
    for (int other = 0; other < total; ++other) rank += found[other] < own;
    if (rank < slots) row[rank] = own.index;
  }
}

/// What a warp knows of its point: the influences of kernel points on neighbours.
struct WarpShared {
  float weight[kLanes][kPadded];
  std::int32_t index[kLanes];
};

/// How many neighbours there are.
__device__ int fill(const Reach& reach, std::int64_t query, int lane, WarpShared& mine) {
  const std::int32_t index = lane < reach.slots ? reach.table[query * reach.slots + lane]
                                                : static_cast<std::int32_t>(reach.supports_count);
  const bool valid = index < reach.supports_count;
  mine.index[lane] = index;
  if (valid) {
    const float* q = reach.queries + 3 * query;
    const float* s = reach.supports + 3 * std::int64_t{index};
    const float x = s[0] - q[0], y = s[1] - q[1], z = s[2] - q[2];
    for (int k = 0; k < kKernel; ++k) {
      const float dx = x - reach.kernel[3 * k], dy = y - reach.kernel[3 * k + 1],
                  dz = z - reach.kernel[3 * k + 2];
      mine.weight[lane][k] = fmaxf(0.0F, 1 - sqrtf(dx * dx + dy * dy + dz * dz) / reach.sigma);
    }
    mine.weight[lane][kKernel] = 0;
  }
  __syncwarp();
  return __popc(__ballot_sync(kAll, valid));
}

__device__ float2 load(const float* from) { return *reinterpret_cast<const float2*>(from); }
__device__ float2 load(const __nv_bfloat16* from) {
  return __bfloat1622float2(*reinterpret_cast<const __nv_bfloat162*>(from));
}
__device__ void store(float* to, float2 value) { *reinterpret_cast<float2*>(to) = value; }
__device__ void store(__nv_bfloat16* to, float2 value) {
  *reinterpret_cast<__nv_bfloat162*>(to) = __float22bfloat162_rn(value);
}

/// Two channels a lane; with fewer than 64 channels groups of lanes take neighbours in turns.
struct Share {
  int width, groups, group, channel;
  __device__ Share(int channels, int lane) {
    width = min(channels / 2, kLanes);
    groups = kLanes / width;
    group = lane / width;
    channel = 2 * (lane % width);
  }
};

template <class T>
__global__ void weighted_kernel(Reach reach, const T* values, int channels, T* out) {
  __shared__ WarpShared shared[kWarps];
  const int warp = threadIdx.x / kLanes, lane = threadIdx.x % kLanes;
  const std::int64_t query = std::int64_t{blockIdx.x} * kWarps + warp;
  if (query >= reach.count) return;
  WarpShared& mine = shared[warp];
  const int count = fill(reach, query, lane, mine);
  const Share share(channels, lane);
  for (int channel = share.channel; channel < channels; channel += 2 * kLanes) {
    float2 sums[kKernel] = {};
    for (int h = share.group; h < count; h += share.groups) {
      const float2 value = load(values + std::int64_t{mine.index[h]} * channels + channel);
#pragma unroll
      for (int k = 0; k < kKernel; ++k) {
        sums[k].x += mine.weight[h][k] * value.x;
        sums[k].y += mine.weight[h][k] * value.y;
      }
    }
#pragma unroll
    for (int k = 0; k < kKernel; ++k) {
      for (int apart = share.width; apart < kLanes; apart *= 2) {
        sums[k].x += __shfl_xor_sync(kAll, sums[k].x, apart);
        sums[k].y += __shfl_xor_sync(kAll, sums[k].y, apart);
      }
      if (share.group == 0) store(out + (query * kKernel + k) * channels + channel, sums[k]);
    }
  }
}

template <class T>
__global__ void weighted_back_kernel(Reach reach, const T* gradient, int channels, float* sums) {
  __shared__ WarpShared shared[kWarps];
  const int warp = threadIdx.x / kLanes, lane = threadIdx.x % kLanes;
  const std::int64_t query = std::int64_t{blockIdx.x} * kWarps + warp;
  if (query >= reach.count) return;
  WarpShared& mine = shared[warp];
  const int count = fill(reach, query, lane, mine);
  const Share share(channels, lane);
  for (int channel = share.channel; channel < channels; channel += 2 * kLanes) {
    float2 own[kKernel];
#pragma unroll
    for (int k = 0; k < kKernel; ++k)
      own[k] = load(gradient + (query * kKernel + k) * channels + channel);
    for (int h = share.group; h < count; h += share.groups) {
      float2 sum{0, 0};
#pragma unroll
      for (int k = 0; k < kKernel; ++k) {
        sum.x += mine.weight[h][k] * own[k].x;
        sum.y += mine.weight[h][k] * own[k].y;
      }
      float* const to = sums + std::int64_t{mine.index[h]} * channels + channel;
#if __CUDA_ARCH__ >= 900
      atomicAdd(reinterpret_cast<float2*>(to), sum);
#else
      atomicAdd(to, sum.x);
      atomicAdd(to + 1, sum.y);
#endif
    }
  }
}

template <class T>
__global__ void largest_kernel(const std::int32_t* table, std::int64_t count,
                               std::int64_t supports_count, int slots, const T* values,
                               int channels, T* out, std::int32_t* from) {
  const std::int64_t query = std::int64_t{blockIdx.x} * kWarps + threadIdx.x / kLanes;
  if (query >= count) return;
  const std::int32_t* const row = table + query * slots;
  for (int channel = 2 * (threadIdx.x % kLanes); channel < channels; channel += 2 * kLanes) {
    float2 best{-INFINITY, -INFINITY};
    std::int32_t best_x = -1, best_y = -1;
    int h = 0;
    for (; h < slots && row[h] < supports_count; ++h) {
      const float2 value = load(values + std::int64_t{row[h]} * channels + channel);
      if (value.x > best.x) best.x = value.x, best_x = row[h];
      if (value.y > best.y) best.y = value.y, best_y = row[h];
    }
    if (h < slots) {  // what is missing counts as zero
      if (!(best.x >= 0)) best.x = 0, best_x = -1;
      if (!(best.y >= 0)) best.y = 0, best_y = -1;
    }
    store(out + query * channels + channel, best);
    from[query * channels + channel] = best_x;
    from[query * channels + channel + 1] = best_y;
  }
}

template <class T>
__global__ void largest_back_kernel(const std::int32_t* from, std::int64_t count, int channels,
                                    const T* gradient, float* sums) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count * channels || from[i] < 0) return;
  atomicAdd(sums + std::int64_t{from[i]} * channels + i % channels,
            static_cast<float>(gradient[i]));
}

template <class T>
__global__ void gather_back_kernel(const std::int32_t* from, std::int64_t count, int channels,
                                   const T* gradient, float* sums) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count * channels) return;
  atomicAdd(sums + std::int64_t{from[i / channels]} * channels + i % channels,
            static_cast<float>(gradient[i]));
}

unsigned blocks(std::int64_t count, int each) {
  return static_cast<unsigned>((count + each - 1) / each);
}

constexpr int kThreads = 256;

}  // namespace

// Every function queues its work on the stream and gives a cudaError_t.
extern "C" {

int adasplats_keys(const float* points, std::int64_t count, const Grid* grid, std::int64_t* keys,
                   cudaStream_t stream) {
  keys_kernel<<<blocks(count, kThreads), kThreads, 0, stream>>>(points, count, *grid, keys);
  return cudaGetLastError();
}

int adasplats_neighbors(const float* queries, std::int64_t count, const float* supports,
                        const std::int64_t* keys, const std::int64_t* order,
                        std::int64_t supports_count, const Grid* grid, int slots, int capacity,
                        std::int32_t* table, cudaStream_t stream) {
  neighbors_kernel<<<blocks(count, kWarps), kWarps * kLanes, kWarps * capacity * sizeof(Candidate),
                     stream>>>(queries, count, supports, keys, order, supports_count, *grid, slots,
                               capacity, table);
  return cudaGetLastError();
}

int adasplats_weighted(const Reach* reach, const void* values, int channels, int is_bf16, void* out,
                       cudaStream_t stream) {
  const unsigned grid = blocks(reach->count, kWarps);
  if (is_bf16 != 0)
    weighted_kernel<<<grid, kWarps * kLanes, 0, stream>>>(
        *reach, static_cast<const __nv_bfloat16*>(values), channels,
        static_cast<__nv_bfloat16*>(out));
  else
    weighted_kernel<<<grid, kWarps * kLanes, 0, stream>>>(*reach, static_cast<const float*>(values),
                                                          channels, static_cast<float*>(out));
  return cudaGetLastError();
}

int adasplats_weighted_back(const Reach* reach, const void* gradient, int channels, int is_bf16,
                            float* sums, cudaStream_t stream) {
  const unsigned grid = blocks(reach->count, kWarps);
  if (is_bf16 != 0)
    weighted_back_kernel<<<grid, kWarps * kLanes, 0, stream>>>(
        *reach, static_cast<const __nv_bfloat16*>(gradient), channels, sums);
  else
    weighted_back_kernel<<<grid, kWarps * kLanes, 0, stream>>>(
        *reach, static_cast<const float*>(gradient), channels, sums);
  return cudaGetLastError();
}

int adasplats_largest(const std::int32_t* table, std::int64_t count, std::int64_t supports_count,
                      int slots, const void* values, int channels, int is_bf16, void* out,
                      std::int32_t* from, cudaStream_t stream) {
  const unsigned grid = blocks(count, kWarps);
  if (is_bf16 != 0)
    largest_kernel<<<grid, kWarps * kLanes, 0, stream>>>(
        table, count, supports_count, slots, static_cast<const __nv_bfloat16*>(values), channels,
        static_cast<__nv_bfloat16*>(out), from);
  else
    largest_kernel<<<grid, kWarps * kLanes, 0, stream>>>(table, count, supports_count, slots,
                                                         static_cast<const float*>(values),
                                                         channels, static_cast<float*>(out), from);
  return cudaGetLastError();
}

int adasplats_scatter(const std::int32_t* from, std::int64_t count, int channels, int of_rows,
                      const void* gradient, int is_bf16, float* sums, cudaStream_t stream) {
  const unsigned grid = blocks(count * channels, kThreads);
  const auto* const bf16 = static_cast<const __nv_bfloat16*>(gradient);
  const auto* const whole = static_cast<const float*>(gradient);
  if (of_rows != 0 && is_bf16 != 0)
    gather_back_kernel<<<grid, kThreads, 0, stream>>>(from, count, channels, bf16, sums);
  else if (of_rows != 0)
    gather_back_kernel<<<grid, kThreads, 0, stream>>>(from, count, channels, whole, sums);
  else if (is_bf16 != 0)
    largest_back_kernel<<<grid, kThreads, 0, stream>>>(from, count, channels, bf16, sums);
  else
    largest_back_kernel<<<grid, kThreads, 0, stream>>>(from, count, channels, whole, sums);
  return cudaGetLastError();
}
}
