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

/// Private to gpu/: two launches are in progress on every device; the hits of one are copied while
/// the other is traced.
class SceneScanner final : public GpuScanner {
 public:
  /// The scene must outlive it.
  SceneScanner(const gpu::SceneParts& scene, const LidarModel& sensor,
               std::span<const Firing> firings);
  ~SceneScanner() override;
  SceneScanner(const SceneScanner&) = delete;
  SceneScanner& operator=(const SceneScanner&) = delete;

  std::span<const Hit> scan(const ScanMotion& motion) override;
  CastTimes cast(std::span<const ScanMotion> scans, int depth, ScanCaster::Sink sink) override;
  CastTimes cast_points(std::span<const ScanMotion> scans, PointSink sink) override;
  DeviceHits cast_on_device(std::span<const ScanMotion> scans, int depth) override;

 private:
  enum class Results : std::uint8_t { hits, points };
  /// `sink` receives the results of one scan: `depth` Hits, or one PointHit, per firing.
  CastTimes cast(std::span<const ScanMotion> scans, Results results, int depth,
                 FunctionRef<void(std::size_t scan, const std::uint8_t* results)> sink);
  /// Ray source of a launch of this number of scans, without poses.
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
