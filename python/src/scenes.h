// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"
#include "bindings.h"
#include "work.h"

namespace adasplats::python {

/// A scene that rays are cast into, with its threads. Holds no Python objects: results on a GPU
/// keep it alive and may be freed without the GIL.
struct SceneObject {
  Executor executor;
  DeviceChoice device;
  std::unique_ptr<ModelScene> scene;
  std::mutex gpu;  ///< a GpuScene is for one thread at a time

  const ::pid_t process = ::getpid();  ///< the process that made the scene

  explicit SceneObject(int threads) : executor(threads) {}
  /// A forked process has neither the threads nor the GPU. Errors: unavailable.
  void require_own_process() const {
    if (::getpid() == process) return;
    throw Error(
        ErrorKind::unavailable,
        "the scene was made before this process was forked, and a fork has neither its threads "
        "nor its GPU: start workers with the method 'spawn' or 'forkserver', or make the "
        "scene in the worker");
  }
  /// Locks the GPU, if the scene is on one; call it without the GIL. Errors: those of
  /// require_own_process().
  std::unique_lock<std::mutex> lock() {
    require_own_process();
    return scene->on_gpu() ? std::unique_lock(gpu) : std::unique_lock<std::mutex>();
  }
};

using SceneClass = py::class_<SceneObject, std::shared_ptr<SceneObject>>;

/// Each adds methods to Scene.
void add_casting(SceneClass& type);
void add_simulation(SceneClass& type);
void add_placed_poses(SceneClass& type);
void add_rendering(SceneClass& type);
void add_device_results(SceneClass& type);
void add_scan_batches(SceneClass& type);

/// The keywords of simulate() that give the motion of the sensor.
struct DriveArguments {
  py::object motion = py::none();
  bool rolling_shutter = false;

  void take(Keywords& keywords);
  /// `mount`: of the sensor in the frame of the poses. Errors: TypeError, ValueError.
  std::vector<ScanMotion> scans_at(py::handle poses, const LidarModel& sensor,
                                   const RigidTransform& mount = {}) const;
};

}  // namespace adasplats::python
