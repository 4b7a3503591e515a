// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz_writer.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "LAS files are little-endian");

// Without colours, with them, and with near infrared.
constexpr std::size_t kPlainFormat6 = 6, kColourFormat = 7, kInfraredFormat = 8;
constexpr std::size_t kHeaderBytes = 375;       // table 3
constexpr std::size_t kExtraRecordBytes = 192;  // table 24
constexpr std::uint16_t kExtraRecordId = 4;
constexpr std::size_t kMaxReturns = 15;
// Point formats 6 to 10 should set it (table 4): a coordinate system, if any, is reported as WKT.
constexpr std::uint16_t kWktBit = 1 << 4;
constexpr std::uint16_t kAdjustedTimesBit = 1 << 0;
constexpr std::uint16_t kWktRecordId = 2112;
constexpr std::uint16_t kGeoKeysId = 34735, kGeoDoublesId = 34736, kGeoTextId = 34737;

template <class T>
void put(char* record, std::size_t offset, T value) {
  std::memcpy(record + offset, &value, sizeof(T));
}

/// Text without a terminator; the rest of its field is already zero.
void put_text(char* record, std::size_t offset, std::string_view text) {
  std::ranges::copy(text, record + offset);
}

/// A field of point formats 6 to 8 that is copied unchanged (tables 16 to 18).
struct CopiedField {
  std::string_view name;
  ColumnType type;
  std::size_t offset;
};
constexpr std::array<CopiedField, 10> kCopiedFields = {{{"intensity", ColumnType::u16, 12},
                                                        {"classification", ColumnType::u8, 16},
                                                        {"user_data", ColumnType::u8, 17},
                                                        {"scan_angle", ColumnType::i16, 18},
                                                        {"point_source_id", ColumnType::u16, 20},
                                                        {"gps_time", ColumnType::f64, 22},
                                                        {"red", ColumnType::u16, 30},
                                                        {"green", ColumnType::u16, 32},
                                                        {"blue", ColumnType::u16, 34},
                                                        {"nir", ColumnType::u16, 36}}};
constexpr std::size_t kRedField = 6, kInfraredField = 9;
constexpr std::size_t kReturnsOffset = 14;

/// Bits of the byte at kBitsOffset (table 16).
struct BitField {
  std::string_view name;
  unsigned shift, most;
};
constexpr std::size_t kBitsOffset = 15;
constexpr std::array<BitField, 6> kBitFields = {{{"synthetic", 0, 1},
                                                 {"key_point", 1, 1},
                                                 {"overlap", 3, 1},
                                                 {"scanner_channel", 4, 3},
                                                 {"scan_direction_flag", 6, 1},
                                                 {"edge_of_flight_line", 7, 1}}};

/// The columns by their use.
class PointColumns {
 public:
  explicit PointColumns(std::span<const ColumnView> columns) {
    for (const ColumnView& column : columns) take(column);
    for (const ColumnView& axis : axes_)
      if (axis.name.empty()) throw std::logic_error("write_las: x, y or z is missing");
    for (std::size_t field = kRedField; field <= kInfraredField; ++field)
      if (copied_[field].name.empty() != copied_[kRedField].name.empty() &&
          !(field == kInfraredField && copied_[field].name.empty()))
        throw std::logic_error("write_las: red, green or blue is missing");
  }

  std::span<const ColumnView> extras() const { return extras_; }

  Vec3d position(std::size_t row) const {
    return {coordinate(axes_[0], row), coordinate(axes_[1], row), coordinate(axes_[2], row)};
  }
  std::uint8_t return_number(std::size_t row) const { return byte_of(return_number_, row); }
  std::uint8_t number_of_returns(std::size_t row) const { return byte_of(returns_, row); }
  std::uint8_t bits(std::size_t row) const {
    unsigned bits = 0;
    for (std::size_t k = 0; k < kBitFields.size(); ++k)
      if (!bits_[k].name.empty())
        bits |= std::min<unsigned>(byte_of(bits_[k], row), kBitFields[k].most)
                << kBitFields[k].shift;
    return static_cast<std::uint8_t>(bits);
  }
  std::size_t point_format() const {
    if (copied_[kRedField].name.empty()) return kPlainFormat6;
    return copied_[kInfraredField].name.empty() ? kColourFormat : kInfraredFormat;
  }

  void copy_fields(std::size_t row, char* record) const {
    for (std::size_t k = 0; k < kCopiedFields.size(); ++k) {
      if (copied_[k].name.empty()) continue;
      spread_column(copied_[k], row, 1, 0, record + kCopiedFields[k].offset);
    }
  }

 private:
  void take(const ColumnView& column) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (column.name == std::string_view("xyz").substr(axis, 1)) return take_axis(axis, column);
    for (std::size_t k = 0; k < kCopiedFields.size(); ++k) {
      if (column.name != kCopiedFields[k].name) continue;
      check_type(column, kCopiedFields[k].type);
      copied_[k] = column;
      return;
    }
    for (std::size_t k = 0; k < kBitFields.size(); ++k) {
      if (column.name != kBitFields[k].name) continue;
      check_type(column, ColumnType::u8);
      bits_[k] = column;
      return;
    }
    if (column.name == "return_number" || column.name == "number_of_returns") {
      check_type(column, ColumnType::u8);
      (column.name == "return_number" ? return_number_ : returns_) = column;
      return;
    }
    if (column.name.empty() || column.name.size() > 31)
      throw std::logic_error("write_las: the name of an attribute is empty or above 31 bytes");
    extras_.push_back(column);
  }
  void take_axis(std::size_t axis, const ColumnView& column) {
    if (column.type != ColumnType::f32) check_type(column, ColumnType::f64);
    axes_[axis] = column;
  }
  static void check_type(const ColumnView& column, ColumnType expected) {
    if (column.type != expected)
      throw std::logic_error("write_las: a column is not of its type: " + std::string(column.name));
  }
  static const char* place(const ColumnView& column, std::size_t row) {
    return static_cast<const char*>(column.data) + row * column.stride_bytes;
  }
  static double coordinate(const ColumnView& column, std::size_t row) {
    double wide = 0;
    float narrow = 0;
    if (column.type == ColumnType::f64) {
      std::memcpy(&wide, place(column, row), sizeof(wide));
      return wide;
    }
    std::memcpy(&narrow, place(column, row), sizeof(narrow));
    return narrow;
  }
  static std::uint8_t byte_of(const ColumnView& column, std::size_t row) {
    return column.name.empty() ? std::uint8_t{1} : static_cast<std::uint8_t>(*place(column, row));
  }

  std::array<ColumnView, 3> axes_ = {};
  std::array<ColumnView, kCopiedFields.size()> copied_ = {};  ///< without a name: absent
  std::array<ColumnView, kBitFields.size()> bits_ = {};
  ColumnView return_number_ = {};
  ColumnView returns_ = {};
  std::vector<ColumnView> extras_;
};

/// Header fields computed from all points.
struct Summary {
  std::array<std::int32_t, 3> low, high;
  std::array<std::uint64_t, kMaxReturns> by_return = {};
};

/// Conversion of coordinates to integers.
class Grid {
 public:
  Grid(const std::filesystem::path& path, const LasWriteOptions& options)
      : path_(path), options_(options) {}

  std::array<std::int32_t, 3> steps(Vec3d position, std::size_t row) const {
    std::array<std::int32_t, 3> steps;
    for (int axis = 0; axis < 3; ++axis) {
      const double step =
          std::nearbyint((position[axis] - options_.offset_m[axis]) / options_.scale_m);
      // Also rejects NaN.
      if (!(std::fabs(step) <= std::numeric_limits<std::int32_t>::max()))
        throw Error(ErrorKind::data, path_.string() + ": point " + std::to_string(row) + ": " +
                                         "xyz"[axis] + " = " + exact_text(position[axis]) +
                                         " is out of range of LAS with the offset " +
                                         exact_text(options_.offset_m[axis]) + " and the scale " +
                                         exact_text(options_.scale_m));
      steps[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(step);
    }
    return steps;
  }
  double coordinate(std::size_t axis, std::int32_t step) const {
    return step * options_.scale_m + options_.offset_m[static_cast<int>(axis)];
  }
  double scale() const { return options_.scale_m; }
  Vec3d offset() const { return options_.offset_m; }
  /// Whether the coordinate system is GeoTIFF keys.
  bool has_keys() const { return !options_.crs.empty() && options_.crs.wkt.empty(); }
  bool is_packed() const { return options_.is_packed; }
  bool has_adjusted_times() const { return options_.has_adjusted_times; }
  const std::filesystem::path& path() const { return path_; }

 private:
  const std::filesystem::path& path_;
  LasWriteOptions options_;
};

Summary summary_of(const PointColumns& columns, std::size_t rows, const Grid& grid) {
  Summary summary;
  summary.low.fill(std::numeric_limits<std::int32_t>::max());
  summary.high.fill(std::numeric_limits<std::int32_t>::min());
  for (std::size_t row = 0; row < rows; ++row) {
    const auto steps = grid.steps(columns.position(row), row);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      summary.low[axis] = std::min(summary.low[axis], steps[axis]);
      summary.high[axis] = std::max(summary.high[axis], steps[axis]);
    }
    const std::size_t number = columns.return_number(row);
    const std::size_t of = columns.number_of_returns(row);
    // 0 is not allowed, but common: it is kept, and counted nowhere.
    if (number > kMaxReturns || of > kMaxReturns)
      throw Error(ErrorKind::data, grid.path().string() + ": point " + std::to_string(row) +
                                       ": return " + std::to_string(number) + " of " +
                                       std::to_string(of) + ", LAS allows 1 to 15");
    if (number > 0) ++summary.by_return[number - 1];
  }
  if (rows == 0) summary.low = summary.high = {};
  return summary;
}

/// Table 25.
std::uint8_t extra_type(ColumnType type) {
  switch (type) {
    case ColumnType::u8: return 1;
    case ColumnType::i8: return 2;
    case ColumnType::u16: return 3;
    case ColumnType::i16: return 4;
    case ColumnType::u32: return 5;
    case ColumnType::i32: return 6;
    case ColumnType::u64: return 7;
    case ColumnType::i64: return 8;
    case ColumnType::f32: return 9;
    case ColumnType::f64: return 10;
  }
  throw std::logic_error("write_las: no such type");
}

/// Consecutive variable length records.
struct Records {
  std::string bytes;
  std::uint32_t count = 0;

  void add(const std::filesystem::path& path, std::string_view user, std::uint16_t number,
           std::string_view content) {
    if (content.size() > std::numeric_limits<std::uint16_t>::max())
      throw Error(ErrorKind::data, path.string() + ": record " + std::to_string(number) + " of '" +
                                       std::string(user) + "' has " +
                                       std::to_string(content.size()) +
                                       " bytes, LAS allows at most 65535");
    std::string start(kVlrHeaderBytes, '\0');
    put_text(start.data(), 2, user);
    put(start.data(), 18, number);
    put(start.data(), 20, static_cast<std::uint16_t>(content.size()));
    bytes += start;
    bytes += content;
    ++count;
  }
};

/// Descriptions of the extra bytes.
std::string extra_descriptions(std::span<const ColumnView> extras) {
  std::string record(extras.size() * kExtraRecordBytes, '\0');
  for (std::size_t k = 0; k < extras.size(); ++k) {
    char* const entry = record.data() + k * kExtraRecordBytes;
    put(entry, 2, extra_type(extras[k].type));
    put_text(entry, 4, extras[k].name);
  }
  return record;
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

void add_crs(const std::filesystem::path& path, const Crs& crs, Records& records) {
  if (crs.empty()) return;
  const auto add = [&](std::uint16_t number, std::string_view content) {
    records.add(path, "LASF_Projection", number, content);
  };
  if (!crs.wkt.empty()) return add(kWktRecordId, {crs.wkt.c_str(), crs.wkt.size() + 1});
  add(kGeoKeysId, bytes_of(crs.keys.directory));
  if (!crs.keys.doubles.empty()) add(kGeoDoublesId, bytes_of(crs.keys.doubles));
  if (!crs.keys.ascii.empty()) add(kGeoTextId, {crs.keys.ascii.c_str(), crs.keys.ascii.size() + 1});
}

/// All records between the header and the points.
Records records_of(const std::filesystem::path& path, std::span<const ColumnView> extras,
                   std::size_t point_format, std::size_t record_bytes,
                   const LasWriteOptions& options) {
  Records records;
  add_crs(path, options.crs, records);
  if (!extras.empty()) records.add(path, "LASF_Spec", kExtraRecordId, extra_descriptions(extras));
  if (!options.labels.empty()) records.add(path, kLasLabelsUser, kLasLabelsRecord, options.labels);
  if (options.is_packed)
    records.add(path, kLaszipUser, kLaszipRecordId, laszip_record(point_format, record_bytes));
  return records;
}

std::string header_of(std::size_t rows, const Summary& summary, const Grid& grid,
                      std::size_t point_format, std::size_t record_bytes, const Records& records) {
  std::string header(kHeaderBytes, '\0');
  char* const bytes = header.data();
  put_text(bytes, 0, "LASF");
  put(bytes, 6,
      static_cast<std::uint16_t>((grid.has_keys() ? 0 : kWktBit) |
                                 (grid.has_adjusted_times() ? kAdjustedTimesBit : 0)));
  put(bytes, 24, std::uint8_t{1});
  put(bytes, 25, std::uint8_t{4});
  put_text(bytes, 26, "OTHER");  // System Identifier, table 5: neither sensor nor merge
  put_text(bytes, 58, "adasplats");
  put(bytes, 94, static_cast<std::uint16_t>(kHeaderBytes));
  put(bytes, 96, static_cast<std::uint32_t>(kHeaderBytes + records.bytes.size()));
  put(bytes, 100, records.count);
  put(bytes, 104,
      static_cast<std::uint8_t>(point_format | (grid.is_packed() ? kLaszipFormatBit : 0)));
  put(bytes, 105, static_cast<std::uint16_t>(record_bytes));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(bytes, 131 + 8 * axis, grid.scale());
    put(bytes, 155 + 8 * axis, grid.offset()[static_cast<int>(axis)]);
    put(bytes, 179 + 16 * axis, grid.coordinate(axis, summary.high[axis]));
    put(bytes, 187 + 16 * axis, grid.coordinate(axis, summary.low[axis]));
  }
  put(bytes, 247, static_cast<std::uint64_t>(rows));
  for (std::size_t k = 0; k < kMaxReturns; ++k) put(bytes, 255 + 8 * k, summary.by_return[k]);
  return header;
}

}  // namespace

void put_las(ByteSink& file, const std::filesystem::path& path, std::size_t rows,
             std::span<const ColumnView> columns, const LasWriteOptions& options) {
  const PointColumns points(columns);
  const Grid grid(path, options);
  const Summary summary = summary_of(points, rows, grid);
  const std::size_t point_format = points.point_format();
  const std::size_t fixed_bytes = las_format(point_format).min_bytes;
  std::size_t record_bytes = fixed_bytes;
  for (const ColumnView& extra : points.extras()) record_bytes += type_bytes(extra.type);
  const Records records = records_of(path, points.extras(), point_format, record_bytes, options);
  file.write(header_of(rows, summary, grid, point_format, record_bytes, records));
  file.write(records.bytes);
  LazWriter packer(point_format, record_bytes);
  ByteSink& to = options.is_packed ? static_cast<ByteSink&>(packer) : file;
  write_records(to, rows, points.extras(), fixed_bytes, [&](std::size_t row, char* record) {
    std::memset(record, 0, fixed_bytes);
    const auto steps = grid.steps(points.position(row), row);
    std::memcpy(record, steps.data(), sizeof(steps));
    const auto returns = points.return_number(row) | points.number_of_returns(row) << 4;
    put(record, kReturnsOffset, static_cast<std::uint8_t>(returns));
    put(record, kBitsOffset, points.bits(row));
    points.copy_fields(row, record);
  });
  if (options.is_packed) packer.finish(file, kHeaderBytes + records.bytes.size());
}

bool is_laz_name(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".laz";
}

void write_las(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, const LasWriteOptions& options) {
  AtomicFile file(path);
  put_las(file, path, rows, columns, options);
  file.commit();
}

}  // namespace adasplats
