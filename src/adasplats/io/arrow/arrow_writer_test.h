// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: Arrow files put together by the letter of the specification.

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "adasplats/io/arrow/flat_composer.h"

namespace adasplats::arrow_test {

/// A column of one batch.
struct ArrowColumn {
  std::string name;
  std::uint8_t kind = 2;  ///< of the union Type
  std::int32_t bits = 0;  ///< of integers; of floats 0 (half), 1 or 2
  bool is_signed = false;
  std::int64_t rows = 0;
  std::vector<std::string> buffers;  ///< after that of the null values
  std::int64_t nulls = 0;
  bool is_dictionary = false;
};

template <class T>
std::string raw_bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
ArrowColumn numbers(const std::string& name, const std::vector<T>& values) {
  const bool is_float = std::is_floating_point_v<T>;
  return {name,
          static_cast<std::uint8_t>(is_float ? 3 : 2),
          is_float ? (sizeof(T) == 8 ? 2 : 1) : static_cast<std::int32_t>(8 * sizeof(T)),
          std::is_signed_v<T>,
          static_cast<std::int64_t>(values.size()),
          {raw_bytes(values)}};
}

/// Of float16 by their bits.
inline ArrowColumn halves(const std::string& name, const std::vector<std::uint16_t>& values) {
  ArrowColumn column = numbers(name, values);
  column.kind = 3;
  column.bits = 0;
  return column;
}

inline ArrowColumn texts(const std::string& name, const std::vector<std::string>& values) {
  std::vector<std::int32_t> offsets = {0};
  std::string all;
  for (const std::string& value : values) {
    all += value;
    offsets.push_back(static_cast<std::int32_t>(all.size()));
  }
  return {name, 5, 0, false, static_cast<std::int64_t>(values.size()), {raw_bytes(offsets), all}};
}

inline void add_field(FlatComposer& flat, std::size_t place, const ArrowColumn& column) {
  const std::size_t field = flat.table(place, {true, true, true, true, column.is_dictionary, true});
  flat.set(flat.field(field, 2), column.kind);
  const std::size_t type = flat.table(flat.field(field, 3), {true, true});
  flat.set(flat.field(type, 0), column.bits);
  flat.set(flat.field(type, 1), static_cast<std::uint8_t>(column.is_signed));
  if (column.is_dictionary) flat.table(flat.field(field, 4), {true});
  flat.link(flat.field(field, 0));
  flat.add(static_cast<std::uint32_t>(column.name.size()));
  flat.bytes += column.name + '\0';
  flat.link(flat.field(field, 5));
  flat.add(std::uint32_t{0});
}

inline void add_schema(FlatComposer& flat, std::size_t place,
                       const std::vector<ArrowColumn>& columns) {
  const std::size_t schema = flat.table(place, {true, true});
  flat.link(flat.field(schema, 1));
  flat.add(static_cast<std::uint32_t>(columns.size()));
  const std::size_t slots = flat.bytes.size();
  flat.bytes.resize(slots + 4 * columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k) add_field(flat, slots + 4 * k, columns[k]);
}

/// A message as it stands in a file, before its body.
inline std::string message_of(FlatComposer flat) {
  flat.align(8);
  const std::uint32_t head[] = {0xffffffff, static_cast<std::uint32_t>(flat.bytes.size())};
  return std::string(reinterpret_cast<const char*>(head), sizeof(head)) + flat.bytes;
}

inline FlatComposer message(std::uint8_t kind, std::int64_t body_bytes, std::size_t& header) {
  FlatComposer flat;
  const std::size_t root = flat.table(0, {true, true, true, true});
  flat.set(flat.field(root, 0), std::int16_t{4});
  flat.set(flat.field(root, 1), kind);
  flat.set(flat.field(root, 3), body_bytes);
  header = flat.field(root, 2);
  return flat;
}

/// The message of a batch, and its body.
inline std::pair<std::string, std::string> batch_of(const std::vector<ArrowColumn>& columns,
                                                    int codec) {
  std::string body;
  std::vector<std::int64_t> nodes, buffers;
  for (const ArrowColumn& column : columns) {
    nodes.insert(nodes.end(), {column.rows, column.nulls});
    buffers.insert(buffers.end(), {static_cast<std::int64_t>(body.size()), 0});
    for (const std::string& buffer : column.buffers) {
      buffers.insert(buffers.end(), {static_cast<std::int64_t>(body.size()),
                                     static_cast<std::int64_t>(buffer.size())});
      body += buffer;
      body.resize((body.size() + 7) / 8 * 8);
    }
  }
  std::size_t header = 0;
  FlatComposer flat = message(3, static_cast<std::int64_t>(body.size()), header);
  const std::size_t batch = flat.table(header, {true, true, true, codec >= 0});
  flat.set(flat.field(batch, 0), columns.empty() ? std::int64_t{0} : columns[0].rows);
  std::size_t number = 1;
  for (const auto* structs : {&nodes, &buffers}) {
    flat.align(8, 4);
    flat.link(flat.field(batch, number++));
    flat.add(static_cast<std::uint32_t>(structs->size() / 2));
    flat.bytes += raw_bytes(*structs);
  }
  if (codec >= 0) {
    const std::size_t compression = flat.table(flat.field(batch, 3), {true, true});
    flat.set(flat.field(compression, 0), static_cast<std::int8_t>(codec));
  }
  return {message_of(flat), body};
}

/// An Arrow file with these batches. `codec`: -1, or the compression whose data the buffers are.
inline std::string arrow_file(const std::vector<std::vector<ArrowColumn>>& batches,
                              int codec = -1) {
  std::string file = std::string("ARROW1\0\0", 8);
  std::size_t header = 0;
  FlatComposer schema = message(1, 0, header);
  add_schema(schema, header, batches.front());
  file += message_of(schema);
  std::vector<std::int64_t> blocks;
  for (const auto& columns : batches) {
    const auto [head, body] = batch_of(columns, codec);
    blocks.insert(blocks.end(),
                  {static_cast<std::int64_t>(file.size()), static_cast<std::int64_t>(head.size()),
                   static_cast<std::int64_t>(body.size())});
    file += head + body;
  }
  file += std::string("\xff\xff\xff\xff\0\0\0\0", 8);
  FlatComposer footer;
  const std::size_t root = footer.table(0, {true, true, false, true});
  footer.set(footer.field(root, 0), std::int16_t{4});
  add_schema(footer, footer.field(root, 1), batches.front());
  footer.align(8, 4);
  footer.link(footer.field(root, 3));
  footer.add(static_cast<std::uint32_t>(batches.size()));
  footer.bytes += raw_bytes(blocks);
  const auto size = static_cast<std::uint32_t>(footer.bytes.size());
  return file + footer.bytes + std::string(reinterpret_cast<const char*>(&size), sizeof(size)) +
         "ARROW1";
}

}  // namespace adasplats::arrow_test
