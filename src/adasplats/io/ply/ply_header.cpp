// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

struct TypeWord {
  std::string_view word;
  ColumnType type;
};

constexpr std::array<TypeWord, 18> kTypeWords = {{{"char", ColumnType::i8},
                                                  {"int8", ColumnType::i8},
                                                  {"uchar", ColumnType::u8},
                                                  {"uint8", ColumnType::u8},
                                                  {"short", ColumnType::i16},
                                                  {"int16", ColumnType::i16},
                                                  {"ushort", ColumnType::u16},
                                                  {"uint16", ColumnType::u16},
                                                  {"int", ColumnType::i32},
                                                  {"int32", ColumnType::i32},
                                                  {"uint", ColumnType::u32},
                                                  {"uint32", ColumnType::u32},
                                                  {"int64", ColumnType::i64},
                                                  {"uint64", ColumnType::u64},
                                                  {"float", ColumnType::f32},
                                                  {"float32", ColumnType::f32},
                                                  {"double", ColumnType::f64},
                                                  {"float64", ColumnType::f64}}};

/// Builds the header line by line; the methods parse the rest of a line after its first word.
class PlyHeaderParser {
 public:
  explicit PlyHeaderParser(LineReader& lines) : lines_(lines) {}

  PlyHeader parse() {
    const std::optional<std::string_view> magic = lines_.next();
    if (!magic || BlankTokens(*magic).next() != "ply")
      throw lines_.error_here("found " + shown(magic.value_or("")) + ", a PLY file begins 'ply'");
    while (true) {
      const std::optional<std::string_view> line = lines_.next();
      if (!line) throw lines_.error_here("the file ends within the header, no 'end_header'");
      BlankTokens tokens(*line);
      const std::string_view keyword = tokens.next();
      if (keyword == "end_header") break;
      if (!keyword.empty()) take(keyword, tokens);
    }
    if (!has_format_) throw lines_.error_here("the header has no 'format' line");
    return std::move(header_);
  }

 private:
  void take(std::string_view keyword, BlankTokens tokens) {
    if (keyword == "comment" || keyword == "obj_info") {
      header_.comments.emplace_back(tokens.rest());
    } else if (keyword == "format") {
      take_format(tokens);
    } else if (keyword == "element") {
      take_element(tokens);
    } else if (keyword == "property") {
      take_property(tokens);
    } else {
      throw lines_.error_here("found " + shown(keyword) +
                              " in the header, expected format, comment, obj_info, element, "
                              "property or end_header");
    }
  }

  void take_format(BlankTokens tokens) {
    const std::string_view encoding = tokens.next();
    const std::string_view version = tokens.next();
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::ascii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::little_endian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::big_endian;
    } else {
      throw lines_.error_here("format: found " + shown(encoding) +
                              ", expected ascii, binary_little_endian or binary_big_endian");
    }
    if (version != "1.0")
      throw lines_.error_here("format: found version " + shown(version) + ", expected 1.0");
    has_format_ = true;
  }

  void take_element(BlankTokens tokens) {
    PlyElement element;
    element.name = tokens.next();
    const std::string_view count = tokens.next();
    const auto [stop, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || error != std::errc() || stop != count.data() + count.size()) {
      throw lines_.error_here("element " + element.name + ": found the count " + shown(count) +
                              ", expected a whole number of at least 0");
    }
    if (header_.find(element.name) != nullptr)
      throw lines_.error_here("element " + element.name + " is declared twice");
    header_.elements.push_back(std::move(element));
  }

  void take_property(BlankTokens tokens) {
    if (header_.elements.empty())
      throw lines_.error_here("found a property before the first element");
    PlyProperty property;
    std::string_view word = tokens.next();
    if (word == "list") {
      property.is_list = true;
      property.count_type = take_type(tokens.next());
      if (property.count_type == ColumnType::f32 || property.count_type == ColumnType::f64)
        throw lines_.error_here("a list's length cannot be a real number");
      word = tokens.next();
    }
    property.type = take_type(word);
    property.name = tokens.next();
    if (property.name.empty()) throw lines_.error_here("found a property without a name");
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    if (std::any_of(properties.begin(), properties.end(),
                    [&](const PlyProperty& other) { return other.name == property.name; }))
      throw lines_.error_here("property " + shown(property.name) + " is declared twice");
    properties.push_back(std::move(property));
  }

  ColumnType take_type(std::string_view word) const {
    for (const TypeWord& known : kTypeWords)
      if (known.word == word) return known.type;
    throw lines_.error_here("property: found the type " + shown(word) +
                            ", expected char, uchar, short, ushort, int, uint, float or double");
  }

  LineReader& lines_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

std::size_t PlyElement::min_record_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += type_bytes(property.is_list ? property.count_type : property.type);
  return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [element](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(LineReader& lines) { return PlyHeaderParser(lines).parse(); }

}  // namespace adasplats
