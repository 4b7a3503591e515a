// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "adasplats/io/base/crs.h"

namespace adasplats {

/// One named field of all records of a file, in its type in the file.
struct Column {
  using Values =
      std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                   std::vector<std::uint16_t>, std::vector<std::int32_t>,
                   std::vector<std::uint32_t>, std::vector<std::int64_t>,
                   std::vector<std::uint64_t>, std::vector<float>, std::vector<double>>;
  std::string name;
  Values values;

  std::size_t size() const;
  /// The value of one record as a double (64-bit integers beyond 2^53 are rounded).
  double as_double(std::size_t row) const;
};

/// What a reader reports about a file besides its points. The text of each note is given in quotes.
enum class NoteKind : std::uint8_t {
  geographic,       ///< x and y are longitude and latitude: where the file states it
  not_metres,       ///< a unit other than the metre: "z in feet (0.3048 m), by EPSG:8228"
  unknown_unit,     ///< a unit that cannot be looked up: "z in the unit of EPSG:10480"
  adjusted_gps,     ///< times are adjusted GPS time; no text
  withheld,         ///< points flagged as deleted and not read: "1 of 3 points"
  salvaged,         ///< a truncated file, read as far as it goes: "2 of 3 records"
  left_out,         ///< columns, images or records that were not read: "2 images"
  intensity_scale,  ///< intensities that are not scaled as expected
  no_return,        ///< points without a return, not read: "2 points without a return"
  wrong_count,      ///< more points than the file states: "the file states 1 points and has 2"
  own_frame,        ///< of a scanner: "its station has the identity matrix: ..."
  unnamed_columns,  ///< a text without names: "no line names its columns: column 4 is read as ..."
};

struct ReaderNote {
  NoteKind kind;
  std::string text;

  bool operator==(const ReaderNote&) const = default;
};

/// Content of a point file: named columns of equal length, the comments in the file, notes of the
/// reader, and the coordinate reference system that the file states.
struct Table {
  std::size_t rows = 0;
  std::vector<Column> columns;
  std::vector<std::string> comments;
  std::vector<ReaderNote> notes;
  Crs crs;

  const Column* find(std::string_view name) const;  ///< nullptr if there is none
};

/// Keeps only the flagged rows.
void keep_rows(const std::vector<bool>& kept, Table& table);

/// The triangles of a file: `vertices` (x, y, z, ...) and three vertex indices for each triangle;
/// `faces` has the properties of each triangle (e.g. class). Polygons become fans of triangles.
struct MeshTable {
  Table vertices;
  std::vector<std::uint32_t> triangle_vertices;  ///< 3 for each triangle
  Table faces;                                   ///< rows = triangles
};

enum class ColumnType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// The type of a C++ number, or of the numbers of an enumeration.
template <class T>
constexpr ColumnType column_type() {
  if constexpr (std::is_enum_v<T>) {
    return column_type<std::underlying_type_t<T>>();
  } else {
    static_assert(std::is_arithmetic_v<T>);
    if constexpr (std::is_floating_point_v<T>)
      return sizeof(T) == 4 ? ColumnType::f32 : ColumnType::f64;
    constexpr bool kSigned = std::is_signed_v<T>;
    switch (sizeof(T)) {
      case 1: return kSigned ? ColumnType::i8 : ColumnType::u8;
      case 2: return kSigned ? ColumnType::i16 : ColumnType::u16;
      case 4: return kSigned ? ColumnType::i32 : ColumnType::u32;
      default: return kSigned ? ColumnType::i64 : ColumnType::u64;
    }
  }
}

/// A column to write: values of one type at a fixed stride in memory.
struct ColumnView {
  std::string_view name;
  ColumnType type;
  const void* data;
  std::size_t stride_bytes;
};

/// Consecutive records of a file.
struct RecordSpan {
  std::uint64_t first = 0;
  std::uint64_t count = 0;

  /// The part of it in a file with `records` records.
  RecordSpan within(std::uint64_t records) const {
    const std::uint64_t begin = std::min(first, records);
    return {begin, std::min(count, records - begin)};
  }
  bool contains(std::uint64_t record) const { return record >= first && record - first < count; }
};

}  // namespace adasplats
