// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/gpu/gpu_scene.h"
#include "adasplats/gpu/scene_parts.h"

namespace adasplats {

namespace gpu {
struct DeviceScanner;
struct ScanBatch;
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
  std::span<const Hit> scan(const TimedPose& pose);
  DeviceHits cast_on_device(std::span<const TimedPose> poses, int depth);
  /// `sink` takes the results of one scan: Hits, or PointHits where `points`.
  CastTimes cast(std::span<const TimedPose> poses, bool points,
                 FunctionRef<void(std::size_t pose, const std::uint8_t* results)> sink);

 private:
  /// What a launch of so many scans casts, without poses.
  gpu::RaySource source_of(const gpu::DeviceScanner& device, std::size_t scans) const;
  void reserve(gpu::ScanBatch& batch, std::size_t scans, std::size_t result_bytes,
               bool points) const;
  void launch(gpu::DeviceScanner& device, gpu::ScanBatch& batch, std::span<const TimedPose> poses,
              bool points) const;

  const gpu::SceneParts& scene_;
  std::size_t firings_;
  gpu::RaySource source_;  ///< without pointers
  std::vector<std::unique_ptr<gpu::DeviceScanner>> devices_;
  gpu::PinnedBuffer<Hit> single_;
  gpu::DeviceBuffer<ScanPose> kept_poses_;
  gpu::DeviceBuffer<Hit> kept_hits_;
};

}  // namespace adasplats
