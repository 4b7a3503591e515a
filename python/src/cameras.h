// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/sensors/camera_file.h"
#include "bindings.h"

namespace adasplats::python {

/// A Python Camera, or load_camera() of a path. Errors: TypeError.
MountedCamera camera_of(py::handle value);

}  // namespace adasplats::python
