// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/wide_kernel.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <algorithm>
#include <array>
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

inline unsigned bits(__m256 v) { return static_cast<unsigned>(_mm256_movemask_ps(v)); }
inline __m256i lanes_of(unsigned mask) {
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(mask)), bit), bit);
}

struct F16 {
  __m256 a, b;
};
struct U16 {
  __m256i a, b;
};
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
inline unsigned compared(F16 x, F16 y) {
  return bits(_mm256_cmp_ps(x.a, y.a, kPredicate)) | bits(_mm256_cmp_ps(x.b, y.b, kPredicate)) << 8;
}
inline unsigned less(F16 x, F16 y) { return compared<_CMP_LT_OQ>(x, y); }
inline unsigned at_most(F16 x, F16 y) { return compared<_CMP_LE_OQ>(x, y); }
inline unsigned equal(F16 x, F16 y) { return compared<_CMP_EQ_OQ>(x, y); }
inline F16 choose(unsigned mask, F16 x, F16 y) {
  return {_mm256_blendv_ps(x.a, y.a, _mm256_castsi256_ps(lanes_of(mask))),
          _mm256_blendv_ps(x.b, y.b, _mm256_castsi256_ps(lanes_of(mask >> 8)))};
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
inline unsigned at_least(__m256i x, __m256i y) {
  // There is no unsigned comparison: x >= y if max(x, y) is x.
  return bits(_mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_max_epu32(x, y), x)));
}
inline unsigned less(U16 x, U16 y) {
  return 0xffffU & ~(at_least(x.a, y.a) | at_least(x.b, y.b) << 8);
}
inline U16 choose(unsigned mask, U16 x, U16 y) {
  return {_mm256_blendv_epi8(x.a, y.a, lanes_of(mask)),
          _mm256_blendv_epi8(x.b, y.b, lanes_of(mask >> 8))};
}

#include "adasplats/trace/wide_kernel.inc"

}  // namespace

WideCast avx2_wide_cast() { return cast_rays; }

}  // namespace adasplats::detail

#pragma GCC pop_options
#endif
