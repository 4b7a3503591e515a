// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/scene/scene.h"
#include "adasplats/trace/embree.h"
#include "adasplats/trace/hit_list.h"

namespace adasplats {

/// Private to trace/: the user geometry that Embree sees.

/// User data of the callbacks of one geometry.
struct DiskGeometry {
  std::span<const Disk> disks;
};
struct TriangleGeometry {
  const TriangleMesh* mesh = nullptr;
  std::uint32_t first_primitive = 0;  ///< primitive index of triangle 0
};

/// One query. Embree passes its context to the callbacks.
struct Query {
  embree::QueryContext context;     ///< first member: the callbacks cast back
  HitList* nearest_hits = nullptr;  ///< for single rays: collects all hits; nullptr: nearest only
};

/// Bounds and intersection of one kind of primitive. `intersect` is compiled for the machine's
/// widest vectors; every version gives the same bits.
struct GeometryCallbacks {
  RTCBoundsFunction bounds;
  RTCIntersectFunctionN intersect;
};
GeometryCallbacks disk_callbacks();
GeometryCallbacks triangle_callbacks();

}  // namespace adasplats
