// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "keywords.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/core/error.h"
#include "arrays.h"

namespace adasplats::python {
namespace {

/// Whether it is an integer of Python or NumPy; bool is not one.
bool is_whole(py::handle value) {
  return !PyBool_Check(value.ptr()) && PyIndex_Check(value.ptr()) == 1;
}

bool is_number(py::handle value) {
  if (PyBool_Check(value.ptr()) || PyUnicode_Check(value.ptr())) return false;
  return PyFloat_Check(value.ptr()) || is_whole(value) ||
         (PyNumber_Check(value.ptr()) == 1 && py::hasattr(value, "__float__"));
}

double number_of(py::handle value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return number;
}

/// A default in a signature: the value, or None.
template <class T>
py::object default_of(const std::optional<T>& value) {
  return value ? py::object(py::cast(*value)) : py::none();
}

}  // namespace

Keywords::Keywords(std::string function, const py::kwargs& given)
    : function_(std::move(function)), given_(py::dict(given)) {}

std::optional<py::object> Keywords::find(const char* name, const py::object& default_value) {
  names_.emplace_back(name);
  if (!given_) {
    signature_ += std::string(", ") + name + "=" + std::string(py::repr(default_value));
    return std::nullopt;
  }
  if (!given_->contains(name)) return std::nullopt;
  return py::object((*given_)[name]);
}

void Keywords::wrong_type(const char* name, const char* expected, py::handle got) const {
  throw py::type_error(function_ + "(): " + name + " must be " + expected + ", not " +
                       type_name(got));
}

void Keywords::take(const char* name, bool& value) {
  const auto given = find(name, given_ ? py::none() : py::object(py::bool_(value)));
  if (!given) return;
  const bool is_truth = PyBool_Check(given->ptr()) || type_name(*given).starts_with("bool");
  if (!is_truth) wrong_type(name, "True or False", *given);
  value = PyObject_IsTrue(given->ptr()) == 1;
}

void Keywords::take(const char* name, int& value) {
  const auto given = find(name, given_ ? py::none() : py::object(py::int_(value)));
  if (!given) return;
  if (!is_whole(*given)) wrong_type(name, "a whole number", *given);
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given->ptr()));
  int overflow = 0;
  const long wide = PyLong_AsLongAndOverflow(number.ptr(), &overflow);
  if (overflow != 0 || wide != static_cast<int>(wide))
    throw py::value_error(function_ + "(): " + name + " is out of range");
  value = static_cast<int>(wide);
}

void Keywords::take(const char* name, std::uint64_t& value) {
  const auto given = find(name, given_ ? py::none() : py::object(py::int_(value)));
  if (!given) return;
  if (!is_whole(*given)) wrong_type(name, "a whole number", *given);
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(given->ptr()));
  value = PyLong_AsUnsignedLongLong(number.ptr());
  if (PyErr_Occurred() == nullptr) return;
  PyErr_Clear();
  throw py::value_error(function_ + "(): " + name + " must be 0 to 2^64 - 1");
}

void Keywords::take(const char* name, double& value) {
  const auto given = find(name, given_ || std::isfinite(value) ? py::object(py::float_(value))
                                                               : py::object(py::none()));
  // None means the infinite default, for which Python has no literal.
  if (!given || (given->is_none() && !std::isfinite(value))) return;
  if (!is_number(*given)) wrong_type(name, "a number", *given);
  value = number_of(*given);
}

void Keywords::take(const char* name, std::uint32_t& value) {
  std::uint64_t wide = value;
  take(name, wide);
  if (wide > std::numeric_limits<std::uint32_t>::max())
    throw py::value_error(function_ + "(): " + name + " is out of range");
  value = static_cast<std::uint32_t>(wide);
}

void Keywords::take(const char* name, float& value) {
  double number = static_cast<double>(value);
  take(name, number);
  if (std::fabs(number) > static_cast<double>(std::numeric_limits<float>::max()))
    throw py::value_error(function_ + "(): " + name + " is out of range");
  value = static_cast<float>(number);
}

void Keywords::take(const char* name, GroupScale& value) {
  Vec3d factors{value.neighbors, value.radius, value.error};
  take(name, factors);
  value = {factors.x, factors.y, factors.z};
}

void Keywords::take(const char* name, std::optional<double>& value) {
  const auto given = find(name, given_ ? py::object(py::none()) : default_of(value));
  if (!given) return;
  if (given->is_none()) return value.reset();
  if (!is_number(*given)) wrong_type(name, "a number or None", *given);
  value = number_of(*given);
}

void Keywords::take(const char* name, std::string& value) {
  const py::object absent = value.empty() ? py::object(py::none()) : py::object(py::str(value));
  const auto given = find(name, absent);
  if (!given || (given->is_none() && value.empty())) return;
  if (PyUnicode_Check(given->ptr())) {
    value = py::str(*given);
  } else if (py::hasattr(*given, "__fspath__")) {  // a name or a file
    value = py::str(given->attr("__fspath__")());
  } else {
    wrong_type(name, "a string", *given);
  }
}

void Keywords::take(const char* name, std::filesystem::path& value) {
  const auto given = find(name, py::none());
  if (!given || given->is_none()) return;
  if (!is_path(*given)) wrong_type(name, "a path", *given);
  value = path_of(*given, name);
}

void Keywords::take(const char* name, Vec3d& value) {
  const auto given = find(name, py::make_tuple(value.x, value.y, value.z));
  if (given) value = vector_of(*given, name);
}

void Keywords::take(const char* name, std::optional<Vec3d>& value) {
  const auto given = find(name, py::none());
  if (!given) return;
  if (given->is_none()) return value.reset();
  value = vector_of(*given, name);
}

void Keywords::take(const char* name, std::optional<std::uint32_t>& value) {
  const auto given = find(name, py::none());
  if (!given) return;
  if (given->is_none()) return value.reset();
  if (!is_whole(*given)) wrong_type(name, "a whole number or None", *given);
  const auto number = py::cast<std::int64_t>(*given);
  if (number < 0 || number > std::numeric_limits<std::uint32_t>::max())
    throw py::value_error(function_ + "(): " + name + " is out of range");
  value = static_cast<std::uint32_t>(number);
}

void Keywords::take(const char* name, std::optional<Extent>& value) {
  const auto given = find(name, py::none());
  if (!given) return;
  if (given->is_none()) return value.reset();
  const std::string expected =
      std::string(name) + ": expected x_min, y_min, x_max, y_max[, z_min, z_max]";
  const auto numbers =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(*given);
  if (!numbers || numbers.ndim() != 1 || (numbers.size() != 4 && numbers.size() != 6)) {
    PyErr_Clear();
    throw py::value_error(expected);
  }
  const Extent extent = extent_of({numbers.data(), static_cast<std::size_t>(numbers.size())});
  for (int axis = 0; axis < 3; ++axis)
    if (!(extent.low[axis] <= extent.high[axis])) throw py::value_error(expected);
  value = extent;
}

void Keywords::take(const char* name, std::vector<int>& value) {
  const auto given = find(name, py::none());
  if (!given || given->is_none()) return;
  value.clear();
  if (!py::isinstance<py::sequence>(*given) || PyUnicode_Check(given->ptr()))
    wrong_type(name, "a list of whole numbers", *given);
  for (const py::handle item : py::reinterpret_borrow<py::sequence>(*given)) {
    if (!is_whole(item)) wrong_type(name, "a list of whole numbers", *given);
    value.push_back(py::cast<int>(item));
  }
}

void Keywords::take(const char* name, py::object& value) {
  if (auto given = find(name, py::none())) value = std::move(*given);
}

std::size_t Keywords::take_word(const char* name, std::size_t chosen,
                                const std::vector<std::string>& known) {
  const bool has_word = chosen < known.size();
  const auto given = find(name, has_word ? py::object(py::str(known[chosen])) : py::none());
  if (!given || (given->is_none() && !has_word)) return chosen;
  if (!PyUnicode_Check(given->ptr())) wrong_type(name, "a string", *given);
  const std::string word = py::str(*given);
  const auto found = std::find(known.begin(), known.end(), word);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  std::string text = function_ + "(): " + name + " must be ";
  for (std::size_t i = 0; i < known.size(); ++i)
    text += (i == 0 ? "'" : (i + 1 == known.size() ? " or '" : ", '")) + known[i] + "'";
  throw py::value_error(text + ", not '" + word + "'" + did_you_mean(word, known));
}

void Keywords::finish() const {
  for (const auto& [key, value] : *given_) {
    const std::string name = py::str(key);
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) continue;
    throw py::type_error(function_ + "() got an unexpected keyword argument '" + name + "'" +
                         did_you_mean(name, names_));
  }
}

bool is_path(py::handle value) {
  return PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) ||
         py::hasattr(value, "__fspath__");
}

std::filesystem::path path_of(py::handle value, const char* name) {
  if (!is_path(value))
    throw py::type_error(std::string(name) + ": expected a path, got " + type_name(value));
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(value.ptr(), &bytes) == 0) throw py::error_already_set();
  return std::string(py::reinterpret_steal<py::bytes>(bytes));
}

std::vector<std::filesystem::path> paths_of(py::handle value, const char* name,
                                            const char* else_expected) {
  std::vector<std::filesystem::path> paths;
  if (is_path(value)) {
    paths.push_back(path_of(value, name));
    return paths;
  }
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value))
    throw py::type_error(std::string(name) + ": expected " + else_expected +
                         "a path or a list of paths, got " + type_name(value));
  for (const py::handle item : value) paths.push_back(path_of(item, name));
  if (paths.empty()) throw py::value_error(std::string(name) + ": expected at least one path");
  return paths;
}

std::string with_keywords(std::string_view message) {
  return with_settings_as(message, [](const std::string& name) -> std::string {
    // Keywords for loading are the keys of the settings, which include the unit.
    for (const Setting& setting : settings_of<LoadOptions>())
      if (name == setting.name) return setting.key;
    return name;
  });
}

void reject_unused(const std::vector<UnusedSetting>& unused, const py::kwargs& given) {
  for (const auto& [setting, why] : unused) {
    if (given.contains(setting.name))
      throw py::value_error(std::string(setting.name) + " has no effect " + why);
  }
}

std::string documented(const char* name, const char* signature, const char* text) {
  return std::string(name) + "(" + signature + ")\n--\n\n" + text;
}

}  // namespace adasplats::python
