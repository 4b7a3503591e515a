// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/gpu/simulate/gpu_scene.h"
#include "adasplats/gpu/trace/scene_parts.h"

namespace adasplats {

namespace gpu {
struct BatchPoses;
struct DeviceScanner;
struct HitLaunch;
}  // namespace gpu

/// Private to gpu/: how a GpuScanner works. Two launches are under way on every device: the hits of
/// one are copied while the other is traced.
struct GpuScanner::Impl {
 public:
  Impl(const gpu::SceneParts& scene, const LidarModel& sensor, std::span<const Firing> firings);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t firings() const { return firings_; }
  std::span<const Hit> scan(const ScanMotion& motion);
  DeviceHits cast_on_device(std::span<const ScanMotion> scans, int depth);
  enum class Results : std::uint8_t { hits, points };
  /// `sink` takes the results of one scan: Hits, `depth` of each firing, or one PointHit.
  CastTimes cast(std::span<const ScanMotion> scans, Results results, int depth,
                 FunctionRef<void(std::size_t scan, const std::uint8_t* results)> sink);

 private:
  /// What a launch of so many scans casts, without poses.
  gpu::RaySource source_of(const gpu::DeviceScanner& device, std::size_t scans) const;
  void reserve(gpu::HitLaunch& batch, std::size_t scans, int depth, Results results) const;
  void launch(gpu::DeviceScanner& device, gpu::HitLaunch& batch, std::span<const ScanMotion> scans,
              int depth, Results results) const;

  const gpu::SceneParts& scene_;
  std::size_t firings_;
  gpu::RaySource source_;  ///< without pointers
  std::vector<std::unique_ptr<gpu::DeviceScanner>> devices_;
  gpu::PinnedBuffer<Hit> single_;
  std::unique_ptr<gpu::BatchPoses> single_poses_;
  std::unique_ptr<gpu::BatchPoses> kept_poses_;
  gpu::DeviceBuffer<Hit> kept_hits_;
};

}  // namespace adasplats
