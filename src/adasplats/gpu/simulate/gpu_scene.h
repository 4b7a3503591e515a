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
#include "adasplats/simulate/scan/firing_report.h"
#include "adasplats/simulate/scene_engine.h"

namespace adasplats {

/// Ray tracing backend on a GPU.
enum class TracingBackend : std::uint8_t {
  cuda,   ///< our own wide tree, on any GPU
  optix,  ///< OptiX of the driver, which uses the ray tracing units of RTX cards
};

/// Hits in GPU memory: hits[scan * rays_per_scan + firing], on `device`. Valid until the next call
/// or the destruction of the scanner.
struct DeviceHits {
  const Hit* hits = nullptr;
  std::size_t scans = 0;
  std::size_t rays_per_scan = 0;
  int device = 0;
  void* stream = nullptr;  ///< cudaStream_t on which they are complete
};

/// Waits until the hits are complete. Errors: unavailable (a kernel failed).
void wait_for(const DeviceHits& hits);
/// Copies the hits to host memory once they are complete.
std::vector<Hit> download(const DeviceHits& hits, int depth = 1);

/// A hit as a point, 16 bytes.
struct PointHit {
  Vec3f position;                        ///< sensor frame, m; {0, 0, 0} for a miss
  std::uint32_t primitive = Hit::kNone;  ///< as in Hit
};
static_assert(sizeof(PointHit) == 16);

/// Casts the firings of one sensor into a GpuScene, which must outlive it. The firings are stored
/// on the GPUs, and rays are made there. Not thread-safe.
class GpuScanner {
 public:
  virtual ~GpuScanner() = default;

  /// Casts one scan: hits[i] of firing i, valid until the next call.
  virtual std::span<const Hit> scan(const ScanMotion& motion) = 0;

  /// Casts many scans per launch; hits are copied while the next ones are traced. The devices share
  /// the scans. `sink` as in ScanCaster.
  virtual CastTimes cast(std::span<const ScanMotion> scans, int depth, ScanCaster::Sink sink) = 0;

  /// Returns the nearest hits as points, each in the sensor's frame at its time.
  using PointSink = FunctionRef<void(std::size_t scan, std::span<const PointHit> hits)>;
  virtual CastTimes cast_points(std::span<const ScanMotion> scans, PointSink sink) = 0;

  /// Keeps the `depth` nearest hits of every ray on the first device (depth times as many hits).
  /// Asynchronous: readers must use `stream` or wait for it.
  virtual DeviceHits cast_on_device(std::span<const ScanMotion> scans, int depth = 1) = 0;
};

/// A scene on one GPU, or copies of it on several GPUs of one machine. Not thread-safe.
class GpuScene : public SceneEngine {
 public:
  virtual std::string_view name() const = 0;  ///< "cuda" or "optix"
  /// Build time of the structures on the first device, s, including the copy of the scene.
  virtual double build_seconds() const = 0;
  virtual std::unique_ptr<GpuScanner> scanner(const LidarModel& sensor,
                                              std::span<const Firing> firings) const = 0;
};

/// Builds the structures and copies the data it needs: the result may outlive `scene`. `origin`:
/// world coordinates of the scene's local origin, m. `devices`: CUDA device numbers, at least one.
/// Errors: unavailable (no such GPU, no OptiX, not enough memory), with a remedy.
std::unique_ptr<GpuScene> make_gpu_scene(const SceneView& scene, Vec3d origin,
                                         TracingBackend backend, const std::vector<int>& devices);

/// A city on GPUs with some of its tiles loaded, in our own trees.
class GpuCity {
 public:
  virtual ~GpuCity() = default;

  /// ScanRules of its reports need only flags and response: attributes of primitives come with
  /// tiles.
  virtual const SceneCaster& scan_caster() const = 0;

  /// Copies a tile to all devices; may run during casts, on one thread at a time. Errors:
  /// unavailable (not enough memory; the tile is not loaded).
  virtual void load_tile(std::size_t tile, std::span<const Disk> disks,
                         std::span<const PrimitiveValues> values) = 0;
  /// Frees a tile that is not shown.
  virtual void drop_tile(std::size_t tile) = 0;
  /// Selects the loaded tiles that rays can hit from now on. Not during casts.
  virtual void show_tiles(std::span<const std::size_t> tiles) = 0;

  /// Approximate memory of a tile per splat, bytes.
  static constexpr std::size_t kTileBytesASplat = 84;
};

/// A city without loaded tiles. `splats`: number of splats of each tile; primitives are numbered
/// across all tiles. `objects`: attributes of the primitives that follow. Errors: those of
/// make_gpu_scene(); data (too many splats to number).
std::unique_ptr<GpuCity> make_gpu_city(std::span<const std::size_t> splats,
                                       std::span<const PrimitiveValues> objects, Vec3d origin,
                                       const std::vector<int>& devices);

}  // namespace adasplats
