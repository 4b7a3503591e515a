// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>

#include "adasplats/core/error.h"
#include "adasplats/gpu/simulate/gpu_scene.h"
#include "dlpack.h"
#include "scenes.h"
#include "sensors.h"

namespace adasplats::python {
namespace {

constexpr const char* kDeviceResultsDoc =
    "Cast the rays of a LiDAR at poses and leave the hits in GPU memory.\n\n"
    "sensor, poses, motion, rolling_shutter: as simulate() takes them. depth: hits a ray. Without\n"
    "noise, returns and attributes; several GPUs: the first casts. Raises RuntimeError where the\n"
    "scene is on the CPU.";

constexpr const char* kHitsDoc =
    "Hits in GPU memory, made by Scene.cast_on_device(): (scans, firings), or (scans, firings,\n"
    "depth) for a depth above 1.";

constexpr const char* kArrayDoc =
    "An array in GPU memory that other libraries read without a copy through DLPack:\n"
    "torch.from_dlpack(array), cupy.from_dlpack(array). It lives as long as anyone looks at it.";

/// Hits and what they live in; may be freed without the GIL.
struct DeviceResults {
  std::shared_ptr<SceneObject> scene;
  std::unique_ptr<GpuScanner> scanner;
  DeviceHits hits;
  int depth = 1;

  ~DeviceResults() {
    // Who holds the lock may wait for the GIL.
    std::optional<py::gil_scoped_release> released;
    if (PyGILState_Check() == 1) released.emplace();
    const std::scoped_lock lock(scene->gpu);
    scanner.reset();
  }
};

using Results = std::shared_ptr<DeviceResults>;

/// One member of the hits.
struct DeviceArray {
  Results results;
  std::size_t offset = 0;  ///< of the member in a Hit, bytes
  dlpack::DataType type;

  std::vector<std::int64_t> shape() const {
    const DeviceHits& hits = results->hits;
    std::vector<std::int64_t> all = {static_cast<std::int64_t>(hits.scans),
                                     static_cast<std::int64_t>(hits.rays_per_scan)};
    if (results->depth > 1) all.push_back(results->depth);
    return all;
  }
};

/// What a consumer holds.
struct Exported {
  dlpack::ManagedTensor managed;
  DeviceArray array;
  std::vector<std::int64_t> shape;
  std::vector<std::int64_t> strides;
};

void free_exported(dlpack::ManagedTensor* managed) {
  delete static_cast<Exported*>(managed->owner);
}

/// Frees what no consumer took.
void free_capsule(PyObject* capsule) {
  if (PyCapsule_IsValid(capsule, dlpack::kFresh) == 0) return;
  auto* managed =
      static_cast<dlpack::ManagedTensor*>(PyCapsule_GetPointer(capsule, dlpack::kFresh));
  managed->deleter(managed);
}

constexpr std::int64_t kElementsPerHit = sizeof(Hit) / sizeof(float);

dlpack::ManagedTensor* exported(const DeviceArray& array) {
  auto made = std::make_unique<Exported>();
  made->array = array;
  made->shape = array.shape();
  made->strides.assign(made->shape.size(), kElementsPerHit);
  for (std::size_t axis = made->shape.size() - 1; axis > 0; --axis)
    made->strides[axis - 1] = made->strides[axis] * made->shape[axis];
  dlpack::Tensor& tensor = made->managed.tensor;
  // DLPack has no const: consumers are asked not to write.
  tensor.data = const_cast<Hit*>(array.results->hits.hits);
  tensor.device = {dlpack::DeviceType::cuda, array.results->hits.device};
  tensor.axes = static_cast<std::int32_t>(made->shape.size());
  tensor.type = array.type;
  tensor.shape = made->shape.data();
  tensor.strides = made->strides.data();
  tensor.byte_offset = array.offset;
  made->managed.deleter = &free_exported;
  made->managed.owner = made.get();
  return &made.release()->managed;
}

/// `stream` is the consumer's: the hits are complete before this returns, for every stream.
py::object to_dlpack(const DeviceArray& array, const py::object& /*stream*/) {
  {
    const py::gil_scoped_release released;
    wait_for(array.results->hits);
  }
  dlpack::ManagedTensor* const managed = exported(array);
  PyObject* const capsule = PyCapsule_New(managed, dlpack::kFresh, &free_capsule);
  if (capsule == nullptr) {
    managed->deleter(managed);
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::object>(capsule);
}

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
  Keywords keywords("cast_on_device", kwargs);
  DeviceArguments arguments;
  arguments.take(keywords);
  keywords.finish();
  if (arguments.depth < 1 || arguments.depth > kMostDepth)
    throw py::value_error("depth must be 1 to " + std::to_string(kMostDepth));
  const GpuScene* const gpu = object->scene->gpu();
  if (gpu == nullptr)
    throw Error(ErrorKind::unavailable,
                "the scene is on the CPU: results in GPU memory need Scene(..., device='cuda')");
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
  return {results, offset, {code, 32, 1}};
}

}  // namespace

void add_device_results(SceneClass& type) {
  py::class_<DeviceArray>(type, "DeviceArray", kArrayDoc)
      .def("__dlpack__", &to_dlpack, py::kw_only(), py::arg("stream") = py::none(),
           "A capsule with the array; its values are there when this returns.")
      .def(
          "__dlpack_device__",
          [](const DeviceArray& array) {
            return py::make_tuple(static_cast<int>(dlpack::DeviceType::cuda),
                                  array.results->hits.device);
          },
          "(2, number of the GPU).")
      .def_property_readonly(
          "shape", [](const DeviceArray& array) { return py::tuple(py::cast(array.shape())); },
          "As NumPy has it.")
      .def_property_readonly(
          "pointer",
          [](const DeviceArray& array) {
            return reinterpret_cast<std::uintptr_t>(array.results->hits.hits) + array.offset;
          },
          "Address of the first element in GPU memory.");
  py::class_<DeviceResults, Results>(type, "DeviceHits", kHitsDoc)
      .def_property_readonly(
          "ranges",
          [](const Results& r) {
            return member_of(r, offsetof(Hit, t), dlpack::TypeCode::floating);
          },
          "float32, m; inf where nothing is hit.")
      .def_property_readonly(
          "primitives",
          [](const Results& r) {
            return member_of(r, offsetof(Hit, primitive), dlpack::TypeCode::unsigned_integer);
          },
          "uint32; NO_PRIMITIVE where nothing is hit.");
  const std::string doc = documented(
      "cast_on_device", "self, sensor, poses",
      [](Keywords& keywords) {
        DeviceArguments arguments;
        arguments.take(keywords);
      },
      kDeviceResultsDoc);
  type.def("cast_on_device", &cast_on_device, py::arg("sensor"), py::arg("poses"), doc.c_str());
}

}  // namespace adasplats::python
