// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/gpu_scene.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/device_tiles.h"
#include "adasplats/gpu/simulate/gpu_renderer.h"
#include "adasplats/gpu/simulate/gpu_reporter.h"
#include "adasplats/gpu/simulate/gpu_scanner.h"
#include "adasplats/gpu/trace/gpu_tracer.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

using gpu::cuda_check;
using gpu::DeviceGuard;
using gpu::SceneParts;

namespace {

bool same_firing(const Firing& a, const Firing& b) {
  const auto same = [](Vec3f u, Vec3f v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  return same(a.direction, b.direction) && same(a.origin, b.origin) && a.ring == b.ring &&
         a.column == b.column && a.time_s == b.time_s;
}

/// Caches the scanner of the sensor used last: a moving sensor casts scan by scan, and ordering its
/// rays and copying them to the GPU takes longer than casting them.
class GpuSceneCaster final : public SceneCaster {
 public:
  explicit GpuSceneCaster(const SceneParts& parts) : parts_(parts) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    if (scans.empty()) return {};
    const std::unique_lock lock(mutex_, std::try_to_lock);
    // The cached scanner is in use by another thread, or by a sink that casts.
    if (!lock) return SceneScanner(parts_, sensor, firings).cast(scans, depth, sink);
    if (!kept_ || !is_kept(sensor, firings)) {
      kept_.reset();  // frees its memory before the next one is made
      kept_.emplace(parts_, sensor, firings);
    }
    return kept_->scanner.cast(scans, depth, sink);
  }

  ReportTimes report_world(const ScanRules& rules, std::span<const ScanMotion> scans,
                           std::uint64_t first_number, const World* world, const Executor& executor,
                           ScanSink sink) const override {
    std::vector<Scan> taken;
    return with_reporter(rules, [&](GpuReporter& reporter) {
      return reporter.report(
          scans, first_number, world, executor, BatchMemory::host, [&](const ScanBatch& batch) {
            if (taken.size() < batch.scans()) taken.resize(batch.scans());
            executor.for_chunks(batch.scans(), 1, [&](std::size_t i, std::size_t) {
              ScanView(batch, i, scans[batch.first + i], rules).copy_to(taken[i]);
            });
            for (std::size_t i = 0; i < batch.scans(); ++i)
              sink(batch.first + i, std::move(taken[i]));
          });
    });
  }

  ReportTimes report_batches(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const World* world,
                             const Executor& executor, BatchMemory memory,
                             BatchSink sink) const override {
    return with_reporter(rules, [&](GpuReporter& reporter) {
      return reporter.report(scans, first_number, world, executor, memory, sink);
    });
  }

  bool has_large_batches() const override { return true; }

 private:
  /// Uses the cached reporter if it has these rules and is not in use.
  template <class F>
  ReportTimes with_reporter(const ScanRules& rules, F&& use) const {
    const std::unique_lock lock(reporter_mutex_, std::try_to_lock);
    if (!lock) {
      GpuReporter reporter(parts_, rules);
      return use(reporter);
    }
    if (!reporter_ || reporter_rules_ != rules.identity()) {
      reporter_.reset();
      reporter_rules_ = nullptr;
      reporter_.emplace(parts_, rules);
      reporter_rules_ = rules.identity();
    }
    return use(*reporter_);
  }

  struct Kept {
    Kept(const SceneParts& parts, const LidarModel& sensor, std::span<const Firing> firings_in)
        : scanner(parts, sensor, firings_in),
          firings(firings_in.begin(), firings_in.end()),
          min_range_m(sensor.min_range_m),
          max_range_m(sensor.max_range_m) {}
    SceneScanner scanner;
    std::vector<Firing> firings;
    double min_range_m, max_range_m;
  };

  bool is_kept(const LidarModel& sensor, std::span<const Firing> firings) const {
    return kept_->min_range_m == sensor.min_range_m && kept_->max_range_m == sensor.max_range_m &&
           std::equal(firings.begin(), firings.end(), kept_->firings.begin(), kept_->firings.end(),
                      same_firing);
  }

  const SceneParts& parts_;
  mutable std::mutex mutex_;
  mutable std::optional<Kept> kept_;
  mutable std::mutex reporter_mutex_;
  mutable std::optional<GpuReporter> reporter_;
  mutable std::shared_ptr<const int> reporter_rules_;  ///< identity of the rules of `reporter_`
};

void check_devices(const std::vector<int>& devices) {
  const GpuSearch search = find_gpus();
  if (search.devices.empty())
    throw Error(ErrorKind::unavailable, "cannot trace on a GPU: " + search.reason);
  if (devices.empty()) throw Error(ErrorKind::usage, "the list of GPUs is empty");
  for (const int device : devices) {
    bool known = false;
    for (const GpuDevice& found : search.devices) known = known || found.index == device;
    if (known) continue;
    throw Error(ErrorKind::unavailable, "there is no GPU " + std::to_string(device) +
                                            ": CUDA sees " + std::to_string(search.devices.size()) +
                                            ", numbered from 0");
  }
}

class SceneOnGpus final : public GpuScene {
 public:
  SceneOnGpus(const SceneView& scene, Vec3d origin, TracingBackend backend,
              const std::vector<int>& devices) {
    check_devices(devices);
    parts_.origin = origin;
    for (const int device : devices) {
      const DeviceGuard guard(device);
      cuda_check(cudaFree(nullptr), "start CUDA");  // excluded from the build time
      const Stopwatch watch;
      parts_.parts.push_back({device, backend == TracingBackend::optix
                                          ? gpu::make_optix_scene(scene)
                                          : gpu::make_cuda_scene(scene)});
      if (parts_.parts.size() == 1) build_seconds_ = watch.seconds();
    }
    tracer_ = gpu::make_gpu_tracer(*parts_.first().scene, parts_.first().device);
  }

  std::string_view name() const override { return parts_.first().scene->name(); }
  double build_seconds() const override { return build_seconds_; }
  const Tracer& tracer() const override { return *tracer_; }
  const SceneCaster& scan_caster() const override { return caster_; }
  std::unique_ptr<GpuScanner> scanner(const LidarModel& sensor,
                                      std::span<const Firing> firings) const override {
    return std::make_unique<SceneScanner>(parts_, sensor, firings);
  }
  std::unique_ptr<ImageRenderer> renderer(const ImageScene& scene,
                                          const ImageOptions& options) const override {
    return std::make_unique<GpuRenderer>(parts_, scene, options);
  }

 private:
  SceneParts parts_;
  double build_seconds_ = 0;
  std::unique_ptr<Tracer> tracer_;
  GpuSceneCaster caster_{parts_};
};

class CityOnGpus final : public GpuCity {
 public:
  CityOnGpus(std::span<const std::size_t> splats, std::span<const PrimitiveValues> objects,
             Vec3d origin, const std::vector<int>& devices) {
    check_devices(devices);
    parts_.origin = origin;
    for (const int device : devices) {
      const DeviceGuard guard(device);
      const auto tiles = std::make_shared<gpu::DeviceTiles>(splats, objects);
      parts_.parts.push_back(
          {device, std::shared_ptr<gpu::DeviceScene>(tiles, &tiles->scene()), tiles->values()});
      tiles_.push_back(tiles.get());
    }
  }

  const SceneCaster& scan_caster() const override { return caster_; }

  void load_tile(std::size_t tile, std::span<const Disk> disks,
                 std::span<const PrimitiveValues> values) override {
    for_each_device([&](gpu::DeviceTiles& tiles) { tiles.load(tile, disks, values); });
  }
  void drop_tile(std::size_t tile) override {
    for_each_device([&](gpu::DeviceTiles& tiles) { tiles.drop(tile); });
  }
  void show_tiles(std::span<const std::size_t> shown) override {
    for_each_device([&](gpu::DeviceTiles& tiles) { tiles.scene().show(shown); });
  }

 private:
  /// Calls use(tiles) for every device, with that device current.
  template <class Use>
  void for_each_device(Use&& use) {
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      const DeviceGuard guard(parts_.parts[i].device);
      use(*tiles_[i]);
    }
  }

  SceneParts parts_;
  std::vector<gpu::DeviceTiles*> tiles_;  ///< of each device; `parts_` owns them
  GpuSceneCaster caster_{parts_};
};

}  // namespace

std::unique_ptr<GpuScene> make_gpu_scene(const SceneView& scene, Vec3d origin,
                                         TracingBackend backend, const std::vector<int>& devices) {
  return std::make_unique<SceneOnGpus>(scene, origin, backend, devices);
}

std::unique_ptr<GpuCity> make_gpu_city(std::span<const std::size_t> splats,
                                       std::span<const PrimitiveValues> objects, Vec3d origin,
                                       const std::vector<int>& devices) {
  return std::make_unique<CityOnGpus>(splats, objects, origin, devices);
}

}  // namespace adasplats
#endif
