// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bindings.h"

namespace adasplats::python {

/// The same value as dict, list, str, int, float, bool or None. Numbers that are not finite become
/// None, as they become null in a --report.
py::object python_of(const nlohmann::ordered_json& json);

}  // namespace adasplats::python
