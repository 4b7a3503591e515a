// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats::gpu {

/// Private to gpu/: one value per point, in device memory, that breaks ties.
struct TieBreaker {
  enum class Kind : std::uint8_t { real, whole_32, whole_16, whole_8 };
  Kind kind = Kind::real;
  const void* values = nullptr;
  std::uint32_t stride = 1;  ///< between points, in values

  static TieBreaker of(const float* values) { return {Kind::real, values}; }
  static TieBreaker of(const std::uint32_t* values) { return {Kind::whole_32, values}; }
  static TieBreaker of(const std::uint16_t* values) { return {Kind::whole_16, values}; }
  static TieBreaker of(const std::uint8_t* values) { return {Kind::whole_8, values}; }
  static TieBreaker of(const Vec3f* values, int axis) {
    return {Kind::real, reinterpret_cast<const float*>(values) + axis, 3};
  }
};

/// Private to gpu/: hilbert_order() of neighbors/hilbert.h for points in device memory. `more`
/// breaks ties of equal coordinates, least significant first, then the index. Any number of points
/// may be equal. Waits for the stream.
DeviceBuffer<std::uint32_t> hilbert_order(const Vec3f* points, std::size_t count,
                                          cudaStream_t stream,
                                          std::span<const TieBreaker> more = {});
/// The same over a given box that contains all points.
DeviceBuffer<std::uint32_t> hilbert_order(const Vec3f* points, std::size_t count,
                                          const CurveBox& box, cudaStream_t stream,
                                          std::span<const TieBreaker> more = {});

}  // namespace adasplats::gpu
