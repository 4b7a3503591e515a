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

/// A value of a pickle, by its number: a pickle may hold a value in itself.
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
  object,      ///< what a global would make: the global, its arguments, and its state if one is set
};

struct PickleValue {
  PickleKind kind = PickleKind::none;
  std::int64_t integer = 0;  ///< of booleans, too
  double real = 0;
  std::string_view text;         ///< of texts and bytes: in the pickle's own bytes
  std::string name;              ///< of globals: "numpy.ndarray"
  std::vector<PickleRef> items;  ///< of sequences, dictionaries and objects
};

/// What a pickle of a data frame says, protocols 2 to 5 ("pickletools.py" of Python), without doing
/// any of it: calls become objects that name what would be called. Opcodes and globals that data
/// frames of pandas do not use are errors, so a pickle that would run something is refused.
class PickledValues {
 public:
  /// `file` is for messages. Memory: beside the bytes at most 200 MB, for a million opcodes.
  /// Errors: data with the byte (cut, damaged, not of a data frame, more than a million opcodes).
  PickledValues(std::filesystem::path file, std::string bytes);

  const PickleValue& root() const { return values_[root_]; }
  const PickleValue& operator[](PickleRef ref) const { return values_[ref]; }
  /// The value of a dictionary's key, of its first thousand; null where it has none, or is none.
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
