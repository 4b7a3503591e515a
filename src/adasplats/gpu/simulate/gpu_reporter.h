// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/gpu/trace/scene_parts.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/world/scene_caster.h"

namespace adasplats {

namespace gpu {
struct DeviceReporter;
struct ReportLane;
class PinnedPool;
}  // namespace gpu

/// Private to gpu/: simulates scans, from rays to points, on the GPUs of a scene. Several launches
/// are in progress on every device: the returns of one are copied while the next one is traced.
class GpuReporter {
 public:
  /// The scene must outlive it.
  GpuReporter(const gpu::SceneParts& scene, const ScanRules& rules);
  ~GpuReporter();
  GpuReporter(const GpuReporter&) = delete;
  GpuReporter& operator=(const GpuReporter&) = delete;

  using BatchSink = SceneCaster::BatchSink;

  /// As ScanCaster::report(), in batches; `sink` receives them in order. Batches in host memory are
  /// page-locked. Batches on a device (only the first one) are complete.
  /// `world`: objects in addition to the scene, or null; must be that of the rules' attributes.
  ReportTimes report(std::span<const ScanMotion> scans, std::uint64_t first_number,
                     const World* world, const Executor& executor, BatchMemory memory,
                     BatchSink sink);

 private:
  struct Run;

  std::size_t scans_at_once(std::size_t scans, std::size_t lanes) const;
  void reserve(gpu::ReportLane& lane, std::size_t scans, BatchMemory memory) const;
  void reserve_all(Run& run);
  void prepare_world(Run& run);
  void begin(Run& run, std::size_t k);
  void end(Run& run, std::size_t k, BatchSink sink);

  const gpu::SceneParts& scene_;
  std::size_t firings_;
  std::size_t hits_a_firing_;
  std::size_t returns_a_firing_;
  int depth_;
  double scan_duration_s_;
  ScanFields fields_;
  bool deskews_;
  std::vector<std::unique_ptr<gpu::DeviceReporter>> devices_;
  std::shared_ptr<gpu::PinnedPool> pinned_;
};

}  // namespace adasplats
