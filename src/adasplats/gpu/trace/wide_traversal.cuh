// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_fp16.h>

#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/gpu/trace/scene_trees.h"
#include "adasplats/gpu/trace/wide_tree.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/trace/castable.h"

// Private to gpu/: traversal of a WideTree by one ray. Box tests use fused multiply-adds and
// reciprocals; their error is a few ulps of the distance, which the margin of the boxes
// (box_margin) covers. The functions of scene/intersect.h decide hits.

namespace adasplats::gpu {

/// Keeps the nearest hit.
class NearestHit {
 public:
  __device__ explicit NearestHit(int = 1) {}

  __device__ float reach(float t_max) const { return hit_.valid() ? hit_.t : t_max; }
  __device__ void offer(float t, std::uint32_t primitive) {
    if (Hit{t, primitive} < hit_) hit_ = {t, primitive};
  }
  __device__ void store(Hit* hits, int) const { hits[0] = hit_; }
  /// Calls use(hit) for all kept hits, nearest first.
  template <class Use>
  __device__ void for_each(Use&& use) const {
    if (hit_.valid()) use(hit_);
  }

 private:
  Hit hit_;
};

/// Keeps the nearest hits, ascending; at most kMost, in registers if that is small.
template <int kMost>
class NearestHits {
 public:
  __device__ explicit NearestHits(int depth) : depth_(depth) {}

  __device__ float reach(float t_max) const { return count_ == depth_ ? last_ : t_max; }
  __device__ void offer(float t, std::uint32_t primitive) {
    Hit hit = {t, primitive};
    if (count_ == depth_ && !(hit < hits_[depth_ - 1])) return;
    if (count_ < depth_) ++count_;
    int place = count_ - 1;
    for (; place > 0 && hit < hits_[place - 1]; --place) hits_[place] = hits_[place - 1];
    hits_[place] = hit;
    last_ = hits_[count_ - 1].t;
  }
  __device__ void store(Hit* hits, int depth) const {
    for (int k = 0; k < depth; ++k) hits[k] = k < count_ ? hits_[k] : Hit{};
  }
  template <class Use>
  __device__ void for_each(Use&& use) const {
    for (int k = 0; k < count_; ++k) use(hits_[k]);
  }

 private:
  Hit hits_[kMost];
  float last_ = 0;
  int depth_;
  int count_ = 0;
};

/// The same for a compile-time depth: the list stays in registers, sorted by exchanges.
template <int kDepth>
class FewNearestHits {
 public:
  __device__ explicit FewNearestHits(int) {}

  __device__ float reach(float t_max) const {
    return hits_[kDepth - 1].valid() ? hits_[kDepth - 1].t : t_max;
  }
  __device__ void offer(float t, std::uint32_t primitive) {
    Hit hit = {t, primitive};
#pragma unroll
    for (int k = 0; k < kDepth; ++k) {
      if (hit < hits_[k]) {
        const Hit farther = hits_[k];
        hits_[k] = hit;
        hit = farther;
      }
    }
  }
  __device__ void store(Hit* hits, int depth) const {
#pragma unroll
    for (int k = 0; k < kDepth; ++k)
      if (k < depth) hits[k] = hits_[k];
  }
  template <class Use>
  __device__ void for_each(Use&& use) const {
#pragma unroll
    for (int k = 0; k < kDepth; ++k)
      if (hits_[k].valid()) use(hits_[k]);
  }

 private:
  Hit hits_[kDepth];
};

__device__ inline float intersect(const Ray& ray, const LeafDisk* leaf, std::uint32_t& primitive) {
  const float4 a = __ldg(reinterpret_cast<const float4*>(leaf));
  const float4 b = __ldg(reinterpret_cast<const float4*>(leaf) + 1);
  primitive = __float_as_uint(b.w);
  return intersect_disk(ray, {{a.x, a.y, a.z}, a.w, {b.x, b.y, b.z}});
}

__device__ inline float intersect(const Ray& ray, const LeafTriangle* leaf,
                                  std::uint32_t& primitive) {
  const float4 a = __ldg(reinterpret_cast<const float4*>(leaf));
  const float4 b = __ldg(reinterpret_cast<const float4*>(leaf) + 1);
  const float4 c = __ldg(reinterpret_cast<const float4*>(leaf) + 2);
  primitive = __float_as_uint(c.y);
  return intersect_triangle(ray, {{a.x, a.y, a.z}, {a.w, b.x, b.y}, {b.z, b.w, c.x}});
}

/// Ray data for box tests.
struct BoxRay {
  Vec3f origin;
  Vec3f inverse;         ///< of the direction; finite
  std::uint32_t octant;  ///< slot that comes first: 7 for a ray along +x +y +z
};

__device__ inline BoxRay box_ray(const Ray& ray) {
  constexpr float kLeast = 1e-12F;  // practically zero: an error of 1e-9 m after a kilometre
  const auto inverse = [](float d) {
    return 1.0F / (fabsf(d) > kLeast ? d : copysignf(kLeast, d));
  };
  const Vec3f& d = ray.direction;
  const Vec3f inverses = {inverse(d.x), inverse(d.y), inverse(d.z)};
  return {ray.origin, inverses,
          (inverses.x < 0 ? 0U : 4U) | (inverses.y < 0 ? 0U : 2U) | (inverses.z < 0 ? 0U : 1U)};
}

/// Children of one node that are still to be visited: nodes or primitives.
struct Group {
  std::uint32_t first = 0;  ///< index of the first of all nodes (primitives) of that node
  /// Bits 0 to 7: these children, in the order in which the ray meets them, the nearest in bit 7.
  /// Bits 8 to 15: all slots of the node with nodes (primitives). Bit 16: these are primitives.
  std::uint32_t bits = 0;

  __device__ bool empty() const { return (bits & 0xffU) == 0; }
  __device__ bool are_primitives() const { return (bits & 0x10000U) != 0; }
  /// Removes the nearest and returns its index.
  __device__ std::uint32_t pop(std::uint32_t octant) {
    const std::uint32_t nearest =
        31U - static_cast<std::uint32_t>(__clz(static_cast<int>(bits & 0xffU)));
    bits ^= 1U << nearest;
    const std::uint32_t slot = nearest ^ octant;
    return first + static_cast<std::uint32_t>(__popc(bits >> 8 & 0xffU & ~(0xffffffffU << slot)));
  }
};

/// Bit s of each byte of the result is bit s ^ octant of that byte.
__device__ inline std::uint32_t by_octant(std::uint32_t bits, std::uint32_t octant) {
  if ((octant & 1U) != 0) bits = (bits >> 1 & 0x55555555U) | (bits << 1 & 0xaaaaaaaaU);
  if ((octant & 2U) != 0) bits = (bits >> 2 & 0x33333333U) | (bits << 2 & 0xccccccccU);
  if ((octant & 4U) != 0) bits = (bits >> 4 & 0x0f0f0f0fU) | (bits << 4 & 0xf0f0f0f0U);
  return bits;
}

/// Distances along a ray to planes of a node's grid. One instruction turns two bytes b into half
/// floats 1024 + b, which become floats in the sums, because the byte permutation unit is the
/// bottleneck. The margin is four times the possible rounding error of 2^-14 of a cell.
struct GridAxis {
  float scale, near_offset, far_offset;

  __device__ GridAxis(float cell, float plane, float origin, float inverse) {
    scale = cell * inverse;
    const float offset = fmaf(plane - origin, inverse, -1024.0F * scale);
    near_offset = fmaf(fabsf(scale), -0x1.0p-12F, offset);
    far_offset = fmaf(fabsf(scale), 0x1.0p-12F, offset);
  }
  /// As the bits of a float; those of non-negative floats have the order of integers.
  template <int kByte>
  __device__ static int at(std::uint32_t bytes, float scale, float offset) {
    constexpr std::uint32_t kHalves = 0x64646464U;  // the upper byte of the half 1024
    const std::uint32_t two = __byte_perm(bytes, kHalves, kByte < 2 ? 0x4140U : 0x4342U);
    const auto bits = static_cast<unsigned short>(kByte % 2 == 0 ? two & 0xffffU : two >> 16);
    return __float_as_int(fmaf(__half2float(__ushort_as_half(bits)), scale, offset));
  }
  template <int kByte>
  __device__ int near(std::uint32_t bytes) const {
    return at<kByte>(bytes, scale, near_offset);
  }
  template <int kByte>
  __device__ int far(std::uint32_t bytes) const {
    return at<kByte>(bytes, scale, far_offset);
  }
};

/// The maximum and minimum of three numbers, in one instruction if the GPU has it.
__device__ inline int max3(int a, int b, int c) { return __vimax3_s32(a, b, c); }
__device__ inline int min3(int a, int b, int c) { return __vimin3_s32(a, b, c); }

/// Tests four boxes of a node.
struct FourBoxes {
  std::uint32_t near_x, near_y, near_z, far_x, far_y, far_z;

  /// Whether the ray meets box kBox between t_min and t_max (bits of non-negative floats).
  /// Distances behind the origin are negative integers, too: they lose every maximum and fail as a
  /// minimum, regardless of their value.
  template <int kBox>
  __device__ bool met(const GridAxis& x, const GridAxis& y, const GridAxis& z, int t_min,
                      int t_max) const {
    const int enter =
        max3(x.near<kBox>(near_x), y.near<kBox>(near_y), ::max(z.near<kBox>(near_z), t_min));
    const int leave =
        min3(x.far<kBox>(far_x), y.far<kBox>(far_y), ::min(z.far<kBox>(far_z), t_max));
    return enter <= leave;
  }
};

/// Tests the eight boxes of a node and returns the nodes and primitives to visit.
__device__ inline void visit(const WideNode* node, const BoxRay& ray, float t_min, float t_max,
                             Group& nodes, Group& primitives) {
  const uint4* words = reinterpret_cast<const uint4*>(node);
  const uint4 n0 = __ldg(words), n1 = __ldg(words + 1);
  const uint4 n2 = __ldg(words + 2), n3 = __ldg(words + 3), n4 = __ldg(words + 4);
  const auto sorted_bounds = [](bool backward, uint4 v) {
    return backward ? uint4{v.z, v.w, v.x, v.y} : v;
  };
  const uint4 bounds_x = sorted_bounds(ray.inverse.x < 0, n2);
  const uint4 bounds_y = sorted_bounds(ray.inverse.y < 0, n3);
  const uint4 bounds_z = sorted_bounds(ray.inverse.z < 0, n4);
  const GridAxis x(__uint_as_float(n1.y << 16), __uint_as_float(n0.x), ray.origin.x, ray.inverse.x);
  const GridAxis y(__uint_as_float(n1.y & 0xffff0000U), __uint_as_float(n0.y), ray.origin.y,
                   ray.inverse.y);
  const GridAxis z(__uint_as_float(n1.z << 16), __uint_as_float(n0.z), ray.origin.z, ray.inverse.z);
  const int first = __float_as_int(t_min), last = __float_as_int(t_max);
  const FourBoxes low = {bounds_x.x, bounds_y.x, bounds_z.x, bounds_x.z, bounds_y.z, bounds_z.z};
  const FourBoxes high = {bounds_x.y, bounds_y.y, bounds_z.y, bounds_x.w, bounds_y.w, bounds_z.w};
  std::uint32_t found = 0;
  if (low.met<0>(x, y, z, first, last)) found |= 1U;
  if (low.met<1>(x, y, z, first, last)) found |= 2U;
  if (low.met<2>(x, y, z, first, last)) found |= 4U;
  if (low.met<3>(x, y, z, first, last)) found |= 8U;
  if (high.met<0>(x, y, z, first, last)) found |= 16U;
  if (high.met<1>(x, y, z, first, last)) found |= 32U;
  if (high.met<2>(x, y, z, first, last)) found |= 64U;
  if (high.met<3>(x, y, z, first, last)) found |= 128U;
  // The third byte of this word flags slots with nodes, the fourth those with primitives.
  const std::uint32_t kinds = n1.z >> 16;
  const std::uint32_t sorted = by_octant(found * 0x101U & kinds, ray.octant);
  nodes = {n0.w, (sorted & 0xffU) | (kinds & 0xffU) << 8};
  primitives = {n1.x, sorted >> 8 | (kinds & 0xff00U) | 0x10000U};
}

/// Passes every hit of a ray with the primitives of the tree to `best`, except hits that it cannot
/// keep. `kPostpone`: primitives wait while less than this percentage of the warp's rays have some
/// to test.
template <int kPostpone, class Leaf, class Best>
__device__ void walk(const TreeView<Leaf>& tree, Ray ray, const BoxRay& boxes, Best& best) {
  if (tree.nodes == nullptr) return;
  const float farthest = ray.t_max;
  ray.t_max = best.reach(farthest);
  Group stack[kStackEntries];
  int depth = 0;
  Group nodes = {0, 1U << boxes.octant | 1U << 8};  // the root alone, in slot 0
  while (true) {
    Group primitives;
    if (!nodes.are_primitives()) {
      const std::uint32_t node = nodes.pop(boxes.octant);
      if (!nodes.empty()) stack[depth++] = nodes;
      visit(tree.nodes + node, boxes, ray.t_min, ray.t_max, nodes, primitives);
    } else {
      primitives = nodes;
      nodes = {};
    }
    const int walking = kPostpone > 0 ? __popc(__activemask()) : 0;
    while (!primitives.empty()) {
      if (kPostpone > 0 && (!nodes.empty() || depth > 0) &&
          __popc(__activemask()) * 100 < walking * kPostpone) {
        if (!nodes.empty()) stack[depth++] = nodes;
        stack[depth++] = primitives;
        nodes = {};
        break;
      }
      const std::uint32_t place = primitives.pop(boxes.octant);
      std::uint32_t primitive = 0;
      const float t = intersect(ray, tree.leaves + place, primitive);
      if (t < HUGE_VALF) {
        if constexpr (requires { best.offer(t, primitive, tree.leaves, place); })
          best.offer(t, primitive, tree.leaves, place);
        else
          best.offer(t, primitive);
        ray.t_max = best.reach(farthest);
      }
    }
    if (nodes.empty()) {
      if (depth == 0) return;
      nodes = stack[--depth];
    }
  }
}

/// Passes every hit of a ray in a scene to `best`.
template <int kPostpone, class Best>
__device__ void cast_one(const TreesView& trees, Ray ray, Best& best) {
  if (!castable(ray)) return;
  ray.t_min = first_t(ray);
  const BoxRay boxes = box_ray(ray);
  walk<kPostpone>(trees.disks, ray, boxes, best);
  walk<kPostpone>(trees.triangles, ray, boxes, best);
}

}  // namespace adasplats::gpu
