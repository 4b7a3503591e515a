// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

/// The number of a value of a pickle. (Values may contain themselves.)
using PickleRef = std::uint32_t;

enum class PickleKind : std::uint8_t {
  none,
  boolean,
  integer,
  real,
  text,
  bytes,
  sequence,    ///< a tuple or a list
  dictionary,  ///< key, value, key, value, ...
  global,      ///< a class or a function by its name
  object,      ///< result of a global: the global, its arguments, and an optional state
};

struct PickleValue {
  PickleKind kind = PickleKind::none;
  std::int64_t integer = 0;  ///< of booleans, too
  double real = 0;
  std::string_view text;         ///< of texts and bytes: a view of the pickle
  std::string name;              ///< of globals: "numpy.ndarray"
  std::vector<PickleRef> items;  ///< of sequences, dictionaries and objects
};

/// The values of a pickle of a data frame, protocols 2 to 5 ("pickletools.py" of Python), without
/// executing it: calls become objects with the name of the global. Opcodes and globals that pandas
/// data frames do not use are errors, so that a pickle with other code is rejected.
class PickledValues {
 public:
  /// `file` is for messages. Memory: the bytes and at most 200 MB, for a million opcodes. Errors:
  /// data with the byte (truncated, damaged, not a data frame, more than a million opcodes).
  PickledValues(std::filesystem::path file, std::string bytes);

  const PickleValue& root() const { return values_[root_]; }
  const PickleValue& operator[](PickleRef ref) const { return values_[ref]; }
  /// The value of a key, among the first thousand of a dictionary; null if there is none.
  const PickleValue* find(const PickleValue& dictionary, std::string_view key) const;
  const std::filesystem::path& file() const { return file_; }
  std::size_t size_bytes() const { return bytes_.size(); }

 private:
  friend class PickleMachine;

  std::filesystem::path file_;
  std::string bytes_;
  std::vector<PickleValue> values_;
  PickleRef root_ = 0;
};

}  // namespace adasplats
