// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <array>
#include <cmath>
#include <cstring>

#include "adasplats/cloud/poses/rotation.h"

namespace adasplats::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void wrong_shape(const py::array& array, const std::string& expected,
                              const std::string& name) {
  throw py::value_error(name + ": expected shape " + expected + ", got " + shape_text(array));
}

/// The value as a NumPy array. Errors: TypeError if its elements are not real numbers.
py::array number_array(py::handle value, const std::string& name) {
  py::array array = py::array::ensure(value);
  if (!array) {
    throw py::type_error(name + ": expected an array of numbers, got " + type_name(value));
  }
  const char kind = array.dtype().kind();
  // NumPy makes an empty list float64; an empty array of objects is still an error.
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw py::type_error(name + ": expected an array of numbers, got dtype " +
                         std::string(py::str(array.dtype())));
  return array;
}

py::array as_float64(const py::array& array) {
  return py::array_t<double, py::array::forcecast>::ensure(array);
}

/// An element of a one-dimensional array, which may be unaligned (a field of packed records).
template <class T>
T value_at(const py::array& array, std::size_t index) {
  T value;
  std::memcpy(&value, array.data(static_cast<py::ssize_t>(index)), sizeof(T));
  return value;
}

template <class T>
bool holds(const py::array& array) {
  return py::isinstance<py::array_t<T, 0>>(array);
}

}  // namespace

std::string type_name(py::handle value) { return py::str(py::type::of(value).attr("__name__")); }

py::array array_view(const py::dtype& type, const void* data, std::vector<py::ssize_t> shape,
                     std::vector<py::ssize_t> strides, py::handle owner) {
  // Without a base, pybind11 copies the data.
  py::array array(type, std::move(shape), std::move(strides), data, owner);
  array.attr("flags").attr("writeable") = false;
  return array.attr("view")(py::module_::import("adasplats._views").attr("ArrayView"));
}

py::array array_view(const std::vector<Vec3f>& values, py::handle owner) {
  return vectors_view(values.data(), values.size(), sizeof(Vec3f), owner);
}

py::array vectors_view(const Vec3f* first, std::size_t count, std::size_t stride,
                       py::handle owner) {
  return array_view(py::dtype::of<float>(), first, {static_cast<py::ssize_t>(count), 3},
                    {static_cast<py::ssize_t>(stride), static_cast<py::ssize_t>(sizeof(float))},
                    owner);
}

Rows::Rows(py::handle value, py::ssize_t columns, const char* name)
    : name_(name), array_(number_array(value, name)), columns_(static_cast<std::size_t>(columns)) {
  const bool is_empty = array_.size() == 0;
  is_single_ = array_.ndim() == 1 && array_.shape(0) == columns;
  const bool is_rows = array_.ndim() == 2 && array_.shape(1) == columns;
  if (is_empty && array_.ndim() == 1) return;
  if (!is_single_ && !is_rows) wrong_shape(array_, "(N, " + std::to_string(columns) + ")", name_);
  is_float32_ = holds<float>(array_);
  if (!is_float32_ && !holds<double>(array_)) array_ = as_float64(array_);
  data_ = static_cast<const std::byte*>(array_.data());
  count_ = is_single_ ? 1 : static_cast<std::size_t>(array_.shape(0));
  row_stride_ = is_single_ ? 0 : array_.strides(0);
  column_stride_ = array_.strides(is_single_ ? 0 : 1);
}

std::size_t Rows::first_not_finite() const {
  for (std::size_t row = 0; row < count_; ++row)
    for (std::size_t column = 0; column < columns_; ++column)
      if (!std::isfinite(at(row, column))) return row;
  return count_;
}

void Rows::require_finite() const {
  const std::size_t row = first_not_finite();
  if (row < count_)
    throw py::value_error(name_ + ": row " + std::to_string(row) + " is not finite");
}

Vec3d vector_of(py::handle value, const char* name) {
  const Rows rows(value, 3, name);
  if (!rows.is_single())
    throw py::value_error(std::string(name) + ": expected three numbers, shape (3,)");
  rows.require_finite();
  return rows.vector(0);
}

std::vector<std::uint64_t> whole_numbers_of(py::handle value, std::size_t count, std::uint64_t max,
                                            const char* name) {
  if (value.is_none()) return {};
  const py::array given = number_array(value, name);
  if (given.ndim() != 1 || static_cast<std::size_t>(given.size()) != count)
    wrong_shape(given, "(" + std::to_string(count) + ",)", name);
  if (given.dtype().kind() == 'f' && count > 0)
    throw py::type_error(std::string(name) + ": expected whole numbers, got dtype " +
                         std::string(py::str(given.dtype())));
  const auto out_of_range = [&](std::size_t i) {
    return py::value_error(std::string(name) + "[" + std::to_string(i) + "] is not in 0 to " +
                           std::to_string(max));
  };
  std::vector<std::uint64_t> numbers(count);
  const bool is_signed = given.dtype().kind() == 'i';
  const py::array wide = is_signed ? py::array(py::array_t<std::int64_t>::ensure(given))
                                   : py::array(py::array_t<std::uint64_t>::ensure(given));
  for (std::size_t i = 0; i < count; ++i) {
    if (is_signed && value_at<std::int64_t>(wide, i) < 0) throw out_of_range(i);
    numbers[i] = value_at<std::uint64_t>(wide, i);
    if (numbers[i] > max) throw out_of_range(i);
  }
  return numbers;
}

std::vector<double> numbers_of(py::handle value, std::size_t count, const char* name,
                               NotANumber nan) {
  if (value.is_none()) return {};
  const py::array given = number_array(value, name);
  if (given.ndim() != 1 || static_cast<std::size_t>(given.size()) != count)
    wrong_shape(given, "(" + std::to_string(count) + ",)", name);
  const py::array wide = as_float64(given);
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[i] = value_at<double>(wide, i);
    if (nan == NotANumber::is_unknown && std::isnan(numbers[i])) continue;
    if (!std::isfinite(numbers[i]))
      throw py::value_error(std::string(name) + "[" + std::to_string(i) + "] is not finite");
  }
  return numbers;
}

namespace {

RigidTransform transform_of(const std::byte* matrix, std::size_t index, const std::string& name) {
  std::array<double, 16> m;
  std::memcpy(m.data(), matrix, sizeof(m));  // may be unaligned
  const auto fail = [&](const std::string& what) {
    return py::value_error(name + ": matrix " + std::to_string(index) + " " + what);
  };
  for (const double value : m)
    if (!std::isfinite(value)) throw fail("is not finite");
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw fail("does not have the last row 0 0 0 1");
  const Mat3d rotation{{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
  if (!(orthonormality_error(rotation) <= 1e-3))
    throw fail("has a rotation that is not orthonormal to 0.001");
  return {orthonormalized(rotation), {m[3], m[7], m[11]}};
}

}  // namespace

std::vector<RigidTransform> transforms_of(py::handle value, const char* name) {
  const py::array given = number_array(value, name);
  const py::ssize_t axes = given.ndim();
  if (given.size() == 0 && axes == 1) return {};
  if ((axes != 2 && axes != 3) || given.shape(axes - 1) != 4 || given.shape(axes - 2) != 4)
    wrong_shape(given, "(N, 4, 4)", name);
  const auto packed = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  std::vector<RigidTransform> transforms;
  const auto count = static_cast<std::size_t>(packed.size()) / 16;
  const auto* const bytes = static_cast<const std::byte*>(py::array(packed).data());
  for (std::size_t i = 0; i < count; ++i)
    transforms.push_back(transform_of(bytes + 16 * sizeof(double) * i, i, name));
  return transforms;
}

py::array_t<double> matrices_of(std::span<const RigidTransform> transforms) {
  py::array_t<double> matrices(
      {static_cast<py::ssize_t>(transforms.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* m = matrices.mutable_data();
  for (const RigidTransform& t : transforms) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) *m++ = t.rotation.rows[row][column];
      *m++ = t.translation[row];
    }
    for (const double last : {0.0, 0.0, 0.0, 1.0}) *m++ = last;
  }
  return matrices;
}

py::array matrix_of(const RigidTransform& transform) {
  return matrices_of(std::span(&transform, 1)).attr("reshape")(4, 4);
}

py::array_t<double> array_of(Vec3d vector) {
  py::array_t<double> array(py::ssize_t{3});
  for (int axis = 0; axis < 3; ++axis) array.mutable_at(axis) = vector[axis];
  return array;
}

}  // namespace adasplats::python
