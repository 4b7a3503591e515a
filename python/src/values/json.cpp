// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

namespace adasplats::python {
namespace {

py::object number_of(const nlohmann::ordered_json& json) {
  if (json.is_number_unsigned()) return py::int_(json.get<std::uint64_t>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  const double number = json.get<double>();
  return std::isfinite(number) ? py::object(py::float_(number)) : py::object(py::none());
}

}  // namespace

py::object python_of(const nlohmann::ordered_json& json) {
  if (json.is_object()) {
    py::dict values;
    for (const auto& [key, value] : json.items()) values[py::str(key)] = python_of(value);
    return values;
  }
  if (json.is_array()) {
    py::list values;
    for (const auto& value : json) values.append(python_of(value));
    return values;
  }
  if (json.is_string()) return py::str(json.get<std::string>());
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  return json.is_number() ? number_of(json) : py::object(py::none());
}

}  // namespace adasplats::python
