// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/group_search.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <limits>
#include <utility>

// Only what follows is compiled for AVX2; headers above stay at the baseline, so that no shared
// inline function of theirs is emitted with instructions an older CPU lacks.
#pragma GCC push_options
#pragma GCC target("avx2,bmi,popcnt")

namespace adasplats::detail {
namespace {

struct GroupBox {
  float low[3], high[3];
};
using LeafBox = GroupBox;
/// The nearest point of a leaf, the first of equally near ones.
struct Nearest {
  float distance2;
  std::uint32_t lane;
};

/// max(low_a - high_b, low_b - high_a, 0): the gap between two intervals.
inline __m256 gap(__m256 low_a, __m256 high_a, __m256 low_b, __m256 high_b) {
  return _mm256_max_ps(_mm256_max_ps(_mm256_sub_ps(low_a, high_b), _mm256_sub_ps(low_b, high_a)),
                       _mm256_setzero_ps());
}

inline __m256 squared_norm(__m256 dx, __m256 dy, __m256 dz) {
  return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)),
                       _mm256_mul_ps(dz, dz));
}

inline unsigned mask_within(__m256 distance2, __m256 bound) {
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(distance2, bound, _CMP_LE_OQ)));
}

inline unsigned boxes_within(const PointIndex::Node& node, const GroupBox& box, float bound,
                             float* distance2) {
  __m256 d[3];
  for (int axis = 0; axis < 3; ++axis)
    d[axis] = gap(_mm256_load_ps(node.low[axis].data()), _mm256_load_ps(node.high[axis].data()),
                  _mm256_set1_ps(box.low[axis]), _mm256_set1_ps(box.high[axis]));
  const __m256 result = squared_norm(d[0], d[1], d[2]);
  _mm256_store_ps(distance2, result);
  return mask_within(result, _mm256_set1_ps(bound));
}

inline unsigned queries_near(const Queries& group, const LeafBox& box) {
  unsigned mask = 0;
  for (unsigned half = 0; half < 2; ++half) {
    const float* coordinates[3] = {group.x + 8 * half, group.y + 8 * half, group.z + 8 * half};
    __m256 d[3];
    for (int axis = 0; axis < 3; ++axis) {
      const __m256 q = _mm256_load_ps(coordinates[axis]);
      d[axis] = gap(q, q, _mm256_set1_ps(box.low[axis]), _mm256_set1_ps(box.high[axis]));
    }
    mask |= mask_within(squared_norm(d[0], d[1], d[2]), _mm256_load_ps(group.bound + 8 * half))
            << (8 * half);
  }
  return mask;
}

inline unsigned points_within(const float* x, const float* y, const float* z, float qx, float qy,
                              float qz, float bound, float* distance2) {
  unsigned mask = 0;
  for (unsigned half = 0; half < 2; ++half) {
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x + 8 * half), _mm256_set1_ps(qx));
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y + 8 * half), _mm256_set1_ps(qy));
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z + 8 * half), _mm256_set1_ps(qz));
    const __m256 d2 = squared_norm(dx, dy, dz);
    _mm256_store_ps(distance2 + 8 * half, d2);
    mask |= mask_within(d2, _mm256_set1_ps(bound)) << (8 * half);
  }
  return mask;
}

/// The largest of 8 lanes, in all of them.
inline __m256 max_of_lanes(__m256 v) {
  v = _mm256_max_ps(v, _mm256_permute2f128_ps(v, v, 1));
  v = _mm256_max_ps(v, _mm256_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 3, 2)));
  return _mm256_max_ps(v, _mm256_shuffle_ps(v, v, _MM_SHUFFLE(2, 3, 0, 1)));
}

inline __m256 min_of_lanes(__m256 v) {
  v = _mm256_min_ps(v, _mm256_permute2f128_ps(v, v, 1));
  v = _mm256_min_ps(v, _mm256_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 3, 2)));
  return _mm256_min_ps(v, _mm256_shuffle_ps(v, v, _MM_SHUFFLE(2, 3, 0, 1)));
}

inline float largest_bound(const Queries& group) {
  return _mm256_cvtss_f32(
      max_of_lanes(_mm256_max_ps(_mm256_load_ps(group.bound), _mm256_load_ps(group.bound + 8))));
}

inline Nearest nearest_of_leaf(const float* x, const float* y, const float* z, float qx, float qy,
                               float qz) {
  __m256 d2[2];
  for (unsigned half = 0; half < 2; ++half) {
    const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(x + 8 * half), _mm256_set1_ps(qx));
    const __m256 dy = _mm256_sub_ps(_mm256_loadu_ps(y + 8 * half), _mm256_set1_ps(qy));
    const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(z + 8 * half), _mm256_set1_ps(qz));
    d2[half] = squared_norm(dx, dy, dz);
  }
  const __m256 minimum = min_of_lanes(_mm256_min_ps(d2[0], d2[1]));
  const unsigned lanes = mask_within(d2[0], minimum) | mask_within(d2[1], minimum) << 8;
  return {_mm256_cvtss_f32(minimum), static_cast<unsigned>(__builtin_ctz(lanes | 1U << 16))};
}

/// For every mask of 8 lanes the lanes that are set, first ones first.
struct CompressTable {
  std::uint8_t lanes[256][8];
  constexpr CompressTable() : lanes{} {
    for (unsigned mask = 0; mask < 256; ++mask) {
      unsigned at = 0;
      for (unsigned lane = 0; lane < 8; ++lane)
        if ((mask >> lane & 1U) != 0) lanes[mask][at++] = static_cast<std::uint8_t>(lane);
    }
  }
};
constexpr CompressTable kCompress;

/// Stores the lanes of `mask` side by side; writes 8 lanes in all.
inline void compress(unsigned mask, __m256 distances, __m256i ranks, float* to_distances,
                     std::uint32_t* to_ranks) {
  const __m256i lanes = _mm256_cvtepu8_epi32(
      _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kCompress.lanes[mask])));
  _mm256_storeu_ps(to_distances, _mm256_permutevar8x32_ps(distances, lanes));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to_ranks),
                      _mm256_permutevar8x32_epi32(ranks, lanes));
}

inline std::uint32_t append(unsigned points, const float* distance2, std::uint32_t first_rank,
                            float* distances, std::uint32_t* ranks) {
  const __m256i ramp = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::uint32_t count = 0;
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned mask = points >> (8 * half) & 0xffU;
    const __m256i rank =
        _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(first_rank + 8 * half)), ramp);
    compress(mask, _mm256_load_ps(distance2 + 8 * half), rank, distances + count, ranks + count);
    count += static_cast<std::uint32_t>(__builtin_popcount(mask));
  }
  return count;
}

inline std::uint32_t count_within(const float* distances, std::uint32_t padded, float bound) {
  const __m256 bounds = _mm256_set1_ps(bound);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < padded; i += 8)
    count += static_cast<std::uint32_t>(
        __builtin_popcount(mask_within(_mm256_loadu_ps(distances + i), bounds)));
  return count;
}

inline std::uint32_t keep_within(float* distances, std::uint32_t* ranks, std::uint32_t padded,
                                 float bound) {
  const __m256 bounds = _mm256_set1_ps(bound);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < padded; i += 8) {
    const __m256 distance = _mm256_loadu_ps(distances + i);
    const __m256i rank = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(ranks + i));
    const unsigned mask = mask_within(distance, bounds);
    compress(mask, distance, rank, distances + kept, ranks + kept);
    kept += static_cast<std::uint32_t>(__builtin_popcount(mask));
  }
  return kept;
}

#include "adasplats/neighbors/group_search_kernel.inc"

}  // namespace

SearchFunctions avx2_search() { return {find_neighbors, find_nearest}; }

}  // namespace adasplats::detail

#pragma GCC pop_options
#endif
