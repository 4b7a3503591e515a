// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/scene/scene.h"
#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/image.h"
#include "adasplats/simulate/scan/firing_report.h"
#include "adasplats/simulate/scan/scan_batch.h"
#include "adasplats/simulate/scan/scan_caster.h"
#include "adasplats/simulate/scan/scan_rules.h"
#include "adasplats/simulate/world/world.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Who traces on a GPU.
enum class GpuBackend : std::uint8_t {
  cuda,   ///< our own wide tree, on any GPU
  optix,  ///< OptiX of the driver: uses the ray tracing units of RTX cards
};

/// Hits that stayed on the GPU: hits[scan * rays_per_scan + firing], in device memory of `device`.
/// Valid until the scanner's next call, or until it ends.
struct DeviceHits {
  const Hit* hits = nullptr;
  std::size_t scans = 0;
  std::size_t rays_per_scan = 0;
  int device = 0;
  void* stream = nullptr;  ///< cudaStream_t on which they are complete
};

/// Waits until they are complete. Errors: unavailable (a kernel failed).
void wait_for(const DeviceHits& hits);
/// The same hits in host memory, when they are complete.
std::vector<Hit> download(const DeviceHits& hits, int depth = 1);

/// A hit as a point, 16 bytes.
struct PointHit {
  Vec3f position;                        ///< sensor frame, m; {0, 0, 0} where there is none
  std::uint32_t primitive = Hit::kNone;  ///< as in Hit
};
static_assert(sizeof(PointHit) == 16);

/// A sensor in a GpuScene, ready to scan: its firings are on the GPUs, and rays are made there. The
/// scene must outlive it. One thread at a time.
class GpuScanner {
 public:
  ~GpuScanner();
  GpuScanner(const GpuScanner&) = delete;
  GpuScanner& operator=(const GpuScanner&) = delete;

  /// One scan, now: hits[i] of firing i, valid until the next call.
  std::span<const Hit> scan(const ScanMotion& motion);

  /// Many scans a launch; hits are copied while the next ones are traced. Several devices share the
  /// scans. `sink` as in ScanCaster.
  CastTimes cast(std::span<const ScanMotion> scans, int depth, ScanCaster::Sink sink);

  /// The nearest hits as points instead of distances, each in the sensor's frame at its time.
  using PointSink = FunctionRef<void(std::size_t scan, std::span<const PointHit> hits)>;
  CastTimes cast_points(std::span<const ScanMotion> scans, PointSink sink);

  /// Without copying anything back, on the first device; the `depth` nearest hits of every ray
  /// (then there are depth times as many hits). Asynchronous: whoever reads them does it on
  /// `stream`, or waits for it.
  DeviceHits cast_on_device(std::span<const ScanMotion> scans, int depth = 1);

  struct Impl;  ///< private to gpu/

 private:
  friend class GpuScene;
  explicit GpuScanner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Pictures of a GpuScene: what colours need is on the first device. The scene must outlive it. One
/// thread at a time.
class GpuRenderer {
 public:
  ~GpuRenderer();
  GpuRenderer(const GpuRenderer&) = delete;
  GpuRenderer& operator=(const GpuRenderer&) = delete;

  /// The picture that render_image() makes: the same bytes where the hits are.
  Image render(const Camera& camera);

  /// Calls `sink` with the pixels (8-bit RGB, rows from the top) of every camera, in their order;
  /// they are valid during the call only and copied while the next picture is made. All cameras
  /// have the same width and height.
  using Sink = FunctionRef<void(std::size_t camera, std::span<const std::uint8_t> pixels)>;
  void render_all(std::span<const Camera> cameras, Sink sink);

  struct Impl;  ///< private to gpu/

 private:
  friend class GpuScene;
  explicit GpuRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A scene on one GPU, or the same scene on each of several GPUs of one machine. Copies what it
/// needs: the scene may end before it. One thread at a time.
class GpuScene {
 public:
  /// Builds the structures. `origin`: world coordinates of the scene's local origin, m. `devices`:
  /// CUDA's numbers, at least one.
  /// Errors: unavailable (no such GPU, OptiX not there, not enough memory), with what helps.
  GpuScene(const SceneView& scene, Vec3d origin, GpuBackend backend,
           const std::vector<int>& devices);
  /// A city whose tiles come and go, in our own trees; none is there yet. `splats`: of each tile;
  /// primitives are numbered through all of them. `objects`: what primitives behind them carry. The
  /// rules of report() give flags and response alone: values of primitives come with the tiles.
  /// Errors: likewise; data (more splats than can be told apart).
  GpuScene(std::span<const std::size_t> splats, std::span<const PrimitiveValues> objects,
           Vec3d origin, const std::vector<int>& devices);
  ~GpuScene();
  GpuScene(GpuScene&&) noexcept;
  GpuScene& operator=(GpuScene&&) noexcept;

  /// Of such a city: puts a tile on all devices, beside casts; takes one away that is not shown;
  /// says which of those that are there rays meet from now on, while nothing is cast. One thread
  /// loads. Errors: unavailable (not enough memory: the tile is not there then).
  void load_tile(std::size_t tile, std::span<const Disk> disks,
                 std::span<const PrimitiveValues> values);
  void drop_tile(std::size_t tile);
  void show_tiles(std::span<const std::size_t> tiles);
  /// About how much memory a tile takes for each splat, bytes.
  static constexpr std::size_t kTileBytesASplat = 84;

  std::string_view name() const;  ///< "cuda" or "optix"
  /// Time that building the structures took on the first device, s (copying the scene included).
  double build_seconds() const;

  /// For rays made by the caller; on the first device.
  const Tracer& tracer() const;

  /// A GpuScanner behind the interface that the CPU has, too.
  const ScanCaster& scan_caster() const;
  std::unique_ptr<GpuScanner> scanner(const LidarModel& sensor,
                                      std::span<const Firing> firings) const;

  /// Where batches of scans are: page-locked host memory that is used again when nobody holds the
  /// batch any more, or memory of the first device, where they are complete.
  enum class Results : std::uint8_t { host, device };
  using BatchSink = FunctionRef<void(ScanBatch&& batch)>;
  /// ScanCaster::report() without a copy: as many scans at once as a launch has. Less GPU memory
  /// makes batches smaller. `world`: what is cast beside the place, whose scan `first_number` is
  /// the first; null: nothing. Errors: unavailable (not enough for one scan).
  ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                     std::uint64_t first_number, const World* world, Results results,
                     BatchSink sink) const;
  /// The same, scan by scan: what make_world_caster() reports.
  ReportTimes report(const ScanRules& rules, std::span<const ScanMotion> scans,
                     std::uint64_t first_number, const World* world, const Executor& executor,
                     ScanCaster::ScanSink sink) const;

  /// `scene.view` must be what the GpuScene was made from.
  std::unique_ptr<GpuRenderer> renderer(const ImageScene& scene, const ImageOptions& options) const;
  /// render_image() on the first device.
  Image render(const ImageScene& scene, const Camera& camera, const ImageOptions& options) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
