// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_vlrs.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "adasplats/io/base/epsg_units.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/base/wkt.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {
namespace {

// Record numbers of the specification, and of GeoTIFF 1.0 (keys and their values).
constexpr std::uint16_t kExtraBytesRecord = 4;
constexpr std::uint16_t kWktRecord = 2112;
constexpr std::uint16_t kGeoKeysRecord = 34735, kGeoDoublesRecord = 34736, kGeoTextRecord = 34737;
constexpr std::uint16_t kModelTypeKey = 1024;
constexpr std::uint16_t kModelTypeGeographic = 2;
constexpr std::uint16_t kProjectedTypeKey = 3072, kLinearUnitsKey = 3076;
constexpr std::uint16_t kVerticalTypeKey = 4096, kVerticalUnitsKey = 4099;

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.substr(offset, sizeof(T)).data(), sizeof(T));
  return value;
}

/// A text up to the first zero or the end of its field.
std::string text_at(std::string_view bytes, std::size_t offset, std::size_t length) {
  const std::string_view field = bytes.substr(offset, length);
  return std::string(field.substr(0, field.find('\0')));
}

/// Types 1 to 10 of table 24; 11 to 30 are old arrays of two and three of them.
constexpr std::array<ColumnType, 10> kExtraTypes = {
    ColumnType::u8,  ColumnType::i8,  ColumnType::u16, ColumnType::i16, ColumnType::u32,
    ColumnType::i32, ColumnType::u64, ColumnType::i64, ColumnType::f32, ColumnType::f64};

/// The attributes in an extra bytes record (table 24).
std::vector<LasExtraField> extra_fields_of(std::string_view record, const LasHeader& header) {
  constexpr std::size_t kDescriptorBytes = 192;
  constexpr std::uint8_t kHasScale = 1 << 3, kHasOffset = 1 << 4;
  std::vector<LasExtraField> fields;
  std::size_t place = las_format(header.format).min_bytes;
  for (; record.size() >= kDescriptorBytes; record.remove_prefix(kDescriptorBytes)) {
    const auto type = value_at<std::uint8_t>(record, 2);
    const auto options = value_at<std::uint8_t>(record, 3);
    if (type > 3 * kExtraTypes.size()) break;
    if (type == 0) {  // bytes without a meaning, counted by the options
      place += options;
      continue;
    }
    const ColumnType scalar = kExtraTypes.at((type - 1U) % kExtraTypes.size());
    const std::size_t items = 1 + (type - 1U) / kExtraTypes.size();
    LasExtraField field{utf8_text(text_at(record, 4, 32)), scalar, place, false, 1, 0};
    place += items * type_bytes(scalar);
    if (place > header.record_bytes) break;
    if (items > 1 || field.name.empty()) continue;
    field.is_scaled = (options & (kHasScale | kHasOffset)) != 0;
    if ((options & kHasScale) != 0) field.scale = value_at<double>(record, 112);
    if ((options & kHasOffset) != 0) field.offset = value_at<double>(record, 136);
    fields.push_back(std::move(field));
  }
  return fields;
}

/// Whether a GeoTIFF key directory states that coordinates are angles.
bool is_geographic_directory(std::string_view record) {
  constexpr std::size_t kKeyBytes = 8;
  for (; record.size() >= kKeyBytes; record.remove_prefix(kKeyBytes))
    if (value_at<std::uint16_t>(record, 0) == kModelTypeKey &&
        value_at<std::uint16_t>(record, 6) == kModelTypeGeographic)
      return true;
  return false;
}

/// Units of lengths in a GeoTIFF key directory.
struct DirectoryUnits {
  std::optional<std::string> not_metres, unknown;
};

/// The keys of the system and of the unit of x and y, or of z.
struct UnitKeys {
  const char* coordinates;
  std::uint16_t system, unit;
  std::optional<std::uint16_t> (*unit_of_system)(std::uint16_t);
};

/// A stated unit has precedence over that of the system.
void add_units(std::string_view record, const UnitKeys& keys, DirectoryUnits& units) {
  constexpr std::size_t kKeyBytes = 8;
  constexpr std::uint16_t kUserDefined = 32767;
  constexpr std::uint16_t kFirstUnit = 9001, kLastUnit = 9999;
  std::uint16_t unit = 0, system = 0;
  for (; record.size() >= kKeyBytes; record.remove_prefix(kKeyBytes)) {
    const auto key = value_at<std::uint16_t>(record, 0);
    if (key == keys.unit) unit = value_at<std::uint16_t>(record, 6);
    if (key == keys.system) system = value_at<std::uint16_t>(record, 6);
  }
  const std::string in = std::string(keys.coordinates) + " in ";
  if (unit != 0 && unit != kUserDefined) {
    if (const auto length = foreign_length_of(unit))
      units.not_metres = in + *length + ", by GeoTIFF key " + std::to_string(keys.unit) + " = " +
                         std::to_string(unit);
    else if (unit < kFirstUnit || unit > kLastUnit)
      units.unknown =
          in + "the unit " + std::to_string(unit) + " of GeoTIFF key " + std::to_string(keys.unit);
  } else if (unit == 0 && system != 0 && system != kUserDefined) {
    const auto found = keys.unit_of_system(system);
    const std::string name = "EPSG:" + std::to_string(system);
    if (!found) units.unknown = in + "the unit of " + name;
    if (const auto length = found ? foreign_length_of(*found) : std::nullopt)
      units.not_metres = in + *length + ", by " + name;
  }
}

DirectoryUnits units_of_directory(std::string_view record) {
  DirectoryUnits units;
  add_units(record, {"z", kVerticalTypeKey, kVerticalUnitsKey, &unit_of_vertical_system}, units);
  add_units(record, {"x and y", kProjectedTypeKey, kLinearUnitsKey, &unit_of_projected_system},
            units);
  return units;
}

template <class T>
std::vector<T> values_of(std::string_view record) {
  std::vector<T> values(record.size() / sizeof(T));
  std::memcpy(values.data(), record.data(), values.size() * sizeof(T));
  return values;
}

/// Makes the text UTF-8, and moves the parts of it that the keys refer to.
void convert_text(GeoKeys& keys) {
  constexpr std::size_t kKeyNumbers = 4;
  const std::string text = utf8_text(keys.ascii);
  if (text == keys.ascii) return;
  const auto place_of = [&keys](std::size_t bytes) {
    const std::string_view before = std::string_view(keys.ascii).substr(0, bytes);
    const auto wide = std::ranges::count_if(before, [](char c) { return (c & 0x80) != 0; });
    return static_cast<std::uint16_t>(bytes + static_cast<std::size_t>(wide));
  };
  for (std::size_t k = kKeyNumbers; k + kKeyNumbers <= keys.directory.size(); k += kKeyNumbers) {
    std::uint16_t* const key = keys.directory.data() + k;
    if (key[1] != kGeoTextRecord) continue;
    const std::uint16_t begin = place_of(key[3]);
    key[2] = static_cast<std::uint16_t>(place_of(std::size_t{key[3]} + key[2]) - begin);
    key[3] = begin;
  }
  keys.ascii = text;
}

/// Collects the content of records.
class Descriptor {
 public:
  Descriptor(const LasHeader& header, LasDescription& description)
      : header_(header), description_(description) {}

  /// Whether a record concerns the points.
  static bool is_wanted(std::string_view user, std::uint16_t number) {
    if (user == "LASF_Spec") return number == kExtraBytesRecord;
    if (user == kLasLabelsUser) return number == kLasLabelsRecord;
    return user == "LASF_Projection" && (number == kWktRecord || number == kGeoKeysRecord ||
                                         number == kGeoDoublesRecord || number == kGeoTextRecord);
  }

  void take(std::uint16_t number, std::string_view record) {
    switch (number) {
      case kLasLabelsRecord: description_.labels = text_at(record, 0, record.size()); break;
      case kExtraBytesRecord: description_.extra_fields = extra_fields_of(record, header_); break;
      case kGeoKeysRecord:
        if (is_geographic_directory(record)) description_.geographic = "GTModelType 2, geographic";
        take_units(units_of_directory(record));
        keys_.directory = values_of<std::uint16_t>(record);
        break;
      case kGeoDoublesRecord: keys_.doubles = values_of<double>(record); break;
      case kGeoTextRecord: keys_.ascii = record; break;
      default:
        if (const auto system = geographic_system_of_wkt(record)) description_.geographic = system;
        if (const auto units = foreign_units_of_wkt(record)) description_.not_metres = units;
        wkt_ = crs_of_wkt(record);
    }
  }

  void take_units(DirectoryUnits units) {
    if (units.not_metres) description_.not_metres = std::move(units.not_metres);
    if (units.unknown) description_.unknown_unit = std::move(units.unknown);
  }

  void finish() {
    // The directory states its number of keys; the rest is padding.
    constexpr std::size_t kCountAt = 3, kKeyNumbers = 4;
    std::vector<std::uint16_t>& directory = keys_.directory;
    if (directory.size() > kCountAt)
      directory.resize(std::min(directory.size() / kKeyNumbers * kKeyNumbers,
                                kKeyNumbers + kKeyNumbers * directory[kCountAt]));
    // Some writers end the text with zeros.
    keys_.ascii.erase(keys_.ascii.find_last_not_of('\0') + 1);
    convert_text(keys_);
    const Crs keys = {{}, std::move(keys_)};
    const bool takes_wkt = header_.has_wkt ? !wkt_.empty() : keys.empty();
    if (takes_wkt)
      description_.crs = std::move(wkt_);
    else if (!keys.empty())
      description_.crs = keys;
  }

 private:
  const LasHeader& header_;
  LasDescription& description_;
  Crs wkt_;
  GeoKeys keys_;
};

/// The start of an ordinary or extended record.
struct RecordStart {
  std::string user;
  std::uint16_t number = 0;
  std::uint64_t bytes = 0;
};

RecordStart record_start(InputFile& file, bool is_extended) {
  const std::size_t bytes = is_extended ? kEvlrHeaderBytes : kVlrHeaderBytes;
  const std::string_view start(reinterpret_cast<const char*>(file.peek(bytes).data()), bytes);
  RecordStart record{
      text_at(start, 2, 16), value_at<std::uint16_t>(start, 18),
      is_extended ? value_at<std::uint64_t>(start, 20) : value_at<std::uint16_t>(start, 20)};
  file.skip(bytes);
  return record;
}

/// Reads the record at the current offset of `file`, and skips it.
void take_record(InputFile& file, const RecordStart& record, Descriptor& descriptor) {
  // The longest coordinate systems have about 10 kB, extra bytes records less than 64 kB.
  constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20;
  if (record.bytes > 0 && Descriptor::is_wanted(record.user, record.number)) {
    if (record.bytes > kMaxBytes)
      throw file.error_here("found " + std::to_string(record.bytes) + " bytes of record " +
                            std::to_string(record.number) + " of '" + record.user +
                            "', expected at most " + std::to_string(kMaxBytes));
    const auto bytes = static_cast<std::size_t>(record.bytes);
    descriptor.take(record.number, {reinterpret_cast<const char*>(file.peek(bytes).data()), bytes});
  }
  file.skip(record.bytes);
}

void read_vlrs(const std::filesystem::path& path, const LasHeader& header, Descriptor& descriptor) {
  InputFile file(path);
  file.skip(header.header_bytes);
  for (std::uint64_t k = 0; k < header.vlr_count; ++k) {
    if (file.offset() + kVlrHeaderBytes > header.points_offset_bytes) break;
    const RecordStart record = record_start(file, false);
    if (file.offset() + record.bytes > header.points_offset_bytes) break;
    take_record(file, record, descriptor);
  }
}

/// Returns whether all of them are within the file.
bool read_evlrs(const std::filesystem::path& path, const LasHeader& header,
                Descriptor& descriptor) {
  if (header.evlr_count == 0) return true;
  InputFile file(path);
  if (header.evlrs_offset_bytes > file.size_bytes()) return false;
  file.skip(header.evlrs_offset_bytes);
  for (std::uint64_t k = 0; k < header.evlr_count; ++k) {
    if (file.remaining() < kEvlrHeaderBytes) return false;
    const RecordStart record = record_start(file, true);
    if (file.remaining() < record.bytes) return false;
    take_record(file, record, descriptor);
  }
  return true;
}

}  // namespace

void LasDescription::add_notes(std::vector<ReaderNote>& notes) const {
  if (geographic) notes.push_back({NoteKind::geographic, *geographic});
  if (not_metres) notes.push_back({NoteKind::not_metres, *not_metres});
  if (unknown_unit) notes.push_back({NoteKind::unknown_unit, *unknown_unit});
  if (has_adjusted_times) notes.push_back({NoteKind::adjusted_gps, {}});
  if (is_cut)
    notes.push_back({NoteKind::left_out, "extended records that reach beyond the file's end"});
}

LasDescription read_las_description(const std::filesystem::path& path, const LasHeader& header) {
  LasDescription description;
  description.has_adjusted_times = header.has_adjusted_times;
  Descriptor descriptor(header, description);
  read_vlrs(path, header, descriptor);
  description.is_cut = !read_evlrs(path, header, descriptor);
  descriptor.finish();
  return description;
}

}  // namespace adasplats
