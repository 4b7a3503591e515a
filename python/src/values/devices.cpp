// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/base/device.h"
#include "bindings.h"
#include "keywords.h"

namespace adasplats::python {
namespace {

constexpr const char* kDevicesDoc =
    R"(The usable GPUs: a list of dicts with index, name, compute (major, minor) and memory_bytes.
Empty without a GPU; why_no_gpu() gives the reason.)";

py::list devices() {
  py::list found;
  for (const GpuDevice& gpu : find_gpus().devices) {
    py::dict values;
    values["index"] = gpu.index;
    values["name"] = gpu.name;
    values["compute"] = py::make_tuple(gpu.compute_major, gpu.compute_minor);
    values["memory_bytes"] = gpu.memory_bytes;
    found.append(values);
  }
  return found;
}

}  // namespace

void bind_devices(py::module_& module) {
  module.def("devices", &devices, documented("devices", "", kDevicesDoc).c_str());
  module.def(
      "why_no_gpu", [] { return find_gpus().reason; },
      documented("why_no_gpu", "",
                 "Why no GPU is usable and what to do about it; empty if one is usable.")
          .c_str());
}

}  // namespace adasplats::python
