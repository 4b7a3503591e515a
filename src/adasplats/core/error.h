// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace adasplats {

/// Kinds of errors, one for each exit code of sysexits(3) that the program uses.
enum class ErrorKind : std::uint8_t {
  usage,          ///< 64: wrong arguments or parameters
  data,           ///< 65: invalid content of an input
  no_input,       ///< 66: an input is missing or cannot be opened
  unavailable,    ///< 69: a required program, library or resource is missing
  software,       ///< 70: a bug in this software
  cannot_create,  ///< 73: an output cannot be created
  io,             ///< 74: reading or writing failed
  config,         ///< 78: invalid configuration file
};

/// The exit code of sysexits(3) for a kind of error.
int exit_code(ErrorKind kind);

/// An error that a user can cause or fix. what() is one sentence without a final full stop; it
/// names the file, position, field, and the found and expected values, where these exist. Bugs are
/// asserts or std::logic_error instead.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// A position in a file.
struct FilePosition {
  std::filesystem::path file;
  std::optional<std::uint64_t> byte_offset;
  std::optional<std::uint64_t> line;  ///< from 1
};

/// "FILE:LINE: MESSAGE" or "FILE: byte OFFSET: MESSAGE" as an ErrorKind::data error.
Error data_error(const FilePosition& place, const std::string& message);

/// An error of the given kind with strerror(errno_value) appended: "FILE: MESSAGE: No space left".
Error system_error(ErrorKind kind, const std::filesystem::path& file, const std::string& message,
                   int errno_value);

/// The candidates that the user may have meant by `word`: the nearest by edit distance; if none is
/// close, those that contain it, shortest first, such as "velodyne-vlp-16" for "vlp-16" (only
/// letters and digits count, in any case). None if more than six contain it: too ambiguous.
std::vector<std::string> similar_words(const std::string& word,
                                       const std::vector<std::string>& candidates);

/// The first of similar_words(), or nothing: for "unknown option 'radus', did you mean 'radius'?".
std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& candidates);

/// ", did you mean 'x'?" or ", did you mean 'x', 'y' or 'z'?" of similar_words(); "" for none.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// "unknown WHAT 'x', did you mean 'y'?", or with a list of all known words.
std::string unknown_word(const std::string& what, const std::string& word,
                         const std::vector<std::string>& known);

}  // namespace adasplats
