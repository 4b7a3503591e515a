// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bindings.h"

namespace adasplats::python {

/// The same value as dict, list, str, int, float, bool or None; numbers that are not finite are
/// None, as they are null in a --report.
py::object python_of(const nlohmann::ordered_json& json);

}  // namespace adasplats::python
