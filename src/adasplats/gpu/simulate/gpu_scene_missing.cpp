// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if !defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/gpu/simulate/gpu_scene.h"

namespace adasplats {

/// Nothing of a GpuScene exists in a build without CUDA: the constructor says so.
struct GpuScene::Impl {};

namespace {

[[noreturn]] void throw_missing() {
  throw Error(ErrorKind::unavailable, "cannot trace on a GPU: " + find_gpus().reason);
}

}  // namespace

GpuScene::GpuScene(const SceneView&, Vec3d, GpuBackend, const std::vector<int>&) {
  throw_missing();
}
GpuScene::GpuScene(std::span<const std::size_t>, std::span<const PrimitiveValues>, Vec3d,
                   const std::vector<int>&) {
  throw_missing();
}
void GpuScene::load_tile(std::size_t, std::span<const Disk>, std::span<const PrimitiveValues>) {
  throw_missing();
}
void GpuScene::drop_tile(std::size_t) { throw_missing(); }
void GpuScene::show_tiles(std::span<const std::size_t>) { throw_missing(); }
GpuScene::~GpuScene() = default;
GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;

std::string_view GpuScene::name() const { throw_missing(); }
double GpuScene::build_seconds() const { throw_missing(); }
const Tracer& GpuScene::tracer() const { throw_missing(); }
const ScanCaster& GpuScene::scan_caster() const { throw_missing(); }
ReportTimes GpuScene::report(const ScanRules&, std::span<const ScanMotion>, std::uint64_t,
                             const World*, Results, BatchSink) const {
  throw_missing();
}
ReportTimes GpuScene::report(const ScanRules&, std::span<const ScanMotion>, std::uint64_t,
                             const World*, const Executor&, ScanCaster::ScanSink) const {
  throw_missing();
}
std::unique_ptr<GpuScanner> GpuScene::scanner(const LidarModel&, std::span<const Firing>) const {
  throw_missing();
}
std::unique_ptr<GpuRenderer> GpuScene::renderer(const ImageScene&, const ImageOptions&) const {
  throw_missing();
}
Image GpuScene::render(const ImageScene&, const Camera&, const ImageOptions&) const {
  throw_missing();
}

void wait_for(const DeviceHits&) { throw_missing(); }
std::vector<Hit> download(const DeviceHits&, int) { throw_missing(); }

struct GpuScanner::Impl {};
GpuScanner::~GpuScanner() = default;
std::span<const Hit> GpuScanner::scan(const ScanMotion&) { throw_missing(); }
CastTimes GpuScanner::cast(std::span<const ScanMotion>, int, ScanCaster::Sink) { throw_missing(); }
CastTimes GpuScanner::cast_points(std::span<const ScanMotion>, PointSink) { throw_missing(); }
DeviceHits GpuScanner::cast_on_device(std::span<const ScanMotion>, int) { throw_missing(); }

struct GpuRenderer::Impl {};
GpuRenderer::~GpuRenderer() = default;
Image GpuRenderer::render(const Camera&) { throw_missing(); }
void GpuRenderer::render_all(std::span<const Camera>, Sink) { throw_missing(); }

}  // namespace adasplats
#endif
