// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/cloud/poses/trajectory.h"
#include "arrays.h"

namespace adasplats::python {

/// A Python Trajectory, or an array of world_from_sensor (N, 4, 4) or (4, 4) whose poses are
/// 0.1 s apart. Errors: TypeError, ValueError.
Trajectory trajectory_of(py::handle value, const char* name);

/// A Python Trajectory.
py::object trajectory_object(Trajectory poses);

}  // namespace adasplats::python
