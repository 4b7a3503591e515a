// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

#ifndef ADASPLATS_VERSION
#error "ADASPLATS_VERSION is not defined"
#endif

// NOLINTNEXTLINE(bugprone-exception-escape): pybind11 makes it an ImportError
PYBIND11_MODULE(_adasplats, module) {
  namespace py = pybind11;
  namespace bindings = adasplats::python;
  py::options options;
  options.disable_function_signatures();  // docstrings contain them
  module.attr("__version__") = ADASPLATS_VERSION;
  bindings::bind_errors(module);
  bindings::bind_devices(module);
  bindings::bind_provenance(module);
  bindings::bind_labels(module);
  bindings::bind_trajectories(module);
  bindings::bind_clouds(module);
  bindings::bind_sensors(module);
  bindings::bind_cameras(module);
  bindings::bind_segmentation(module);
  bindings::bind_models(module);
  bindings::bind_meshes(module);
  bindings::bind_scans(module);
  bindings::bind_hits(module);
  bindings::bind_scenes(module);
  bindings::bind_networks(module);
  bindings::bind_evaluate(module);
  bindings::bind_synth(module);
  bindings::bind_jobs(module);
  bindings::explain_wrong_arguments(module);
}
