// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/splats/model/mesh_model.h"
#include "adasplats/splats/model/splat_model.h"
#include "bindings.h"

namespace adasplats::python {

/// A splat model with what was reported while it was made.
struct ModelObject {
  SplatModel model;
  py::object report = py::none();
};

}  // namespace adasplats::python
