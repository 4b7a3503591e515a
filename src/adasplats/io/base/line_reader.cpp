// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/line_reader.h"

#include <algorithm>

namespace adasplats {
namespace {

constexpr std::size_t kLongestLineBytes = std::size_t{16} << 20;

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

LineReader::LineReader(InputFile& file) : file_(file) {
  const std::string_view text =
      as_text(file.peek(static_cast<std::size_t>(std::min<std::uint64_t>(2, file.remaining()))));
  const std::size_t end = text.find_first_of("\r\n");
  if (end != std::string_view::npos && text.substr(end).starts_with('\r') &&
      !text.substr(end).starts_with("\r\n"))
    line_end_ = '\r';
}

std::optional<std::string_view> LineReader::next() {
  if (file_.remaining() == 0) return std::nullopt;
  ++line_;
  std::string_view text = as_text(file_.peek(1));
  std::size_t end = text.find(line_end_);
  while (end == std::string_view::npos && text.size() < file_.remaining()) {
    const std::size_t searched = text.size();
    if (searched > kLongestLineBytes)
      throw error_here("a line of more than 16 MiB: this is not a text");
    text = as_text(file_.peek(
        static_cast<std::size_t>(std::min<std::uint64_t>(file_.remaining(), 2 * searched))));
    end = text.find(line_end_, searched);
  }
  const bool ended = end != std::string_view::npos;
  std::string_view line = text.substr(0, end);
  file_.skip(line.size() + (ended ? 1 : 0));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::optional<std::string_view> LineReader::next_filled() {
  while (true) {
    const std::optional<std::string_view> line = next();
    if (!line || !BlankTokens(*line).next().empty()) return line;
  }
}

Error LineReader::error_here(const std::string& message) const {
  return data_error({file_.path(), {}, line_}, message);
}

std::string_view BlankTokens::rest() const {
  std::string_view rest = text_;
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

std::vector<std::string_view> split_blanks(std::string_view text) {
  std::vector<std::string_view> parts;
  BlankTokens tokens(text);
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next())
    parts.push_back(token);
  return parts;
}

}  // namespace adasplats
