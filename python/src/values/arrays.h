// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats::python {

namespace py = pybind11;

/// Name of the Python type of a value, for messages.
std::string type_name(py::handle value);

/// A read-only array over memory that `owner` keeps alive: no copy.
py::array array_view(const py::dtype& type, const void* data, std::vector<py::ssize_t> shape,
                     std::vector<py::ssize_t> strides, py::handle owner);

/// The element type of an array of T: the underlying type of an enum.
template <class T, bool is_enum = std::is_enum_v<T>>
struct NumberOf {
  using type = T;
};
template <class T>
struct NumberOf<T, true> : std::underlying_type<T> {};
template <class T>
using Number = typename NumberOf<T>::type;

/// "(N,) uint16, ": the beginning of the docstring of an array of T.
template <class T>
std::string shape_and_type() {
  if constexpr (std::is_same_v<T, Vec3f>)
    return "(N, 3) float32, ";
  else
    return "(N,) " + std::string(py::str(py::dtype::of<Number<T>>())) + ", ";
}

/// Shape (N,); enums become numbers.
template <class T>
py::array array_view(std::span<const T> values, py::handle owner) {
  return array_view(py::dtype::of<Number<T>>(), values.data(),
                    {static_cast<py::ssize_t>(values.size())},
                    {static_cast<py::ssize_t>(sizeof(T))}, owner);
}
template <class T>
py::array array_view(const std::vector<T>& values, py::handle owner) {
  return array_view(std::span<const T>(values), owner);
}
/// Shape (N, 3).
py::array array_view(const std::vector<Vec3f>& values, py::handle owner);
/// Shape (N, 3) of the vectors at `first`, `stride` bytes apart.
py::array vectors_view(const Vec3f* first, std::size_t count, std::size_t stride, py::handle owner);

/// An optional attribute of `count` elements: None if it is missing (empty although count > 0).
template <class T>
py::object optional_view(const std::vector<T>& values, std::size_t count, py::handle owner) {
  if (values.empty() && count > 0) return py::none();
  return array_view(values, owner);
}

/// The getter of a read-only view of a vector member of T.
template <class T, class Vector>
auto view_getter(Vector T::*member) {
  return
      [member](const py::object& self) { return array_view(self.cast<const T&>().*member, self); };
}

/// An array of shape (N,) or (N, K) that owns `values`.
template <class T>
py::array owned_array(std::vector<T>&& values, std::vector<py::ssize_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array(py::dtype::of<T>(), std::move(shape), kept->data(), owner);
}

/// Rows of `columns` numbers of an array argument, read in the caller's memory: float32 and float64
/// arrays with any strides are not copied; other numbers are converted to float64 once. Keeps the
/// array alive.
class Rows {
 public:
  /// Shape (N, columns), or (columns,) for one row, or (0,) for none. Errors: TypeError (no
  /// numbers), ValueError (another shape); both name the argument.
  Rows(py::handle value, py::ssize_t columns, const char* name);

  std::size_t size() const { return count_; }
  /// Whether the argument has shape (columns,).
  bool is_single() const { return is_single_; }
  bool is_float32() const { return is_float32_; }
  double at(std::size_t row, std::size_t column) const {
    const std::byte* p = data_ + static_cast<std::ptrdiff_t>(row) * row_stride_ +
                         static_cast<std::ptrdiff_t>(column) * column_stride_;
    return is_float32_ ? read<float>(p) : read<double>(p);
  }
  Vec3d vector(std::size_t row) const { return {at(row, 0), at(row, 1), at(row, 2)}; }
  /// Index of the first row that is not finite, or size().
  std::size_t first_not_finite() const;
  /// Errors: ValueError with the index of that row.
  void require_finite() const;

 private:
  template <class T>
  static double read(const std::byte* p) {
    T value;
    __builtin_memcpy(&value, p, sizeof(T));  // NumPy arrays may be unaligned
    return value;
  }

  std::string name_;
  py::array array_;
  const std::byte* data_ = nullptr;
  std::size_t count_ = 0;
  std::size_t columns_ = 0;
  std::ptrdiff_t row_stride_ = 0;
  std::ptrdiff_t column_stride_ = 0;
  bool is_single_ = false;
  bool is_float32_ = false;
};

/// One vector of three finite numbers.
Vec3d vector_of(py::handle value, const char* name);

/// Integers of an array argument of shape (`count`,); empty for None. Errors: TypeError (not
/// integers), ValueError (another shape; a value outside [0, `max`]).
std::vector<std::uint64_t> whole_numbers_of(py::handle value, std::size_t count, std::uint64_t max,
                                            const char* name);
template <class T>
std::vector<T> whole_numbers_of(py::handle value, std::size_t count, const char* name) {
  const std::vector<std::uint64_t> wide =
      whole_numbers_of(value, count, std::numeric_limits<T>::max(), name);
  return std::vector<T>(wide.begin(), wide.end());
}

/// Meaning of NaN in an array argument.
enum class NotANumber : bool { is_wrong, is_unknown };

/// Numbers of an array argument of shape (`count`,), finite unless `nan` allows NaN; empty for
/// None. Errors: TypeError (no numbers), ValueError (another shape; not finite).
std::vector<double> numbers_of(py::handle value, std::size_t count, const char* name,
                               NotANumber nan = NotANumber::is_wrong);

/// Rigid transforms of an array argument of shape (N, 4, 4), or (4, 4) for one. Rotations are made
/// orthonormal. Errors: TypeError, ValueError (shape; not finite; a last row that is not 0 0 0 1; a
/// rotation not orthonormal to 1e-3).
std::vector<RigidTransform> transforms_of(py::handle value, const char* name);
/// Shape (N, 4, 4).
py::array_t<double> matrices_of(std::span<const RigidTransform> transforms);
/// Shape (4, 4).
py::array matrix_of(const RigidTransform& transform);
/// Shape (3,).
py::array_t<double> array_of(Vec3d vector);

}  // namespace adasplats::python
