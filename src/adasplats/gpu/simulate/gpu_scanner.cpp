// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/gpu_scanner.h"

#include <algorithm>
#include <chrono>

#include "adasplats/core/error.h"
#include "adasplats/gpu/simulate/point_hits.h"
#include "adasplats/gpu/simulate/scan_batches.h"

namespace adasplats {

namespace gpu {
namespace {

constexpr int kSlots = 2;  // launches in progress on each device

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

/// One launch in progress.
struct HitLaunch {
  Stream stream;
  Event begin, end;
  BatchPoses poses;
  PinnedBuffer<std::uint8_t> results;
  DeviceBuffer<Hit> device_hits;
  DeviceBuffer<PointHit> device_points;
  std::size_t first = 0, count = 0;  ///< poses; none: idle
};

/// A sensor on one device.
struct DeviceScanner {
  explicit DeviceScanner(const DevicePart& scene_part) : part(&scene_part) {}
  ~DeviceScanner() {
    const DeviceGuard guard(part->device);
    for (auto& batch : batches) {
      // After an exception, a launch in progress may still write to the memory freed here.
      if (batch != nullptr) cudaStreamSynchronize(batch->stream.get());
      batch.reset();
    }
    firings = {};
    coherent = {};
    spread = {};
  }
  DeviceScanner(const DeviceScanner&) = delete;
  DeviceScanner& operator=(const DeviceScanner&) = delete;

  const DevicePart* part;
  Stream stream;  ///< of the firings, of single scans and of scans that stay on the device
  DeviceBuffer<FiringRay> firings;  ///< in the order of their numbers
  OrderedFirings coherent;          ///< for launches that fill the GPU
  OrderedFirings spread;            ///< for smaller ones
  std::array<std::unique_ptr<HitLaunch>, kSlots> batches;
};

}  // namespace gpu

using gpu::BatchPoses;
using gpu::cuda_check;
using gpu::DeviceGuard;
using gpu::DevicePart;
using gpu::DeviceScanner;
using gpu::HitLaunch;
using gpu::RaySource;
using gpu::SceneParts;

SceneScanner::SceneScanner(const SceneParts& scene, const LidarModel& sensor,
                           std::span<const Firing> firings)
    : scene_(scene), firings_(firings.size()) {
  if (firings.empty()) throw Error(ErrorKind::usage, "the sensor has no firings");
  source_.kind = RaySource::Kind::scans;
  source_.firing_count = static_cast<std::uint32_t>(firings.size());
  source_.t_min = static_cast<float>(sensor.min_range_m);
  source_.t_max = static_cast<float>(sensor.max_range_m);
  const std::vector<FiringRay> rays = firing_rays(sensor, firings);
  const gpu::CastingOrder coherent = gpu::coherent_order(firings);
  const gpu::CastingOrder spread = gpu::spread_order(firings);
  for (const DevicePart& part : scene.parts) {
    const DeviceGuard guard(part.device);
    auto device = std::make_unique<DeviceScanner>(part);
    const cudaStream_t stream = device->stream.get();
    device->firings = gpu::DeviceBuffer<FiringRay>(std::span<const FiringRay>(rays), stream);
    device->coherent = gpu::OrderedFirings(rays, coherent, stream);
    device->spread = gpu::OrderedFirings(rays, spread, stream);
    device->stream.wait("copy a sensor to the GPU");
    devices_.push_back(std::move(device));
  }
}

SceneScanner::~SceneScanner() {
  const DeviceGuard guard(scene_.first().device);
  kept_poses_.reset();
  single_poses_.reset();
  kept_hits_ = {};
}

RaySource SceneScanner::source_of(const DeviceScanner& device, std::size_t scans) const {
  RaySource source = source_;
  const bool small = scans * firings_ < gpu::kSmallLaunch;
  const gpu::OrderedFirings& firings = small ? device.spread : device.coherent;
  source.firings = firings.rays.data();
  source.order = firings.order.data();
  return source;
}

std::span<const Hit> SceneScanner::scan(const ScanMotion& motion) {
  DeviceScanner& device = *devices_.front();
  const DeviceGuard guard(device.part->device);
  const cudaStream_t stream = device.stream.get();
  if (single_.size() == 0) single_ = gpu::PinnedBuffer<Hit>(firings_);
  RaySource source = source_of(device, 1);
  if (motion.knots.empty()) {
    source.pose = scan_pose(motion.reference.world_from_sensor, scene_.origin);
  } else {
    if (single_poses_ == nullptr) single_poses_ = std::make_unique<BatchPoses>();
    single_poses_->upload({&motion, 1}, scene_.origin, stream);
    single_poses_->set(source);
  }
  // The kernel writes across the bus, so results are copied while other rays are traced.
  device.part->scene->cast(source, firings_, 1, single_.data(), stream);
  device.stream.wait("cast a scan on the GPU");
  return single_.span();
}

DeviceHits SceneScanner::cast_on_device(std::span<const ScanMotion> scans, int depth) {
  DeviceScanner& device = *devices_.front();
  const DeviceGuard guard(device.part->device);
  const cudaStream_t stream = device.stream.get();
  const std::size_t hits = scans.size() * firings_ * static_cast<std::size_t>(depth);
  if (kept_hits_.size() < hits) {
    kept_hits_ = {};  // before the larger one
    kept_hits_ = gpu::DeviceBuffer<Hit>(hits, stream);
  }
  if (kept_poses_ == nullptr) kept_poses_ = std::make_unique<BatchPoses>();
  kept_poses_->upload(scans, scene_.origin, stream);
  RaySource source = source_of(device, scans.size());
  kept_poses_->set(source);
  device.part->scene->cast(source, scans.size() * firings_, depth, kept_hits_.data(), stream);
  return {kept_hits_.data(), scans.size(), firings_, device.part->device, stream};
}

void SceneScanner::reserve(HitLaunch& batch, std::size_t scans, int depth, Results results) const {
  const std::size_t firings = scans * firings_;
  const std::size_t hits = firings * static_cast<std::size_t>(depth);
  const cudaStream_t stream = batch.stream.get();
  if (batch.device_hits.size() < hits) batch.device_hits = gpu::DeviceBuffer<Hit>(hits, stream);
  if (results == Results::points && batch.device_points.size() < firings)
    batch.device_points = gpu::DeviceBuffer<PointHit>(firings, stream);
  const std::size_t bytes =
      results == Results::points ? firings * sizeof(PointHit) : hits * sizeof(Hit);
  if (batch.results.size() < bytes) batch.results = gpu::PinnedBuffer<std::uint8_t>(bytes);
}

void SceneScanner::launch(DeviceScanner& device, HitLaunch& batch,
                          std::span<const ScanMotion> scans, int depth, Results results) const {
  const cudaStream_t stream = batch.stream.get();
  batch.poses.upload(scans.subspan(batch.first, batch.count), scene_.origin, stream);
  RaySource source = source_of(device, batch.count);
  batch.poses.set(source);
  const std::uint64_t rays = batch.count * firings_;
  batch.begin.record(stream);
  device.part->scene->cast(source, rays, depth, batch.device_hits.data(), stream);
  const void* values = batch.device_hits.data();
  std::size_t bytes = rays * static_cast<std::uint64_t>(depth) * sizeof(Hit);
  if (results == Results::points) {
    gpu::queue_point_hits(batch.device_hits.data(), device.firings.data(), source.firing_count,
                          rays, batch.device_points.data(), stream);
    values = batch.device_points.data();
    bytes = rays * sizeof(PointHit);
  }
  batch.end.record(stream);
  cuda_check(cudaMemcpyAsync(batch.results.data(), values, bytes, cudaMemcpyDeviceToHost, stream),
             "copy the hits from the GPU");
}

CastTimes SceneScanner::cast(std::span<const ScanMotion> motions, Results results, int depth,
                             FunctionRef<void(std::size_t, const std::uint8_t*)> sink) {
  const std::size_t hits_a_scan = firings_ * static_cast<std::size_t>(depth);
  const std::size_t scan_bytes =
      results == Results::points ? firings_ * sizeof(PointHit) : hits_a_scan * sizeof(Hit);
  const std::size_t lanes = devices_.size() * gpu::kSlots;
  const std::size_t most = std::clamp<std::size_t>(gpu::kScanRaysAtOnce / hits_a_scan, 1, 256);
  const std::size_t scans =
      std::max<std::size_t>(1, std::min(most, (motions.size() + lanes - 1) / lanes));
  // Batch k runs in lane k % lanes, so batches are returned in order.
  for (std::size_t lane = 0; lane < std::min(lanes, (motions.size() + scans - 1) / scans); ++lane) {
    DeviceScanner& device = *devices_[lane % devices_.size()];
    const DeviceGuard guard(device.part->device);
    auto& batch = device.batches[lane / devices_.size()];
    if (batch == nullptr) batch = std::make_unique<HitLaunch>();
    reserve(*batch, scans, depth, results);
    batch->stream.wait("prepare scans on the GPU");  // after an exception
    batch->count = 0;
  }

  CastTimes times;
  double in_sink_s = 0;
  const auto start = gpu::Clock::now();
  const auto begin_batch = [&](std::size_t k) {
    DeviceScanner& device = *devices_[k % lanes % devices_.size()];
    const DeviceGuard guard(device.part->device);
    HitLaunch& batch = *device.batches[k % lanes / devices_.size()];
    batch.first = k * scans;
    batch.count = std::min(scans, motions.size() - batch.first);
    launch(device, batch, motions, depth, results);
  };
  const auto end_batch = [&](std::size_t k) {
    DeviceScanner& device = *devices_[k % lanes % devices_.size()];
    const DeviceGuard guard(device.part->device);
    HitLaunch& batch = *device.batches[k % lanes / devices_.size()];
    batch.stream.wait("cast scans on the GPU");
    times.traced_s += batch.end.seconds_since(batch.begin);
    const auto sink_start = gpu::Clock::now();
    for (std::size_t i = 0; i < batch.count; ++i)
      sink(batch.first + i, batch.results.data() + i * scan_bytes);
    in_sink_s += gpu::seconds_since(sink_start);
  };
  const std::size_t batches = (motions.size() + scans - 1) / scans;
  for (std::size_t k = 0; k < std::min(lanes, batches); ++k) begin_batch(k);
  for (std::size_t k = 0; k < batches; ++k) {
    end_batch(k);
    if (k + lanes < batches) begin_batch(k + lanes);
  }
  times.returned_s = gpu::seconds_since(start) - in_sink_s;
  return times;
}

void wait_for(const DeviceHits& hits) {
  const DeviceGuard guard(hits.device);
  cuda_check(cudaStreamSynchronize(static_cast<cudaStream_t>(hits.stream)),
             "cast scans on the GPU");
}

std::vector<Hit> download(const DeviceHits& hits, int depth) {
  const DeviceGuard guard(hits.device);
  std::vector<Hit> values(hits.scans * hits.rays_per_scan * static_cast<std::size_t>(depth));
  cuda_check(cudaMemcpyAsync(values.data(), hits.hits, values.size() * sizeof(Hit),
                             cudaMemcpyDeviceToHost, static_cast<cudaStream_t>(hits.stream)),
             "copy the hits from the GPU");
  wait_for(hits);
  return values;
}

CastTimes SceneScanner::cast(std::span<const ScanMotion> scans, int depth, ScanCaster::Sink sink) {
  const std::size_t hits = firings_ * static_cast<std::size_t>(depth);
  return cast(scans, Results::hits, depth, [&](std::size_t scan, const std::uint8_t* results) {
    sink(scan, {reinterpret_cast<const Hit*>(results), hits});
  });
}

CastTimes SceneScanner::cast_points(std::span<const ScanMotion> scans, PointSink sink) {
  return cast(scans, Results::points, 1, [&](std::size_t scan, const std::uint8_t* results) {
    sink(scan, {reinterpret_cast<const PointHit*>(results), firings_});
  });
}

}  // namespace adasplats
#endif
