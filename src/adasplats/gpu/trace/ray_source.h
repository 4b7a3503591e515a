// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/ray.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/scan/scan_ray.h"

namespace adasplats::gpu {

/// Private to gpu/: source of the rays of a launch, passed to kernels by value. Pointers are device
/// memory. Rays are made by the kernel that casts them: only poses are copied.
struct RaySource {
  enum class Kind : std::uint32_t {
    given,  ///< rays[i]
    scans,  ///< ray i is firing i % firing_count of scan i / firing_count
    image,  ///< ray i is sample i of a picture without a lens, tile by tile (see sample_of)
  };
  Kind kind = Kind::given;

  const Ray* rays = nullptr;

  const FiringRay* firings = nullptr;    ///< in casting order
  const std::uint32_t* order = nullptr;  ///< firing numbers in casting order; null: ascending
  const ScanPose* poses = nullptr;       ///< of all scans; null: `pose` for all
  /// Begin of the poses (motion knots) of each scan; number of scans + 1. Null: one pose per scan.
  const std::uint32_t* first_poses = nullptr;
  ScanPose pose;
  std::uint32_t firing_count = 1;
  float t_min = 0, t_max = 0;

  CameraRays camera;
  std::int32_t columns = 1, rows = 1;  ///< samples of the picture, both multiples of the tile
  std::int32_t samples_per_axis = 1;
};

/// i / n and i % n.
struct Quotient {
  std::uint64_t whole;
  std::uint32_t rest;
};

ADASPLATS_HD inline Quotient divide(std::uint64_t i, std::uint32_t n) {
  // A 64-bit division takes about a hundred instructions on a GPU; few launches need it.
  const auto low = static_cast<std::uint32_t>(i);
  if (low == i) return {low / n, low % n};
  return {i / n, static_cast<std::uint32_t>(i % n)};
}

/// Samples of a picture in the order of rays: tiles of 8 x 4, one per warp.
struct SamplePlace {
  static constexpr std::int32_t kTileColumns = 8, kTileRows = 4;
  std::int32_t x, y;
};

ADASPLATS_HD inline SamplePlace sample_of(std::uint64_t ray, std::int32_t columns) {
  constexpr std::uint32_t kTile = SamplePlace::kTileColumns * SamplePlace::kTileRows;
  const Quotient tile =
      divide(ray / kTile, static_cast<std::uint32_t>(columns / SamplePlace::kTileColumns));
  const auto within = static_cast<std::int32_t>(ray % kTile);
  return {static_cast<std::int32_t>(tile.rest) * SamplePlace::kTileColumns +
              within % SamplePlace::kTileColumns,
          static_cast<std::int32_t>(tile.whole) * SamplePlace::kTileRows +
              within / SamplePlace::kTileColumns};
}

/// The inverse of sample_of(): the index of the ray of sample (x, y).
ADASPLATS_HD inline std::uint64_t ray_of_sample(SamplePlace at, std::int32_t columns) {
  const auto tiles_a_row = static_cast<std::uint64_t>(columns / SamplePlace::kTileColumns);
  const std::uint64_t tile =
      static_cast<std::uint64_t>(at.y / SamplePlace::kTileRows) * tiles_a_row +
      static_cast<std::uint64_t>(at.x / SamplePlace::kTileColumns);
  return tile * (SamplePlace::kTileColumns * SamplePlace::kTileRows) +
         static_cast<std::uint64_t>(at.y % SamplePlace::kTileRows * SamplePlace::kTileColumns +
                                    at.x % SamplePlace::kTileColumns);
}

/// Position of the hits of ray i, in rays: the casting order may differ from the order of hits.
ADASPLATS_HD inline std::uint64_t place_of_ray(const RaySource& source, std::uint64_t i) {
  if (source.order == nullptr) return i;
  const std::uint32_t within = divide(i, source.firing_count).rest;
  return i - within + source.order[within];
}

/// Sensors at rest have their own kernel, which needs fewer registers.
enum class Sensors : std::uint8_t { still, may_move };

template <Sensors kSensors = Sensors::may_move>
ADASPLATS_HD inline Ray ray_of(const RaySource& source, std::uint64_t i) {
  switch (source.kind) {
    case RaySource::Kind::given: return source.rays[i];
    case RaySource::Kind::scans: {
      const Quotient at = divide(i, source.firing_count);  // the scan, the firing
      const FiringRay firing = source.firings[at.rest];
      if (kSensors == Sensors::may_move && source.first_poses != nullptr) {
        const std::uint32_t first = source.first_poses[at.whole];
        return scan_ray(source.poses + first, source.first_poses[at.whole + 1] - first, firing,
                        source.t_min, source.t_max);
      }
      return still_scan_ray(source.poses == nullptr ? source.pose : source.poses[at.whole], firing,
                            source.t_min, source.t_max);
    }
    case RaySource::Kind::image: {
      const SamplePlace at = sample_of(i, source.columns);
      return source.camera.plain_ray((at.x + 0.5) / source.samples_per_axis,
                                     (at.y + 0.5) / source.samples_per_axis);
    }
  }
  return {};
}

}  // namespace adasplats::gpu
