// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "device_arrays.h"

#include <pybind11/stl.h>

namespace adasplats::python {
namespace {

constexpr const char* kArrayDoc =
    "An array in GPU memory that other libraries read without a copy through DLPack:\n"
    "torch.from_dlpack(array), cupy.from_dlpack(array). The memory is freed with the last "
    "reference.";

/// The tensor that a consumer owns.
struct Exported {
  dlpack::ManagedTensor managed;
  DeviceArray array;
};

void free_exported(dlpack::ManagedTensor* managed) {
  delete static_cast<Exported*>(managed->owner);
}

/// Frees a tensor that no consumer took.
void free_capsule(PyObject* capsule) {
  if (PyCapsule_IsValid(capsule, dlpack::kFresh) == 0) return;
  auto* managed =
      static_cast<dlpack::ManagedTensor*>(PyCapsule_GetPointer(capsule, dlpack::kFresh));
  managed->deleter(managed);
}

dlpack::ManagedTensor* exported(const DeviceArray& array) {
  auto made = std::make_unique<Exported>();
  made->array = array;
  dlpack::Tensor& tensor = made->managed.tensor;
  // DLPack has no const; consumers must not write.
  tensor.data = const_cast<void*>(array.data);
  tensor.device = {dlpack::DeviceType::cuda, array.device};
  tensor.axes = static_cast<std::int32_t>(made->array.shape.size());
  tensor.type = array.type;
  tensor.shape = made->array.shape.data();
  tensor.strides = made->array.strides.data();
  made->managed.deleter = &free_exported;
  made->managed.owner = made.get();
  return &made.release()->managed;
}

/// `stream`: the consumer's, not needed, since the values are complete when this returns.
py::object to_dlpack(const DeviceArray& array, const py::object& /*stream*/) {
  if (array.wait) {
    const py::gil_scoped_release released;
    array.wait();
  }
  dlpack::ManagedTensor* const managed = exported(array);
  PyObject* const capsule = PyCapsule_New(managed, dlpack::kFresh, &free_capsule);
  if (capsule == nullptr) {
    managed->deleter(managed);
    throw py::error_already_set();
  }
  return py::reinterpret_steal<py::object>(capsule);
}

}  // namespace

void add_device_arrays(SceneClass& type) {
  py::class_<DeviceArray>(type, "DeviceArray", kArrayDoc)
      .def("__dlpack__", &to_dlpack, py::kw_only(), py::arg("stream") = py::none(),
           "A DLPack capsule of the array; the values are complete when this returns.")
      .def(
          "__dlpack_device__",
          [](const DeviceArray& array) {
            return py::make_tuple(static_cast<int>(dlpack::DeviceType::cuda), array.device);
          },
          "(2, index of the GPU).")
      .def_property_readonly(
          "shape", [](const DeviceArray& array) { return py::tuple(py::cast(array.shape)); },
          "Shape, as in NumPy.")
      .def_property_readonly(
          "pointer",
          [](const DeviceArray& array) { return reinterpret_cast<std::uintptr_t>(array.data); },
          "Address of the first element in GPU memory.");
}

}  // namespace adasplats::python
