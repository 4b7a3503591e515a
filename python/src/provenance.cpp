// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/provenance/provenance.h"

#include <nlohmann/json.hpp>

#include "adasplats/core/executor.h"
#include "bindings.h"
#include "json.h"
#include "keywords.h"

namespace adasplats::python {
namespace {

constexpr const char* kProvenanceDoc =
    R"(Describe the build and machine of this process, as every --report does.

Returns a dict with version, commit and dirty (of the sources that the module was built from; None:
unknown), date (UTC), command, machine (cpu, cores, memory_bytes, system, compiler) and device.
threads: number of threads that the work used; 0: all.)";

}  // namespace

void bind_provenance(py::module_& module) {
  module.def(
      "provenance",
      [](int threads) {
        return python_of(to_json(provenance_of(Executor(threads).threads(), DeviceChoice())));
      },
      py::arg("threads") = 0, documented("provenance", "threads=0", kProvenanceDoc).c_str());
}

}  // namespace adasplats::python
