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

// Only what follows is compiled for AVX-512; headers above stay at the baseline, so that none of
// their shared inline functions is emitted with instructions that an older CPU lacks.
#pragma GCC push_options
#if !defined(__clang__)
// gcc 12 warns about its own header, with sanitizers also about uninitialized values.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#pragma GCC target("avx512f,avx512vl,avx512bw,avx512dq,fma,bmi,bmi2,popcnt,prefer-vector-width=512")

namespace adasplats::detail {
namespace {

using F16 = __m512;
using U16 = __m512i;
struct Mask {
  __mmask16 lanes;
};
inline Mask operator&(Mask a, Mask b) { return {_kand_mask16(a.lanes, b.lanes)}; }
inline Mask operator|(Mask a, Mask b) { return {_kor_mask16(a.lanes, b.lanes)}; }
inline Mask without(Mask a, Mask b) { return {_kandn_mask16(b.lanes, a.lanes)}; }
inline unsigned bits(Mask m) { return m.lanes; }
inline F16 load(const float* p) { return _mm512_load_ps(p); }
inline F16 all(float v) { return _mm512_set1_ps(v); }
inline void store(float* p, F16 v) { _mm512_store_ps(p, v); }
inline F16 root(F16 v) { return _mm512_sqrt_ps(v); }
inline F16 fma(F16 a, F16 b, F16 c) { return _mm512_fmadd_ps(a, b, c); }
inline F16 min(F16 a, F16 b) { return _mm512_min_ps(a, b); }
inline F16 max(F16 a, F16 b) { return _mm512_max_ps(a, b); }
inline Mask less(F16 a, F16 b) { return {_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ)}; }
inline Mask at_most(F16 a, F16 b) { return {_mm512_cmp_ps_mask(a, b, _CMP_LE_OQ)}; }
inline Mask equal(F16 a, F16 b) { return {_mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ)}; }
inline F16 choose(Mask mask, F16 a, F16 b) { return _mm512_mask_blend_ps(mask.lanes, a, b); }
inline float largest(F16 v) { return _mm512_reduce_max_ps(v); }
inline float smallest(F16 v) { return _mm512_reduce_min_ps(v); }
inline U16 load(const std::uint32_t* p) { return _mm512_load_si512(p); }
inline U16 all(std::uint32_t v) { return _mm512_set1_epi32(static_cast<int>(v)); }
inline void store(std::uint32_t* p, U16 v) { _mm512_store_si512(p, v); }
inline Mask less(U16 a, U16 b) { return {_mm512_cmplt_epu32_mask(a, b)}; }
inline U16 choose(Mask mask, U16 a, U16 b) { return _mm512_mask_blend_epi32(mask.lanes, a, b); }

inline unsigned push(const WideNode& node, unsigned octant, Mask mask, F16 from,
                     std::uint32_t first, float* to_from, std::uint32_t* to_entries) {
  const U16 order = _mm512_cvtepu8_epi32(
      _mm_load_si128(reinterpret_cast<const __m128i*>(node.far_first[octant])));
  const F16 ordered = _mm512_permutexvar_ps(order, choose(mask, all(HUGE_VALF), from));
  const __mmask16 kept = _mm512_cmp_ps_mask(ordered, all(HUGE_VALF), _CMP_LT_OQ);
  _mm512_storeu_ps(to_from, _mm512_maskz_compress_ps(kept, ordered));
  _mm512_storeu_si512(to_entries,
                      _mm512_add_epi32(_mm512_maskz_compress_epi32(kept, order), all(first)));
  return static_cast<unsigned>(__builtin_popcount(kept));
}

#define ADASPLATS_WIDE_PUSH  // push() is defined above
#include "adasplats/trace/wide_kernel.inc"
#undef ADASPLATS_WIDE_PUSH

}  // namespace

WideVersion avx512_wide() { return {"avx512", cast_rays, all_hits}; }

}  // namespace adasplats::detail

#pragma GCC pop_options
#endif
