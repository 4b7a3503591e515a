// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace adasplats::python {

namespace py = pybind11;

/// Pickles, for passing objects between processes. A pickle is (class, version, fields); numbers
/// are bytes in native order. A class lists its fields once, in a function `fields(archive,
/// object)` that both reads and writes.

/// Version of all classes: raise it when the fields of any class change.
inline constexpr int kPickleVersion = 8;

/// Errors: ValueError.
[[noreturn]] void wrong_pickle(const std::string& type, const std::string& what);
/// The fields of a pickle of `type`. Errors: ValueError (another class, another version).
py::dict fields_of_pickle(const std::string& type, const py::object& pickle);

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct ElementOf {
  using Type = char;
};
template <class T>
struct ElementOf<std::vector<T>> {
  using Type = T;
};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

class FieldWriter {
 public:
  template <class T>
  void operator()(const char* name, T& value) {
    dict_[name] = packed(value);
  }
  const py::dict& dict() const { return dict_; }

 private:
  template <class T>
  static py::object packed(T& value) {
    if constexpr (std::is_base_of_v<py::object, T>) {
      return value;
    } else if constexpr (std::is_same_v<T, std::string>) {
      return py::bytes(value);  // paths need not be UTF-8
    } else if constexpr (IsVector<T>::value) {
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>) {
        return py::bytes(reinterpret_cast<const char*>(value.data()),
                         value.size() * sizeof(typename T::value_type));
      } else {
        py::list list;
        for (auto& element : value) list.append(packed(element));
        return list;
      }
    } else if constexpr (IsOptional<T>::value) {
      return value ? packed(*value) : py::none();
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      return py::bytes(reinterpret_cast<const char*>(&value), sizeof(T));
    } else {
      FieldWriter inner;
      fields(inner, value);
      return inner.dict();
    }
  }

  py::dict dict_;
};

class FieldReader {
 public:
  FieldReader(std::string type, py::dict dict) : type_(std::move(type)), dict_(std::move(dict)) {}

  template <class T>
  void operator()(const char* name, T& value) {
    if (!dict_.contains(name)) wrong_pickle(type_, std::string("has no field '") + name + "'");
    unpack(name, dict_[name], value);
  }

 private:
  std::string bytes_of(const char* name, const py::object& packed) const {
    if (!py::isinstance<py::bytes>(packed))
      wrong_pickle(type_, std::string("has a field '") + name + "' of another type");
    return std::string(py::reinterpret_borrow<py::bytes>(packed));
  }

  template <class T>
  void unpack(const char* name, const py::object& packed, T& value) {
    if constexpr (std::is_base_of_v<py::object, T>) {
      value = packed;
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = bytes_of(name, packed);
    } else if constexpr (IsVector<T>::value &&
                         !std::is_trivially_copyable_v<typename ElementOf<T>::Type>) {
      if (!py::isinstance<py::list>(packed))
        wrong_pickle(type_, std::string("has a field '") + name + "' of another type");
      value.clear();
      for (const py::handle element : py::reinterpret_borrow<py::list>(packed))
        unpack(name, py::reinterpret_borrow<py::object>(element), value.emplace_back());
    } else if constexpr (IsVector<T>::value) {
      constexpr std::size_t kSize = sizeof(typename T::value_type);
      const std::string bytes = bytes_of(name, packed);
      if (bytes.size() % kSize != 0) wrong_pickle(type_, std::string("is truncated in ") + name);
      value.resize(bytes.size() / kSize);
      if (!bytes.empty()) std::memcpy(value.data(), bytes.data(), bytes.size());
    } else if constexpr (IsOptional<T>::value) {
      if (packed.is_none()) return value.reset();
      unpack(name, packed, value.emplace());
    } else if constexpr (std::is_trivially_copyable_v<T>) {
      const std::string bytes = bytes_of(name, packed);
      if (bytes.size() != sizeof(T)) wrong_pickle(type_, std::string("is truncated in ") + name);
      std::memcpy(&value, bytes.data(), sizeof(T));
    } else {
      if (!py::isinstance<py::dict>(packed))
        wrong_pickle(type_, std::string("has a field '") + name + "' of another type");
      FieldReader inner(type_, py::reinterpret_borrow<py::dict>(packed));
      fields(inner, value);
    }
  }

  std::string type_;
  py::dict dict_;
};

/// Adds pickling and copying to a class with fields().
template <class T, class Class>
void add_pickling(Class& type, const std::string& name) {
  type.def(py::pickle(
      [name](T& value) -> py::object {
        FieldWriter writer;
        fields(writer, value);
        return py::make_tuple("adasplats." + name, kPickleVersion, writer.dict());
      },
      [name](const py::object& pickle) {
        FieldReader reader("adasplats." + name, fields_of_pickle("adasplats." + name, pickle));
        T value;
        fields(reader, value);
        return value;
      }));
}

}  // namespace adasplats::python
