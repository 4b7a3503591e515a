// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/trace/ray_source.h"
#include "adasplats/gpu/trace/scene_trees.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats::gpu {

/// Private to gpu/: the geometries of a world on one device. Each is built when a scan first sees
/// it; geometries of a single scan are freed when they are no longer held.
class DeviceWorld {
 public:
  /// The world must outlive it.
  explicit DeviceWorld(const World& world);

  bool is_of(const World& world) const { return identity_ == world.identity(); }
  std::shared_ptr<const SceneTrees> trees(std::size_t geometry);

 private:
  const World* world_;
  std::shared_ptr<const int> identity_;
  std::shared_ptr<Stream> stream_;  ///< of the memory of the trees
  std::vector<std::shared_ptr<const SceneTrees>> kept_;
  std::vector<std::weak_ptr<const SceneTrees>> held_;
};

/// The objects of a world seen by the scans of one launch, in device memory.
struct LaunchWorld {
  const TreesView* trees = nullptr;
  const ObjectSighting* objects = nullptr;  ///< `geometry` is an index of `trees`
  const ObjectPose* knots = nullptr;
  const std::uint32_t* first_objects = nullptr;  ///< of each scan; number of scans + 1
};

/// The objects of a launch: copied to the device, then cast.
class WorldObjects {
 public:
  /// Queues the copy of the objects that scans `first_number` + i see. Earlier ones must have been
  /// cast.
  void upload(const World& world, DeviceWorld& on_device, std::span<const ScanMotion> motions,
              std::uint64_t first_number, double scan_duration_s, const Executor& executor,
              cudaStream_t stream);
  /// Queues the merging of their hits into those of the scene, as World::add_hits() does.
  void add_hits(const RaySource& source, int depth, Hit* hits, cudaStream_t stream) const;

 private:
  template <class T>
  struct Copied {
    PinnedBuffer<T> host;
    DeviceBuffer<T> device;
    std::size_t size = 0;
    void resize(std::size_t values, cudaStream_t stream);
    void upload() { device.upload(host.span().first(size)); }
  };

  void find_trees(DeviceWorld& on_device, cudaStream_t stream);

  std::vector<ObjectSightings> seen_;  ///< by scan
  std::vector<std::shared_ptr<const SceneTrees>> held_;
  Copied<TreesView> trees_;
  Copied<ObjectSighting> objects_;
  Copied<ObjectPose> knots_;
  Copied<std::uint32_t> first_objects_;
};

}  // namespace adasplats::gpu
