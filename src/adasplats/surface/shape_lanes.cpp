// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/shape_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace adasplats {
namespace detail {
namespace {

constexpr std::size_t kLanes = 4;

// Vectors of the compiler: two SSE registers for each, or one of AVX.
using DoubleLanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using FloatLanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using MaskLanes = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

struct Mask4 {
  MaskLanes lanes;
};

/// The numbers of jacobi() in lanes.
struct Double4 {
  DoubleLanes lanes;

  Double4() = default;
  [[gnu::always_inline]] explicit Double4(double x) : lanes{x, x, x, x} {}
  [[gnu::always_inline]] explicit Double4(const DoubleLanes& x) : lanes(x) {}
};

#define ADASPLATS_LANES [[gnu::always_inline]] inline
ADASPLATS_LANES Double4 operator+(const Double4& x, const Double4& y) {
  return Double4(x.lanes + y.lanes);
}
ADASPLATS_LANES Double4 operator-(const Double4& x, const Double4& y) {
  return Double4(x.lanes - y.lanes);
}
ADASPLATS_LANES Double4 operator*(const Double4& x, const Double4& y) {
  return Double4(x.lanes * y.lanes);
}
ADASPLATS_LANES Double4 operator/(const Double4& x, const Double4& y) {
  return Double4(x.lanes / y.lanes);
}
ADASPLATS_LANES Mask4 operator!=(const Double4& x, const Double4& y) {
  return {x.lanes != y.lanes};
}
ADASPLATS_LANES Mask4 operator<(const Double4& x, const Double4& y) { return {x.lanes < y.lanes}; }
ADASPLATS_LANES Mask4 operator>(const Double4& x, const Double4& y) { return {x.lanes > y.lanes}; }
ADASPLATS_LANES Mask4 operator>=(const Double4& x, const Double4& y) {
  return {x.lanes >= y.lanes};
}
ADASPLATS_LANES Mask4 operator&(const Mask4& x, const Mask4& y) { return {x.lanes & y.lanes}; }
ADASPLATS_LANES bool any_lane(const Mask4& mask) {
  return (mask.lanes[0] | mask.lanes[1] | mask.lanes[2] | mask.lanes[3]) != 0;
}
ADASPLATS_LANES Double4 chosen(const Mask4& mask, const Double4& yes, const Double4& no) {
  return Double4(mask.lanes ? yes.lanes : no.lanes);
}
ADASPLATS_LANES Double4 root_of(const Double4& x) {
  return Double4(DoubleLanes{std::sqrt(x.lanes[0]), std::sqrt(x.lanes[1]), std::sqrt(x.lanes[2]),
                             std::sqrt(x.lanes[3])});
}
ADASPLATS_LANES Double4 magnitude_of(const Double4& x) {
  return Double4(DoubleLanes{std::fabs(x.lanes[0]), std::fabs(x.lanes[1]), std::fabs(x.lanes[2]),
                             std::fabs(x.lanes[3])});
}

/// Sums that no order changes, lane by lane, and then over the lanes.
struct ExactSum4 {
  DoubleLanes sum{};

  ADASPLATS_LANES void add(const DoubleLanes& value, double shift) {
    sum += (value + shift) - shift;
  }
  ADASPLATS_LANES double total() const { return (sum[0] + sum[1]) + (sum[2] + sum[3]); }
};

/// Offsets of neighbours in groups of four: x, y, z. The last group is filled up with zeros, which
/// change no sum. Returns their extent().
ADASPLATS_LANES float copy_offsets(std::span<const Vec3f> points, std::uint32_t rank,
                                   const NeighborList& list, float* offsets) {
  const Vec3f center = points[rank];
  float largest = 0;
  for (std::uint32_t k = 0; k < list.size; ++k) {
    const Vec3f offset = points[list.ranks[k]] - center;
    float* const group = offsets + k / kLanes * 3 * kLanes + k % kLanes;
    group[0] = offset.x;
    group[kLanes] = offset.y;
    group[2 * kLanes] = offset.z;
    const float size = extent(offset);
    largest = largest > size ? largest : size;
  }
  return largest;
}

ADASPLATS_LANES Moments moments_of(const float* offsets, std::uint32_t count, float extent_m) {
  const ExactMoments exact(count, extent_m);
  const double of_offsets = exact.offsets.shift(), of_squares = exact.squares.shift();
  ExactSum4 x, y, z, xx, xy, xz, yy, yz, zz;
  for (std::uint32_t k = 0; k < count; k += kLanes) {
    FloatLanes group[3];
    std::memcpy(group, offsets + std::size_t{3} * k, sizeof(group));
    const auto dx = __builtin_convertvector(group[0], DoubleLanes);
    const auto dy = __builtin_convertvector(group[1], DoubleLanes);
    const auto dz = __builtin_convertvector(group[2], DoubleLanes);
    x.add(dx, of_offsets);
    y.add(dy, of_offsets);
    z.add(dz, of_offsets);
    xx.add(dx * dx, of_squares);
    xy.add(dx * dy, of_squares);
    xz.add(dx * dz, of_squares);
    yy.add(dy * dy, of_squares);
    yz.add(dy * dz, of_squares);
    zz.add(dz * dz, of_squares);
  }
  return {static_cast<double>(count),
          {x.total(), y.total(), z.total()},
          {xx.total(), xy.total(), xz.total(), yy.total(), yz.total(), zz.total()}};
}

/// local_shape() of up to four covariances.
ADASPLATS_LANES void find_shapes(const SymmetricMat3d* covariances, std::size_t count,
                                 LocalShape* shapes) {
  JacobiState<Double4> state;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const SymmetricMat3d& m = covariances[std::min(lane, count - 1)];
    state.a[0][0].lanes[lane] = m.xx;
    state.a[0][1].lanes[lane] = state.a[1][0].lanes[lane] = m.xy;
    state.a[0][2].lanes[lane] = state.a[2][0].lanes[lane] = m.xz;
    state.a[1][1].lanes[lane] = m.yy;
    state.a[1][2].lanes[lane] = state.a[2][1].lanes[lane] = m.yz;
    state.a[2][2].lanes[lane] = m.zz;
  }
  jacobi(state);
  for (std::size_t lane = 0; lane < count; ++lane) {
    SymmetricEigen eigen;
    for (int k = 0; k < 3; ++k) {
      eigen.values[k] = state.a[k][k].lanes[lane];
      eigen.vectors[k] = {state.v[0][k].lanes[lane], state.v[1][k].lanes[lane],
                          state.v[2][k].lanes[lane]};
    }
    shapes[lane] = shape_from(eigen);
  }
}

ADASPLATS_LANES void find_all(std::span<const Vec3f> points, std::uint32_t first_rank,
                              std::span<const NeighborList> lists, float* offsets,
                              std::span<LocalShape> shapes) {
  for (std::size_t first = 0; first < lists.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, lists.size() - first);
    std::array<SymmetricMat3d, kLanes> covariances;
    for (std::size_t i = 0; i < count; ++i) {
      const NeighborList& list = lists[first + i];
      if (list.size > 0)
        std::fill_n(offsets + (list.size - 1) / kLanes * 3 * kLanes, 3 * kLanes, 0.0F);
      const float extent_m =
          copy_offsets(points, static_cast<std::uint32_t>(first_rank + first + i), list, offsets);
      covariances[i] = covariance(moments_of(offsets, list.size, extent_m));
    }
    find_shapes(covariances.data(), count, shapes.data() + first);
  }
}

using FindAll = void (*)(std::span<const Vec3f>, std::uint32_t, std::span<const NeighborList>,
                         float*, std::span<LocalShape>);

void find_portably(std::span<const Vec3f> points, std::uint32_t first_rank,
                   std::span<const NeighborList> lists, float* offsets,
                   std::span<LocalShape> shapes) {
  find_all(points, first_rank, lists, offsets, shapes);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void find_with_avx2(std::span<const Vec3f> points, std::uint32_t first_rank,
                                            std::span<const NeighborList> lists, float* offsets,
                                            std::span<LocalShape> shapes) {
  find_all(points, first_rank, lists, offsets, shapes);
}
#endif

FindAll best_find() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return find_with_avx2;
#endif
  return find_portably;
}

}  // namespace
}  // namespace detail

void ShapeLanes::find(std::span<const Vec3f> points, std::uint32_t first_rank,
                      std::span<const NeighborList> lists, std::span<LocalShape> shapes) {
  static const detail::FindAll find_all = detail::best_find();
  std::size_t most = 0;
  for (const NeighborList& list : lists) most = std::max<std::size_t>(most, list.size);
  offsets_.resize(std::max(offsets_.size(), 3 * (most + detail::kLanes)));
  find_all(points, first_rank, lists, offsets_.data(), shapes);
}

}  // namespace adasplats
