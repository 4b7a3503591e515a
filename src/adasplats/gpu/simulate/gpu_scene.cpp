// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/simulate/gpu_scene.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/device_tiles.h"
#include "adasplats/gpu/simulate/gpu_renderer.h"
#include "adasplats/gpu/simulate/gpu_reporter.h"
#include "adasplats/gpu/simulate/gpu_scanner.h"
#include "adasplats/gpu/trace/gpu_tracer.h"
#include "adasplats/simulate/image/shading.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

using gpu::cuda_check;
using gpu::DeviceGuard;
using gpu::DevicePart;
using gpu::SceneParts;

namespace {

bool same_firing(const Firing& a, const Firing& b) {
  const auto same = [](Vec3f u, Vec3f v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  return same(a.direction, b.direction) && same(a.origin, b.origin) && a.ring == b.ring &&
         a.column == b.column && a.time_s == b.time_s;
}

/// Keeps the scanner of the sensor that was used last: a sensor that is driven casts scan by scan,
/// and putting its rays in order and on the GPU takes longer than casting them.
class SceneScanCaster final : public ScanCaster {
 public:
  explicit SceneScanCaster(const SceneParts& parts) : parts_(parts) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    if (scans.empty()) return {};
    const std::unique_lock lock(mutex_, std::try_to_lock);
    // Another thread, or a sink that casts, has the kept one.
    if (!lock) return cast_with(GpuScanner::Impl(parts_, sensor, firings), scans, depth, sink);
    if (!kept_ || !is_kept(sensor, firings)) {
      kept_.reset();  // its memory is free before the next one needs some
      kept_.emplace(parts_, sensor, firings);
    }
    return cast_with(kept_->scanner, scans, depth, sink);
  }

  ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                     std::uint64_t first_number, const Executor& executor,
                     ScanSink sink) const override {
    return report_scans(rules, scans, first_number, nullptr, executor, sink);
  }

  ReportTimes report_scans(const ScanRules& rules, std::span<const ScanMotion> scans,
                           std::uint64_t first_number, const World* world, const Executor& executor,
                           ScanSink sink) const {
    std::vector<Scan> taken;
    return with_reporter(rules, [&](GpuReporter& reporter) {
      return reporter.report(
          scans, first_number, world, GpuScene::Results::host, [&](const ScanBatch& batch) {
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
                             GpuScene::Results results, GpuScene::BatchSink sink) const {
    return with_reporter(rules, [&](GpuReporter& reporter) {
      return reporter.report(scans, first_number, world, results, sink);
    });
  }

 private:
  /// With the one that is kept, where these are its rules and nobody else has it.
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
    GpuScanner::Impl scanner;
    std::vector<Firing> firings;
    double min_range_m, max_range_m;
  };

  bool is_kept(const LidarModel& sensor, std::span<const Firing> firings) const {
    return kept_->min_range_m == sensor.min_range_m && kept_->max_range_m == sensor.max_range_m &&
           std::equal(firings.begin(), firings.end(), kept_->firings.begin(), kept_->firings.end(),
                      same_firing);
  }

  static CastTimes cast_with(GpuScanner::Impl&& scanner, std::span<const ScanMotion> scans,
                             int depth, Sink sink) {
    return cast_with(scanner, scans, depth, sink);
  }
  static CastTimes cast_with(GpuScanner::Impl& scanner, std::span<const ScanMotion> scans,
                             int depth, Sink sink) {
    const std::size_t hits = scanner.firings() * static_cast<std::size_t>(depth);
    return scanner.cast(scans, GpuScanner::Impl::Results::hits, depth,
                        [&](std::size_t scan, const std::uint8_t* results) {
                          sink(scan, {reinterpret_cast<const Hit*>(results), hits});
                        });
  }

  const SceneParts& parts_;
  mutable std::mutex mutex_;
  mutable std::optional<Kept> kept_;
  mutable std::mutex reporter_mutex_;
  mutable std::optional<GpuReporter> reporter_;
  mutable std::shared_ptr<const int> reporter_rules_;  ///< identity of the rules of `reporter_`
};

/// A scene that belongs to someone else.
class SharedScene final : public gpu::DeviceScene {
 public:
  explicit SharedScene(const gpu::DeviceScene& scene) : scene_(scene) {}
  std::string_view name() const override { return scene_.name(); }
  void cast(const gpu::RaySource& source, std::uint64_t count, int depth, Hit* hits,
            cudaStream_t stream) const override {
    scene_.cast(source, count, depth, hits, stream);
  }

 private:
  const gpu::DeviceScene& scene_;
};

void check_devices(const std::vector<int>& devices) {
  const GpuSearch search = find_gpus();
  if (search.devices.empty())
    throw Error(ErrorKind::unavailable, "cannot trace on a GPU: " + search.reason);
  if (devices.empty()) throw Error(ErrorKind::usage, "no GPU was named");
  for (const int device : devices) {
    bool known = false;
    for (const GpuDevice& found : search.devices) known = known || found.index == device;
    if (known) continue;
    throw Error(ErrorKind::unavailable, "there is no GPU " + std::to_string(device) +
                                            ": CUDA sees " + std::to_string(search.devices.size()) +
                                            ", numbered from 0");
  }
}

}  // namespace

struct GpuScene::Impl {
  SceneParts parts;
  std::unique_ptr<Tracer> tracer;
  std::unique_ptr<SceneScanCaster> caster;
  double build_seconds = 0;
  std::vector<std::unique_ptr<gpu::DeviceTiles>> tiles;  ///< one a device; of cities alone

  void make_casters() {
    tracer = gpu::make_gpu_tracer(*parts.first().scene, parts.first().device);
    caster = std::make_unique<SceneScanCaster>(parts);
  }

  /// Calls use(tiles) for every device, which is the current one then.
  template <class Use>
  void for_each_device(Use&& use) {
    if (tiles.empty()) throw std::logic_error("GpuScene: no city of tiles");
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const DeviceGuard guard(parts.parts[i].device);
      use(*tiles[i]);
    }
  }

  ~Impl() {
    caster.reset();
    tracer.reset();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const DeviceGuard guard(parts.parts[i].device);
      tiles[i].reset();
    }
    for (DevicePart& part : parts.parts) {
      const DeviceGuard guard(part.device);
      part.scene.reset();
    }
  }
};

GpuScene::GpuScene(const SceneView& scene, Vec3d origin, GpuBackend backend,
                   const std::vector<int>& devices)
    : impl_(std::make_unique<Impl>()) {
  check_devices(devices);
  impl_->parts.origin = origin;
  for (const int device : devices) {
    const DeviceGuard guard(device);
    cuda_check(cudaFree(nullptr), "start CUDA");  // its start is not part of the building
    const auto start = std::chrono::steady_clock::now();
    impl_->parts.parts.push_back({device, backend == GpuBackend::optix
                                              ? gpu::make_optix_scene(scene)
                                              : gpu::make_cuda_scene(scene)});
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (impl_->parts.parts.size() == 1) impl_->build_seconds = took.count();
  }
  impl_->make_casters();
}

GpuScene::GpuScene(std::span<const std::size_t> splats, std::span<const PrimitiveValues> objects,
                   Vec3d origin, const std::vector<int>& devices)
    : impl_(std::make_unique<Impl>()) {
  check_devices(devices);
  impl_->parts.origin = origin;
  for (const int device : devices) {
    const DeviceGuard guard(device);
    auto tiles = std::make_unique<gpu::DeviceTiles>(splats, objects);
    impl_->parts.parts.push_back(
        {device, std::make_unique<SharedScene>(tiles->scene()), tiles->values()});
    impl_->tiles.push_back(std::move(tiles));
  }
  impl_->make_casters();
}

void GpuScene::load_tile(std::size_t tile, std::span<const Disk> disks,
                         std::span<const PrimitiveValues> values) {
  impl_->for_each_device([&](gpu::DeviceTiles& tiles) { tiles.load(tile, disks, values); });
}

void GpuScene::drop_tile(std::size_t tile) {
  impl_->for_each_device([&](gpu::DeviceTiles& tiles) { tiles.drop(tile); });
}

void GpuScene::show_tiles(std::span<const std::size_t> shown) {
  impl_->for_each_device([&](gpu::DeviceTiles& tiles) { tiles.scene().show(shown); });
}

GpuScene::~GpuScene() = default;
GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;

std::string_view GpuScene::name() const { return impl_->parts.first().scene->name(); }
double GpuScene::build_seconds() const { return impl_->build_seconds; }
const Tracer& GpuScene::tracer() const { return *impl_->tracer; }
const ScanCaster& GpuScene::scan_caster() const { return *impl_->caster; }
ReportTimes GpuScene::report(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const World* world, Results results,
                             BatchSink sink) const {
  return impl_->caster->report_batches(rules, scans, first_number, world, results, sink);
}
ReportTimes GpuScene::report(const ScanRules& rules, std::span<const ScanMotion> scans,
                             std::uint64_t first_number, const World* world,
                             const Executor& executor, ScanCaster::ScanSink sink) const {
  return impl_->caster->report_scans(rules, scans, first_number, world, executor, sink);
}

std::unique_ptr<GpuScanner> GpuScene::scanner(const LidarModel& sensor,
                                              std::span<const Firing> firings) const {
  return std::unique_ptr<GpuScanner>(
      new GpuScanner(std::make_unique<GpuScanner::Impl>(impl_->parts, sensor, firings)));
}

std::unique_ptr<GpuRenderer> GpuScene::renderer(const ImageScene& scene,
                                                const ImageOptions& options) const {
  return std::unique_ptr<GpuRenderer>(
      new GpuRenderer(std::make_unique<GpuRenderer::Impl>(impl_->parts, scene, options)));
}

Image GpuScene::render(const ImageScene& scene, const Camera& camera,
                       const ImageOptions& options) const {
  check_image(camera, options);
  return renderer(scene, options)->render(camera);
}

}  // namespace adasplats
#endif
