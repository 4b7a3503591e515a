// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/sensors/lidar_model.h"
#include "bindings.h"

namespace adasplats::python {

/// A Python Sensor, or load_lidar_model() of a name or a path. Errors: TypeError.
LidarModel sensor_of(py::handle value);

}  // namespace adasplats::python
