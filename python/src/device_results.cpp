// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>

#include "adasplats/core/error.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "device_arrays.h"
#include "scenes.h"
#include "sensors.h"

namespace adasplats::python {
namespace {

constexpr const char* kDeviceResultsDoc =
    R"(Cast the rays of a LiDAR at poses and leave the hits in GPU memory.

sensor, poses, motion, rolling_shutter: as in simulate(). depth: maximum number of hits per ray. No
noise, returns or attributes are simulated; of several GPUs the first is used. Returns DeviceHits.
Raises TypeError, ValueError, OSError, RuntimeError (the scene is on the CPU).)";

constexpr const char* kHitsDoc =
    R"(Hits in GPU memory, made by Scene.cast_on_device(): arrays have shape (scans, firings), or
(scans, firings, depth) for a depth above 1.)";

/// Hits and the owners of their memory; may be freed without the GIL.
struct DeviceResults {
  std::shared_ptr<SceneObject> scene;
  std::unique_ptr<GpuScanner> scanner;
  DeviceHits hits;
  int depth = 1;

  ~DeviceResults() {
    // The holder of the lock may be waiting for the GIL.
    std::optional<py::gil_scoped_release> released;
    if (PyGILState_Check() == 1) released.emplace();
    const std::scoped_lock lock(scene->gpu);
    scanner.reset();
  }
};

using Results = std::shared_ptr<DeviceResults>;

struct DeviceArguments {
  DriveArguments drive;
  int depth = 1;

  void take(Keywords& keywords) {
    drive.take(keywords);
    keywords.take("depth", depth);
  }
};

Results cast_on_device(const std::shared_ptr<SceneObject>& object, py::handle sensor,
                       py::handle poses, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<DeviceArguments>("cast_on_device", kwargs);
  if (arguments.depth < 1 || arguments.depth > kMaxDepth)
    throw py::value_error("depth must be 1 to " + std::to_string(kMaxDepth));
  const GpuScene* const gpu = object->scene->gpu();
  if (gpu == nullptr)
    throw Error(ErrorKind::unavailable,
                "the scene is on the CPU; results in GPU memory need Scene(..., device='cuda')");
  const LidarModel model = sensor_of(sensor);
  const std::vector<ScanMotion> scans = arguments.drive.scans_at(poses, model);
  auto results = std::make_shared<DeviceResults>();
  results->scene = object;
  results->depth = arguments.depth;
  const py::gil_scoped_release released;
  const auto lock = object->lock();
  results->scanner = gpu->scanner(model, firings_of(model));
  results->hits = results->scanner->cast_on_device(scans, arguments.depth);
  return results;
}

DeviceArray member_of(const Results& results, std::size_t offset, dlpack::TypeCode code) {
  constexpr std::int64_t kElementsPerHit = sizeof(Hit) / sizeof(float);
  const DeviceHits& hits = results->hits;
  DeviceArray array;
  array.keep = results;
  array.data = reinterpret_cast<const std::byte*>(hits.hits) + offset;
  array.device = hits.device;
  array.type = {code, 32, 1};
  array.shape = {static_cast<std::int64_t>(hits.scans),
                 static_cast<std::int64_t>(hits.rays_per_scan)};
  if (results->depth > 1) array.shape.push_back(results->depth);
  array.strides.assign(array.shape.size(), kElementsPerHit);
  for (std::size_t axis = array.shape.size() - 1; axis > 0; --axis)
    array.strides[axis - 1] = array.strides[axis] * array.shape[axis];
  array.wait = [hits] { wait_for(hits); };
  return array;
}

}  // namespace

void add_device_results(SceneClass& type) {
  py::class_<DeviceResults, Results>(type, "DeviceHits", kHitsDoc)
      .def_property_readonly(
          "ranges",
          [](const Results& r) {
            return member_of(r, offsetof(Hit, t), dlpack::TypeCode::floating);
          },
          "float32, m; inf for rays that hit nothing.")
      .def_property_readonly(
          "primitives",
          [](const Results& r) {
            return member_of(r, offsetof(Hit, primitive), dlpack::TypeCode::unsigned_integer);
          },
          "uint32: index of the splat or triangle; NO_PRIMITIVE for rays that hit nothing.");
  type.def("cast_on_device", &cast_on_device, py::arg("sensor"), py::arg("poses"),
           documented<DeviceArguments>("cast_on_device", "self, sensor, poses", kDeviceResultsDoc)
               .c_str());
}

}  // namespace adasplats::python
