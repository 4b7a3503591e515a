// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/wide_kernel.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "adasplats/scene/soft_disk.h"
#include "adasplats/trace/castable.h"
#include "adasplats/trace/hit_list.h"
#include "adasplats/trace/soft_hits.h"

// Only what follows is compiled for AVX2; headers above stay at the baseline, so that none of their
// shared inline functions is emitted with instructions that an older CPU lacks.
#pragma GCC push_options
#pragma GCC target("avx2,fma,bmi,bmi2,popcnt")

namespace adasplats::detail {
namespace {

struct F16 {
  __m256 a, b;
};
struct U16 {
  __m256i a, b;
};
struct Mask {
  __m256 a, b;
};
inline Mask operator&(Mask x, Mask y) { return {_mm256_and_ps(x.a, y.a), _mm256_and_ps(x.b, y.b)}; }
inline Mask operator|(Mask x, Mask y) { return {_mm256_or_ps(x.a, y.a), _mm256_or_ps(x.b, y.b)}; }
inline Mask without(Mask x, Mask y) {
  return {_mm256_andnot_ps(y.a, x.a), _mm256_andnot_ps(y.b, x.b)};
}
inline unsigned bits(Mask m) {
  return static_cast<unsigned>(_mm256_movemask_ps(m.a) | _mm256_movemask_ps(m.b) << 8);
}
inline F16 operator+(F16 x, F16 y) { return {x.a + y.a, x.b + y.b}; }
inline F16 operator-(F16 x, F16 y) { return {x.a - y.a, x.b - y.b}; }
inline F16 operator*(F16 x, F16 y) { return {x.a * y.a, x.b * y.b}; }
inline F16 operator/(F16 x, F16 y) { return {x.a / y.a, x.b / y.b}; }
inline F16 load(const float* p) { return {_mm256_load_ps(p), _mm256_load_ps(p + 8)}; }
inline F16 all(float v) { return {_mm256_set1_ps(v), _mm256_set1_ps(v)}; }
inline void store(float* p, F16 v) {
  _mm256_store_ps(p, v.a);
  _mm256_store_ps(p + 8, v.b);
}
inline F16 root(F16 x) { return {_mm256_sqrt_ps(x.a), _mm256_sqrt_ps(x.b)}; }
inline F16 fma(F16 x, F16 y, F16 z) {
  return {_mm256_fmadd_ps(x.a, y.a, z.a), _mm256_fmadd_ps(x.b, y.b, z.b)};
}
inline F16 min(F16 x, F16 y) { return {_mm256_min_ps(x.a, y.a), _mm256_min_ps(x.b, y.b)}; }
inline F16 max(F16 x, F16 y) { return {_mm256_max_ps(x.a, y.a), _mm256_max_ps(x.b, y.b)}; }
template <int kPredicate>
inline Mask compared(F16 x, F16 y) {
  return {_mm256_cmp_ps(x.a, y.a, kPredicate), _mm256_cmp_ps(x.b, y.b, kPredicate)};
}
inline Mask less(F16 x, F16 y) { return compared<_CMP_LT_OQ>(x, y); }
inline Mask at_most(F16 x, F16 y) { return compared<_CMP_LE_OQ>(x, y); }
inline Mask equal(F16 x, F16 y) { return compared<_CMP_EQ_OQ>(x, y); }
inline F16 choose(Mask mask, F16 x, F16 y) {
  return {_mm256_blendv_ps(x.a, y.a, mask.a), _mm256_blendv_ps(x.b, y.b, mask.b)};
}
inline float largest(F16 v) {
  __m256 m = _mm256_max_ps(v.a, v.b);
  m = _mm256_max_ps(m, _mm256_permute2f128_ps(m, m, 1));
  m = _mm256_max_ps(m, _mm256_shuffle_ps(m, m, _MM_SHUFFLE(1, 0, 3, 2)));
  return _mm256_cvtss_f32(_mm256_max_ps(m, _mm256_shuffle_ps(m, m, _MM_SHUFFLE(2, 3, 0, 1))));
}
inline float smallest(F16 v) { return -largest(F16{-v.a, -v.b}); }
inline U16 load(const std::uint32_t* p) {
  return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p)),
          _mm256_load_si256(reinterpret_cast<const __m256i*>(p + 8))};
}
inline U16 all(std::uint32_t v) {
  return {_mm256_set1_epi32(static_cast<int>(v)), _mm256_set1_epi32(static_cast<int>(v))};
}
inline void store(std::uint32_t* p, U16 v) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(p), v.a);
  _mm256_store_si256(reinterpret_cast<__m256i*>(p + 8), v.b);
}
inline __m256 less(__m256i x, __m256i y) {
  // There is no unsigned comparison: flipping the highest bits keeps the order.
  const __m256i high = _mm256_set1_epi32(static_cast<int>(0x80000000U));
  return _mm256_castsi256_ps(
      _mm256_cmpgt_epi32(_mm256_xor_si256(y, high), _mm256_xor_si256(x, high)));
}
inline Mask less(U16 x, U16 y) { return {less(x.a, y.a), less(x.b, y.b)}; }
inline U16 choose(Mask mask, U16 x, U16 y) {
  return {_mm256_blendv_epi8(x.a, y.a, _mm256_castps_si256(mask.a)),
          _mm256_blendv_epi8(x.b, y.b, _mm256_castps_si256(mask.b))};
}

inline unsigned push(const WideNode& node, unsigned octant, Mask mask, F16 from,
                     std::uint32_t first, float* to_from, std::uint32_t* to_entries) {
  alignas(64) float begin[kWide];
  store(begin, from);
  // One byte per child, from far to near.
  const __m256i pairs = _mm256_permute4x64_epi64(
      _mm256_packs_epi32(_mm256_castps_si256(mask.a), _mm256_castps_si256(mask.b)), 0xd8);
  const __m128i bytes =
      _mm_packs_epi16(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1));
  const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(node.far_first[octant]));
  auto kept = static_cast<unsigned>(_mm_movemask_epi8(_mm_shuffle_epi8(bytes, order)));
  unsigned count = 0;
  for (; kept != 0; kept &= kept - 1) {
    const unsigned child = node.far_first[octant][__builtin_ctz(kept)];
    to_from[count] = begin[child];
    to_entries[count++] = first + child;
  }
  return count;
}

#define ADASPLATS_WIDE_PUSH  // push() is defined above
#include "adasplats/trace/wide_kernel.inc"
#undef ADASPLATS_WIDE_PUSH

}  // namespace

WideVersion avx2_wide() { return {"avx2", cast_rays, all_hits}; }

}  // namespace adasplats::detail

#pragma GCC pop_options
#endif
