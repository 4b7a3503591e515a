// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// An element of the top-level array of a JSON file. Errors of all functions: data with the file
/// and the row.
class JsonRow {
 public:
  JsonRow(const std::filesystem::path& file, std::size_t number, const nlohmann::json& value)
      : file_(&file), number_(number), value_(&value) {}

  std::size_t number() const { return number_; }  ///< from 0
  /// A member, if the element is an object.
  std::string text(const char* key) const;
  double real(const char* key) const;
  std::int64_t integer(const char* key) const;
  bool boolean(const char* key) const;
  bool has(const char* key) const;
  JsonRow object(const char* key) const;
  /// The value, if the element is a finite number.
  double real() const;
  /// The numbers of an array of three.
  std::array<double, 3> triple(const char* key) const;
  /// A matrix from an array of three arrays of three numbers, by rows.
  std::array<double, 9> matrix(const char* key) const;
  /// A pose from an array of three numbers and a quaternion w, x, y, z.
  RigidTransform pose(const char* translation, const char* rotation) const;
  /// The rotation of a quaternion with length 1 to a thousandth.
  Mat3d rotation(const std::array<double, 4>& wxyz, const char* key) const;

  Error fault(const std::string& what) const;

 private:
  const nlohmann::json& member(const char* key) const;
  template <std::size_t kCount>
  std::array<double, kCount> reals(const char* key) const;

  const std::filesystem::path* file_;
  std::size_t number_;
  const nlohmann::json* value_;
};

/// Calls visit for each element of the top-level array of a JSON file. Memory: one element, of at
/// most 100,000 values. Errors: no_input, io, data (invalid JSON, with the byte; not an array).
void for_each_json_row(const std::filesystem::path& file,
                       const std::function<void(const JsonRow&)>& visit);

/// Calls visit(key, text) for a file that is an object of texts: {"1": "Smoke", ...}.
void for_each_json_text(const std::filesystem::path& file,
                        const std::function<void(const std::string&, const std::string&)>& visit);

}  // namespace adasplats
