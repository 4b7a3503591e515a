// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "adasplats/core/error.h"
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

constexpr const char* kLimitDoc =
    R"(Limits the memory of a GPU that this process takes from now on, in GB (10^9 bytes), besides
half a gigabyte for CUDA; 0: no limit. What exceeds it raises UnavailableError, as on a GPU with no
more memory. Errors: UnavailableError without a GPU.)";

void limit_memory(double gigabytes, int gpu) {
  if (!(gigabytes >= 0 && gigabytes <= 1e6))
    throw Error(ErrorKind::usage, "gigabytes must be from 0 to 1000000");
  const GpuSearch search = find_gpus();
  if (search.devices.empty()) throw Error(ErrorKind::unavailable, search.reason);
  if (std::ranges::find(search.devices, gpu, &GpuDevice::index) == search.devices.end())
    throw Error(ErrorKind::usage, "there is no GPU " + std::to_string(gpu));
  limit_gpu_memory(gpu, static_cast<std::size_t>(gigabytes * 1e9));
}

}  // namespace

void bind_devices(py::module_& module) {
  module.def("devices", &devices, documented("devices", "", kDevicesDoc).c_str());
  module.def(
      "why_no_gpu", [] { return find_gpus().reason; },
      documented("why_no_gpu", "",
                 "Why no GPU is usable and what to do about it; empty if one is usable.")
          .c_str());
  module.def("limit_gpu_memory", &limit_memory, py::arg("gigabytes"), py::arg("gpu") = 0,
             documented("limit_gpu_memory", "gigabytes, gpu=0", kLimitDoc).c_str());
}

}  // namespace adasplats::python
