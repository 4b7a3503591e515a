// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/input_file.h"

namespace adasplats {

/// Reads lines of a text, or of a binary file's header, that end in LF, CR LF or (if the first line
/// does) a lone CR. Leaves `file` at the first byte after the line, so that a binary body may begin
/// with a newline.
class LineReader {
 public:
  /// Recognises the line ends from the first line. `file` must outlive the reader.
  explicit LineReader(InputFile& file);

  /// The next line without its end; nothing at the end of the file. The view is valid until the
  /// next call. Errors: data (a line of more than 16 MiB: not a text).
  std::optional<std::string_view> next();
  /// The next line that is not blank.
  std::optional<std::string_view> next_filled();

  std::uint64_t line() const { return line_; }  ///< number of the line last returned, from 1
  /// A data error at the line last returned.
  Error error_here(const std::string& message) const;

 private:
  InputFile& file_;
  char line_end_ = '\n';
  std::uint64_t line_ = 0;
};

/// Splits a line at blanks and tabs.
class BlankTokens {
 public:
  explicit BlankTokens(std::string_view text) : text_(text) {}
  /// The next token, empty at the end.
  std::string_view next() {
    std::size_t begin = 0;
    while (begin < text_.size() && is_blank(text_[begin])) ++begin;
    std::size_t end = begin;
    while (end < text_.size() && !is_blank(text_[end])) ++end;
    const std::string_view token = text_.substr(begin, end - begin);
    text_.remove_prefix(end);
    return token;
  }
  /// The text after the last token, without blanks around it.
  std::string_view rest() const;

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  std::string_view text_;
};

/// All tokens of a line, split at blanks and tabs.
std::vector<std::string_view> split_blanks(std::string_view text);

}  // namespace adasplats
