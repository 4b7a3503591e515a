// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// Three components of one type: a point, a vector or a colour. Plain data, no padding.
template <class T>
struct Vec3 {
  T x{};
  T y{};
  T z{};

  ADASPLATS_HD constexpr T operator[](int axis) const {
    return axis == 0 ? x : (axis == 1 ? y : z);
  }
  ADASPLATS_HD constexpr T& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  ADASPLATS_HD friend constexpr bool operator==(Vec3 a, Vec3 b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
static_assert(sizeof(Vec3f) == 12 && sizeof(Vec3d) == 24);

template <class T>
ADASPLATS_HD constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> operator-(Vec3<T> a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> operator*(T s, Vec3<T> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> operator*(Vec3<T> a, T s) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> operator/(Vec3<T> a, T s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class T>
ADASPLATS_HD constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
ADASPLATS_HD inline T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
template <class T>
ADASPLATS_HD inline Vec3<T> normalized(Vec3<T> a) {
  return a / length(a);
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T>
ADASPLATS_HD constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
template <class T>
ADASPLATS_HD inline bool is_finite(Vec3<T> a) {
  // x - x is 0 for finite x and NaN for NaN and infinities.
  return (a.x - a.x) == T(0) && (a.y - a.y) == T(0) && (a.z - a.z) == T(0);
}
template <class To, class From>
ADASPLATS_HD constexpr Vec3<To> vec_cast(Vec3<From> a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

}  // namespace adasplats
