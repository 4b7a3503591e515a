// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pcd/pcd_header.h"

#include <array>
#include <limits>
#include <optional>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

// The largest descriptors have some thousand values for a point.
constexpr std::uint64_t kMaxValues = 65536;

ColumnType pcd_type(const LineReader& lines, char type, std::size_t bytes) {
  if (type == 'F' && bytes == 4) return ColumnType::f32;
  if (type == 'F' && bytes == 8) return ColumnType::f64;
  if (type == 'I' && bytes == 1) return ColumnType::i8;
  if (type == 'I' && bytes == 2) return ColumnType::i16;
  if (type == 'I' && bytes == 4) return ColumnType::i32;
  if (type == 'I' && bytes == 8) return ColumnType::i64;
  if (type == 'U' && bytes == 1) return ColumnType::u8;
  if (type == 'U' && bytes == 2) return ColumnType::u16;
  if (type == 'U' && bytes == 4) return ColumnType::u32;
  if (type == 'U' && bytes == 8) return ColumnType::u64;
  throw lines.error_here("TYPE " + std::string(1, type) + " with SIZE " + std::to_string(bytes) +
                         " does not exist, expected F 4 or 8, I or U 1, 2, 4 or 8");
}

/// Collects the header's lines, then checks that they agree.
class PcdHeaderParser {
 public:
  explicit PcdHeaderParser(LineReader& lines) : lines_(lines) {}

  PcdHeader parse() {
    while (true) {
      const std::optional<std::string_view> line = lines_.next_filled();
      if (!line) throw lines_.error_here("the file ends within the header, no DATA line");
      if (line->starts_with('#')) {
        BlankTokens comment(line->substr(1));
        header_.comments.emplace_back(comment.rest());
        continue;
      }
      BlankTokens tokens(*line);
      const std::string_view keyword = tokens.next();
      take(keyword, tokens);
      if (keyword == "DATA") break;
    }
    check_points();
    build_fields();
    return std::move(header_);
  }

 private:
  void take(std::string_view keyword, BlankTokens tokens) {
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      for (const std::string_view name : split_blanks(tokens.rest())) names_.emplace_back(name);
    } else if (keyword == "SIZE") {
      sizes_ = take_numbers(keyword, tokens, 1, 8);
    } else if (keyword == "TYPE") {
      for (const std::string_view word : split_blanks(tokens.rest())) take_type(word);
    } else if (keyword == "COUNT") {
      counts_ = take_numbers(keyword, tokens, 0, kMaxValues);
    } else if (keyword == "WIDTH") {
      width_ = take_number(keyword, tokens);
    } else if (keyword == "HEIGHT") {
      height_ = take_number(keyword, tokens);
    } else if (keyword == "POINTS") {
      points_ = take_number(keyword, tokens);
    } else if (keyword == "VIEWPOINT") {
      header_.comments.push_back("VIEWPOINT " + std::string(tokens.rest()));
    } else if (keyword == "DATA") {
      take_encoding(tokens.rest());
    } else if (keyword != "VERSION") {
      throw lines_.error_here("found " + shown(keyword) +
                              " in the header, expected VERSION, FIELDS, SIZE, TYPE, COUNT, "
                              "WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA");
    }
  }

  std::uint64_t to_number(std::string_view keyword, std::string_view word, std::uint64_t min,
                          std::uint64_t max) const {
    const std::optional<std::uint64_t> value = parse_number<std::uint64_t>(word);
    if (value && *value >= min && *value <= max) return *value;
    throw lines_.error_here(std::string(keyword) + ": found " + shown(word) +
                            ", expected a whole number from " + std::to_string(min) + " to " +
                            std::to_string(max));
  }

  std::vector<std::uint64_t> take_numbers(std::string_view keyword, BlankTokens tokens,
                                          std::uint64_t min, std::uint64_t max) const {
    std::vector<std::uint64_t> numbers;
    for (const std::string_view word : split_blanks(tokens.rest()))
      numbers.push_back(to_number(keyword, word, min, max));
    return numbers;
  }

  std::uint64_t take_number(std::string_view keyword, BlankTokens tokens) const {
    return to_number(keyword, tokens.rest(), 0, std::numeric_limits<std::uint64_t>::max());
  }

  void take_type(std::string_view word) {
    if (word != "F" && word != "I" && word != "U")
      throw lines_.error_here("TYPE: found " + shown(word) + ", expected F, I or U");
    types_.push_back(word.front());
  }

  void take_encoding(std::string_view word) {
    if (word == "ascii") {
      header_.encoding = PcdEncoding::ascii;
    } else if (word == "binary") {
      header_.encoding = PcdEncoding::binary;
    } else if (word == "binary_compressed") {
      header_.encoding = PcdEncoding::binary_compressed;
    } else {
      throw lines_.error_here("DATA: found " + shown(word) +
                              ", expected ascii, binary or binary_compressed");
    }
  }

  void check_points() {
    if (!width_ && !points_) throw lines_.error_here("the header has neither WIDTH nor POINTS");
    if (!width_) {
      header_.points = *points_;
      return;
    }
    std::uint64_t product = 0;
    if (__builtin_mul_overflow(*width_, height_.value_or(1), &product))
      throw lines_.error_here("WIDTH " + std::to_string(*width_) + " x HEIGHT " +
                              std::to_string(height_.value_or(1)) + " is above 2^64");
    if (points_ && *points_ != product) {
      throw lines_.error_here("POINTS is " + std::to_string(*points_) + ", WIDTH x HEIGHT is " +
                              std::to_string(product));
    }
    header_.points = product;
    if (height_.value_or(1) > 1) header_.comments.push_back("HEIGHT " + std::to_string(*height_));
  }

  void build_fields() {
    if (names_.empty()) throw lines_.error_here("the header has no FIELDS");
    if (counts_.empty()) counts_.assign(names_.size(), 1);
    check_length("SIZE", sizes_.size());
    check_length("TYPE", types_.size());
    check_length("COUNT", counts_.size());
    std::uint64_t values = 0;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      const auto bytes = static_cast<std::size_t>(sizes_[k]);
      const auto count = static_cast<std::size_t>(counts_[k]);
      values += count;
      if (values > kMaxValues)
        throw lines_.error_here("more than " + std::to_string(kMaxValues) + " values a point");
      if (count == 0) continue;  // PCL writes padding so; it takes no bytes
      header_.fields.push_back({names_[k], pcd_type(lines_, types_[k], bytes), bytes, count});
    }
    if (header_.fields.empty()) throw lines_.error_here("COUNT is 0 for all FIELDS");
  }

  void check_length(std::string_view keyword, std::size_t found) const {
    if (found == names_.size()) return;
    throw lines_.error_here(std::string(keyword) + " has " + std::to_string(found) +
                            " entries, FIELDS has " + std::to_string(names_.size()));
  }

  LineReader& lines_;
  PcdHeader header_;
  std::vector<std::string> names_;
  std::vector<std::uint64_t> sizes_;
  std::vector<char> types_;
  std::vector<std::uint64_t> counts_;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

}  // namespace

std::string PcdField::value_name(std::size_t index) const {
  return count == 1 ? name : name + "_" + std::to_string(index);
}

std::size_t PcdHeader::record_bytes() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.bytes();
  return bytes;
}

PcdHeader read_pcd_header(LineReader& lines) { return PcdHeaderParser(lines).parse(); }

}  // namespace adasplats
