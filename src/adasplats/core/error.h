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

/// What went wrong, one kind for each exit code of sysexits(3) that the program uses.
enum class ErrorKind : std::uint8_t {
  usage,          ///< 64: wrong arguments or parameters
  data,           ///< 65: the content of an input is wrong
  no_input,       ///< 66: an input is missing or cannot be opened
  unavailable,    ///< 69: a program or library that the work needs is not on this machine
  software,       ///< 70: a bug of ours
  cannot_create,  ///< 73: an output cannot be created
  io,             ///< 74: reading or writing failed
  config,         ///< 78: a configuration file is wrong
};

/// The exit code of sysexits(3) for a kind of error.
int exit_code(ErrorKind kind);

/// Every error that a user can cause or mend. what() is one complete sentence fragment without a
/// final full stop; it names the file, place, field, found and expected where they are known.
/// Bugs of ours are asserts or std::logic_error instead.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// Where in a file something was found.
struct FilePlace {
  std::filesystem::path file;
  std::optional<std::uint64_t> byte_offset;
  std::optional<std::uint64_t> line;  ///< from 1
};

/// "FILE:LINE: MESSAGE" or "FILE: byte OFFSET: MESSAGE" as an ErrorKind::data error.
Error data_error(const FilePlace& place, const std::string& message);

/// An error of the given kind with strerror(errno_value) appended: "FILE: MESSAGE: No space left".
Error system_error(ErrorKind kind, const std::filesystem::path& file, const std::string& message,
                   int errno_value);

/// The candidates that `word` may stand for: the nearest by edit distance; where none is close,
/// those that contain it, shortest first, for "vlp-16" of "velodyne-vlp-16" (letters and digits
/// alone, of any case). None where more than six contain it: it says too little.
std::vector<std::string> similar_words(const std::string& word,
                                       const std::vector<std::string>& candidates);

/// The first of similar_words(), or nothing: for "unknown option 'radus', did you mean 'radius'?".
std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& candidates);

/// ", did you mean 'x'?" or ", did you mean 'x', 'y' or 'z'?" of similar_words(); "" for none.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

/// "what 'x' is not known, did you mean 'y'?" or a list of all that are known.
std::string unknown_word(const std::string& what, const std::string& word,
                         const std::vector<std::string>& known);

}  // namespace adasplats
