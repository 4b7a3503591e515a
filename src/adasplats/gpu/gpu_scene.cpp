// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/gpu_scene.h"

#include <chrono>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/device.h"
#include "adasplats/gpu/gpu_renderer.h"
#include "adasplats/gpu/gpu_scanner.h"
#include "adasplats/gpu/gpu_tracer.h"
#include "adasplats/simulate/shading.h"

namespace adasplats {

using gpu::cuda_check;
using gpu::DeviceGuard;
using gpu::DevicePart;
using gpu::SceneParts;

namespace {

/// Makes a scanner a call: simulations scan whole trajectories in one.
class SceneScanCaster final : public ScanCaster {
 public:
  explicit SceneScanCaster(const SceneParts& parts) : parts_(parts) {}

  CastTimes cast(const LidarModel& sensor, std::span<const Firing> firings,
                 std::span<const ScanMotion> scans, int depth, Sink sink) const override {
    if (scans.empty()) return {};
    const std::size_t hits = firings.size() * static_cast<std::size_t>(depth);
    return GpuScanner::Impl(parts_, sensor, firings)
        .cast(scans, GpuScanner::Impl::Results::hits, depth,
              [&](std::size_t scan, const std::uint8_t* results) {
                sink(scan, {reinterpret_cast<const Hit*>(results), hits});
              });
  }

 private:
  const SceneParts& parts_;
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

  ~Impl() {
    tracer.reset();
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
  impl_->tracer = gpu::make_gpu_tracer(*impl_->parts.first().scene, impl_->parts.first().device);
  impl_->caster = std::make_unique<SceneScanCaster>(impl_->parts);
}

GpuScene::~GpuScene() = default;
GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;

std::string_view GpuScene::name() const { return impl_->parts.first().scene->name(); }
double GpuScene::build_seconds() const { return impl_->build_seconds; }
const Tracer& GpuScene::tracer() const { return *impl_->tracer; }
const ScanCaster& GpuScene::scan_caster() const { return *impl_->caster; }

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
