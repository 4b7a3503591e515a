// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/embree_callbacks.h"

#include <algorithm>
#include <cmath>

namespace adasplats {

namespace {

// always_inline: each function with a target attribute needs its own copy of the code below, which
// would otherwise be compiled for the baseline.

struct DiskPrimitive {
  Disk disk;
  std::uint32_t index;

  [[gnu::always_inline]] static DiskPrimitive of(const RTCIntersectFunctionNArguments& arguments) {
    const auto& geometry = *static_cast<const DiskGeometry*>(arguments.geometryUserPtr);
    return {geometry.disks[arguments.primID], arguments.primID};
  }
  [[gnu::always_inline]] float intersect(const Ray& ray) const { return intersect_disk(ray, disk); }
};

struct TrianglePrimitive {
  Triangle triangle;
  std::uint32_t index;

  [[gnu::always_inline]] static TrianglePrimitive of(
      const RTCIntersectFunctionNArguments& arguments) {
    const auto& geometry = *static_cast<const TriangleGeometry*>(arguments.geometryUserPtr);
    return {geometry.mesh->triangle(arguments.primID), geometry.first_primitive + arguments.primID};
  }
  [[gnu::always_inline]] float intersect(const Ray& ray) const {
    return intersect_triangle(ray, triangle);
  }
};

[[gnu::always_inline]] inline Ray ray_of(RTCRayN* rays, unsigned lanes, unsigned i) {
  return {
      {RTCRayN_org_x(rays, lanes, i), RTCRayN_org_y(rays, lanes, i), RTCRayN_org_z(rays, lanes, i)},
      RTCRayN_tnear(rays, lanes, i),
      {RTCRayN_dir_x(rays, lanes, i), RTCRayN_dir_y(rays, lanes, i), RTCRayN_dir_z(rays, lanes, i)},
      RTCRayN_tfar(rays, lanes, i)};
}

/// Intersects one primitive with all rays of a packet. No branches, so that the compiler vectorises
/// it: invalid lanes are computed and dropped.
template <unsigned kLanes, class Primitive>
[[gnu::always_inline]] inline void intersect_packet(const RTCIntersectFunctionNArguments& arguments,
                                                    const Primitive& primitive) {
  RTCRayN* const rays = RTCRayHitN_RayN(arguments.rayhit, kLanes);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments.rayhit, kLanes);
  float t[kLanes];
  int valid[kLanes];  // a copy: for the compiler, Embree's array could overlap the packet
  for (unsigned i = 0; i < kLanes; ++i) t[i] = primitive.intersect(ray_of(rays, kLanes, i));
  for (unsigned i = 0; i < kLanes; ++i) valid[i] = arguments.valid[i];
  for (unsigned i = 0; i < kLanes; ++i) {
    float& nearest_t = RTCRayN_tfar(rays, kLanes, i);
    unsigned& nearest_primitive = RTCHitN_primID(hits, kLanes, i);
    const bool first_of_equals = (t[i] == nearest_t) & (primitive.index < nearest_primitive);
    const bool closer =
        (valid[i] != 0) & (t[i] < HUGE_VALF) & ((t[i] < nearest_t) | first_of_equals);
    nearest_t = closer ? t[i] : nearest_t;
    nearest_primitive = closer ? primitive.index : nearest_primitive;
  }
}

/// Intersects one primitive with a single ray, or a packet of an unusual size.
template <class Primitive>
[[gnu::always_inline]] inline void intersect_singly(const RTCIntersectFunctionNArguments& arguments,
                                                    const Primitive& primitive) {
  const unsigned lanes = arguments.N;
  RTCRayN* const rays = RTCRayHitN_RayN(arguments.rayhit, lanes);
  RTCHitN* const hits = RTCRayHitN_HitN(arguments.rayhit, lanes);
  HitList* const list = reinterpret_cast<Query*>(arguments.context)->nearest_hits;
  for (unsigned i = 0; i < lanes; ++i) {
    if (arguments.valid[i] == 0) continue;
    const Hit hit = {primitive.intersect(ray_of(rays, lanes, i)), primitive.index};
    float& nearest_t = RTCRayN_tfar(rays, lanes, i);
    unsigned& nearest_primitive = RTCHitN_primID(hits, lanes, i);
    if (!(hit.t < HUGE_VALF && hit < Hit{nearest_t, nearest_primitive})) continue;
    if (list == nullptr) {
      nearest_t = hit.t;
      nearest_primitive = hit.primitive;
    } else {
      list->insert(hit);
      // The ray is shortened only when the list is full.
      if (list->full()) {
        nearest_t = list->farthest().t;
        nearest_primitive = list->farthest().primitive;
      }
    }
  }
}

template <class Primitive>
[[gnu::always_inline]] inline void intersect(const RTCIntersectFunctionNArguments& arguments) {
  const Primitive primitive = Primitive::of(arguments);
  if (arguments.N == 16) {
    intersect_packet<16>(arguments, primitive);
  } else if (arguments.N == 8) {
    intersect_packet<8>(arguments, primitive);
  } else if (arguments.N == 4) {
    intersect_packet<4>(arguments, primitive);
  } else {
    intersect_singly(arguments, primitive);
  }
}

template <class Primitive>
void intersect_baseline(const RTCIntersectFunctionNArguments* arguments) {
  intersect<Primitive>(*arguments);
}

#if defined(__x86_64__)

template <class Primitive>
[[gnu::target("avx2")]] void intersect_avx2(const RTCIntersectFunctionNArguments* arguments) {
  intersect<Primitive>(*arguments);
}

template <class Primitive>
[[gnu::target("avx512f,avx512vl,avx512bw,avx512dq")]] void intersect_avx512(
    const RTCIntersectFunctionNArguments* arguments) {
  intersect<Primitive>(*arguments);
}

template <class Primitive>
RTCIntersectFunctionN widest_intersect() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq"))
    return intersect_avx512<Primitive>;
  if (__builtin_cpu_supports("avx2")) return intersect_avx2<Primitive>;
  return intersect_baseline<Primitive>;
}

#else

template <class Primitive>
RTCIntersectFunctionN widest_intersect() {
  return intersect_baseline<Primitive>;
}

#endif

void set_bounds(RTCBounds& bounds, Vec3f low, Vec3f high) {
  bounds.lower_x = low.x;
  bounds.lower_y = low.y;
  bounds.lower_z = low.z;
  bounds.upper_x = high.x;
  bounds.upper_y = high.y;
  bounds.upper_z = high.z;
}

void bound_disk(const RTCBoundsFunctionArguments* arguments) {
  const auto& geometry = *static_cast<const DiskGeometry*>(arguments->geometryUserPtr);
  const Disk& disk = geometry.disks[arguments->primID];
  const Vec3f half = disk_half_extent(disk);
  set_bounds(*arguments->bounds_o, disk.center - half, disk.center + half);
}

void bound_triangle(const RTCBoundsFunctionArguments* arguments) {
  const auto& geometry = *static_cast<const TriangleGeometry*>(arguments->geometryUserPtr);
  const Triangle triangle = geometry.mesh->triangle(arguments->primID);
  const Vec3f low = min(min(triangle.a, triangle.b), triangle.c);
  const Vec3f high = max(max(triangle.a, triangle.b), triangle.c);
  const Vec3f far = max(-low, high);
  const float margin = box_margin(std::max({far.x, far.y, far.z}));
  const Vec3f margins = {margin, margin, margin};
  set_bounds(*arguments->bounds_o, low - margins, high + margins);
}

}  // namespace

GeometryCallbacks disk_callbacks() { return {bound_disk, widest_intersect<DiskPrimitive>()}; }

GeometryCallbacks triangle_callbacks() {
  return {bound_triangle, widest_intersect<TrianglePrimitive>()};
}

}  // namespace adasplats
