// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "adasplats/core/maths/ray.h"
#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/scene/intersect.h"

namespace adasplats::gpu {

/// A disk as the intersection program reads it: two loads of 16 bytes.
struct alignas(16) DiskRecord {
  Disk disk;
  float opacity = 1;  ///< at the centre
};
static_assert(sizeof(DiskRecord) == 32);

/// A triangle: three loads of 16 bytes.
struct alignas(16) TriangleRecord {
  Triangle triangle;
  float unused[3] = {};
};
static_assert(sizeof(TriangleRecord) == 48);

/// Private to gpu/: launch parameters of the OptiX programs, filled by the host. The programs
/// (optix_programs.cu) are compiled separately, for the driver.
struct OptixParams {
  RaySource source;
  std::uint64_t first_ray = 0;    ///< first ray of the source in this launch
  std::uint64_t first_place = 0;  ///< place_of_ray() of the first entry of `hits`
  Hit* hits = nullptr;            ///< `depth` per ray
  std::uint64_t scene = 0;        ///< optix::Traversable
  const DiskRecord* disks = nullptr;
  const TriangleRecord* triangles = nullptr;
  std::uint32_t disk_count = 0;
  std::uint32_t depth = 1;
};
static_assert(std::is_trivially_copyable_v<OptixParams>);

/// Query of a launch; the index into hit groups and pipelines.
enum class OptixQuery : std::uint32_t {
  nearest,  ///< the nearest hit, in two payload registers
  several,  ///< the nearest `depth` hits, in a list in memory
};
inline constexpr std::uint32_t kOptixQueries = 2;

}  // namespace adasplats::gpu
