// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

/// The Python module. Bindings only convert arguments and results. Each file adds one topic to the
/// module.
namespace adasplats::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_devices(py::module_& module);
void bind_provenance(py::module_& module);
void bind_labels(py::module_& module);
void bind_trajectories(py::module_& module);
void bind_clouds(py::module_& module);
void bind_sensors(py::module_& module);
void bind_cameras(py::module_& module);
void bind_segmentation(py::module_& module);
void bind_models(py::module_& module);
void bind_meshes(py::module_& module);
void bind_scans(py::module_& module);
void bind_scenes(py::module_& module);
void bind_hits(py::module_& module);
void bind_networks(py::module_& module);
void bind_evaluate(py::module_& module);
void bind_synth(py::module_& module);
void bind_jobs(py::module_& module);
/// Replaces the messages for wrong arguments of every function; called last.
void explain_wrong_arguments(const py::module_& module);

}  // namespace adasplats::python
