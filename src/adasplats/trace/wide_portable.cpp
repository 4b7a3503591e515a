// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
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
#include "adasplats/trace/wide_kernel.h"

namespace adasplats::detail {
namespace {

template <class T>
struct Lanes {
  T v[16];
};
using F16 = Lanes<float>;
using U16 = Lanes<std::uint32_t>;

template <class T, class F>
inline Lanes<T> lanewise(const Lanes<T>& a, const Lanes<T>& b, F f) {
  Lanes<T> result;
  for (unsigned i = 0; i < 16; ++i) result.v[i] = f(a.v[i], b.v[i]);
  return result;
}
struct Mask {
  unsigned lanes;
};
inline Mask operator&(Mask a, Mask b) { return {a.lanes & b.lanes}; }
inline Mask operator|(Mask a, Mask b) { return {a.lanes | b.lanes}; }
inline Mask without(Mask a, Mask b) { return {a.lanes & ~b.lanes}; }
inline unsigned bits(Mask m) { return m.lanes; }
template <class T, class F>
inline Mask mask_of(const Lanes<T>& a, const Lanes<T>& b, F f) {
  unsigned mask = 0;
  for (unsigned i = 0; i < 16; ++i) mask |= static_cast<unsigned>(f(a.v[i], b.v[i])) << i;
  return {mask};
}
inline F16 operator+(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x + y; });
}
inline F16 operator-(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x - y; });
}
inline F16 operator*(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x * y; });
}
inline F16 operator/(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x / y; });
}
inline F16 min(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline F16 max(const F16& a, const F16& b) {
  return lanewise(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline F16 root(const F16& a) {
  return lanewise(a, a, [](float x, float) { return std::sqrt(x); });
}
inline F16 fma(const F16& a, const F16& b, const F16& c) { return a * b + c; }
template <class T>
inline Mask less(const Lanes<T>& a, const Lanes<T>& b) {
  return mask_of(a, b, [](T x, T y) { return x < y; });
}
inline Mask at_most(const F16& a, const F16& b) {
  return mask_of(a, b, [](float x, float y) { return x <= y; });
}
inline Mask equal(const F16& a, const F16& b) {
  return mask_of(a, b, [](float x, float y) { return x == y; });
}
template <class T>
inline Lanes<T> load(const T* p) {
  Lanes<T> result;
  for (unsigned i = 0; i < 16; ++i) result.v[i] = p[i];
  return result;
}
template <class T>
inline Lanes<T> filled(T v) {
  Lanes<T> result;
  for (T& lane : result.v) lane = v;
  return result;
}
inline F16 all(float v) { return filled(v); }
inline U16 all(std::uint32_t v) { return filled(v); }
template <class T>
inline void store(T* p, const Lanes<T>& v) {
  for (unsigned i = 0; i < 16; ++i) p[i] = v.v[i];
}
template <class T>
inline Lanes<T> choose(Mask mask, const Lanes<T>& a, const Lanes<T>& b) {
  Lanes<T> result;
  for (unsigned i = 0; i < 16; ++i) result.v[i] = (mask.lanes >> i & 1U) != 0 ? b.v[i] : a.v[i];
  return result;
}
inline float largest(const F16& v) {
  float result = v.v[0];
  for (const float x : v.v) result = x > result ? x : result;
  return result;
}
inline float smallest(const F16& v) {
  float result = v.v[0];
  for (const float x : v.v) result = x < result ? x : result;
  return result;
}

#include "adasplats/trace/wide_kernel.inc"

}  // namespace

WideVersion portable_wide() { return {"portable", cast_rays, all_hits}; }

}  // namespace adasplats::detail
