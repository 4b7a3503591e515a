// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/column_names.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using Name = std::string_view;

// Letters and digits only, the most common first.
constexpr Name kTimeNames[] = {"time",
                               "timestamp",
                               "gpstime",
                               "offsettime",
                               "t",
                               "timestamps",
                               "stamp",
                               "timeoffset",
                               "timestampoffset",
                               "relativetime",
                               "pointtime",
                               "pointtimestamp",
                               "adjustedtime",
                               "adjustedgpstime",
                               "gpsseconds",
                               "gpssow",
                               "sow",
                               "timeofweek",
                               "secondsofweek",
                               "internaltime",
                               "utctime",
                               "unixtime",
                               "epochtime",
                               "acquisitiontime"};
constexpr Name kIntensityNames[] = {
    "intensityvalue",  // of our own LAS files
    "intensity",      "reflectance", "remission",      "reflectivity",    "luma",
    "intensities",    "i",           "laserintensity", "returnintensity", "echointensity",
    "amplitude",      "signal"};
// Those that RIEGL and others write in decibels.
constexpr Name kDecibelNames[] = {"reflectance", "reflectivity", "amplitude"};
constexpr Name kRingNames[] = {"ring",      "laser",   "ringid",      "ringnumber", "ringindex",
                               "laserring", "laserid", "lasernumber", "channel",    "channelid",
                               "beam",      "beamid",  "line",        "lineid"};
constexpr Name kClassNames[] = {"label",         "class",      "classification", "semantic",
                                "semclass",      "classid",    "classlabel",     "semanticlabel",
                                "semanticclass", "semanticid", "labels",         "classes",
                                "category"};
constexpr Name kInstanceNames[] = {"instance", "instances", "instanceid", "instancelabel"};
constexpr Name kScanNames[] = {"scanindex"};
constexpr Name kReturnNames[] = {"returnnumber", "returnnum",  "returnno", "returnindex",
                                 "returnid",     "echonumber", "return"};
constexpr Name kReturnCounts[] = {"numberofreturns", "numreturns",   "numofreturns",
                                  "returncount",     "returncounts", "numberofechoes"};
constexpr Name kWithheldNames[] = {"withheld", "withheldflag", "iswithheld"};
constexpr Name kNormalsX[] = {"nx", "normalx", "normalsx", "normx"};
constexpr Name kNormalsY[] = {"ny", "normaly", "normalsy", "normy"};
constexpr Name kNormalsZ[] = {"nz", "normalz", "normalsz", "normz"};

constexpr std::pair<PointColumn, std::span<const Name>> kColumnNames[] = {
    {PointColumn::time, kTimeNames},
    {PointColumn::intensity, kIntensityNames},
    {PointColumn::ring, kRingNames},
    {PointColumn::classification, kClassNames},
    {PointColumn::instance, kInstanceNames},
    {PointColumn::scan_index, kScanNames},
    {PointColumn::return_number, kReturnNames},
    {PointColumn::number_of_returns, kReturnCounts},
    {PointColumn::withheld, kWithheldNames},
    {PointColumn::normal_x, kNormalsX},
    {PointColumn::normal_y, kNormalsY},
    {PointColumn::normal_z, kNormalsZ}};

constexpr std::pair<Name, double> kTimeSuffixes[] = {{"nanoseconds", 1e-9},
                                                     {"microseconds", 1e-6},
                                                     {"milliseconds", 1e-3},
                                                     {"seconds", 1},
                                                     {"nanosecs", 1e-9},
                                                     {"nanosec", 1e-9},
                                                     {"nanos", 1e-9},
                                                     {"nsecs", 1e-9},
                                                     {"nsec", 1e-9},
                                                     {"usec", 1e-6},
                                                     {"msec", 1e-3},
                                                     {"secs", 1},
                                                     {"sec", 1},
                                                     {"ns", 1e-9},
                                                     {"us", 1e-6},
                                                     {"ms", 1e-3},
                                                     {"s", 1}};

// Fields of LAS, and what else PDAL, CloudCompare, LAStools and laspy call them.
constexpr std::pair<Name, Name> kLasFields[] = {{"gpstime", "gps_time"},
                                                {"userdata", "user_data"},
                                                {"pointsourceid", "point_source_id"},
                                                {"scanangle", "scan_angle"},
                                                {"scananglerank", "scan_angle"},
                                                {"synthetic", "synthetic"},
                                                {"keypoint", "key_point"},
                                                {"overlap", "overlap"},
                                                {"scannerchannel", "scanner_channel"},
                                                {"scanchannel", "scanner_channel"},
                                                {"scandirectionflag", "scan_direction_flag"},
                                                {"edgeofflightline", "edge_of_flight_line"},
                                                {"nir", "nir"},
                                                {"infrared", "nir"},
                                                {"nearinfrared", "nir"}};

// Names with a meaning of their own that are near to the names above.
constexpr Name kOtherNames[] = {"distance", "returns",   "timestart", "timestep",   "originid",
                                "pointid",  "clusterid", "deviation", "reliability"};

std::span<const Name> names_of_meaning(PointColumn meaning) {
  for (const auto& [each, names] : kColumnNames)
    if (each == meaning) return names;
  return {};
}

std::string letters_of_name(std::string_view name) {
  std::string lower = lower_case(name);
  constexpr Name kPrefix = "scalar_";
  if (lower.starts_with(kPrefix) && lower.size() > kPrefix.size()) lower.erase(0, kPrefix.size());
  std::erase_if(lower, [](char c) { return !((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')); });
  return lower;
}

bool is_name_among(std::string_view plain, std::span<const Name> names) {
  return std::ranges::find(names, plain) != names.end();
}

/// A name of times and the unit behind it; {name, 1} without one.
std::pair<std::string, double> split_time_unit(std::string plain) {
  if (is_name_among(plain, kTimeNames)) return {std::move(plain), 1};
  for (const auto& [unit, seconds] : kTimeSuffixes) {
    if (!plain.ends_with(unit)) continue;
    std::string name = plain.substr(0, plain.size() - unit.size());
    if (is_name_among(name, kTimeNames)) return {std::move(name), seconds};
  }
  return {std::move(plain), 1};
}

/// Whether at most `edits` letters have to be replaced, inserted or removed.
bool is_within_edits(std::string_view a, std::string_view b, std::size_t edits) {
  while (!a.empty() && !b.empty() && a.front() == b.front()) {
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() || b.empty()) return a.size() + b.size() <= edits;
  if (edits == 0) return false;
  const std::string_view rest_of_a = a.substr(1), rest_of_b = b.substr(1);
  return is_within_edits(rest_of_a, rest_of_b, edits - 1) ||
         is_within_edits(rest_of_a, b, edits - 1) || is_within_edits(a, rest_of_b, edits - 1);
}

bool has_negative(const Column& column) {
  return std::visit(
      [](const auto& values) {
        return std::ranges::any_of(values, [](auto value) { return value < decltype(value){}; });
      },
      column.values);
}

bool is_all_zero(const Column& column) {
  return std::visit(
      [](const auto& values) {
        return std::ranges::all_of(values, [](auto value) { return value == decltype(value){}; });
      },
      column.values);
}

/// The first by its names that is neither in decibels nor 0 throughout; else the first that is not
/// in decibels.
const Column* find_intensity(const Table& table) {
  const Column* zeros = nullptr;
  for (const Name name : kIntensityNames)
    for (const Column& column : table.columns) {
      if (letters_of_name(column.name) != name || is_in_decibels(column)) continue;
      if (!is_all_zero(column)) return &column;
      if (zeros == nullptr) zeros = &column;
    }
  return zeros;
}

/// A name of times and what follows it; {name, ""} if nothing does.
std::pair<std::string, std::string> split_suffix(const std::string& plain) {
  for (const auto& [unit, seconds] : kTimeSuffixes)
    if (plain.ends_with(unit))
      return {plain.substr(0, plain.size() - unit.size()), std::string(unit)};
  return {plain, {}};
}

}  // namespace

bool is_in_decibels(const Column& column) {
  return is_name_among(letters_of_name(column.name), kDecibelNames) && has_negative(column);
}

std::string las_field_name(std::string_view name) {
  const std::string plain = letters_of_name(name);
  if (is_name_among(plain, kReturnNames)) return "return_number";
  if (is_name_among(plain, kReturnCounts)) return "number_of_returns";
  for (const auto& [other, field] : kLasFields)
    if (plain == other) return std::string(field);
  return lower_case(name);
}

bool is_known_column(std::string_view name) {
  const std::string plain = split_time_unit(letters_of_name(name)).first;
  return std::ranges::any_of(kColumnNames,
                             [&](const auto& known) { return is_name_among(plain, known.second); });
}

const Column* nanoseconds_beside(const Table& table, const Column& seconds) {
  constexpr double kSecond_ns = 1e9;
  const auto [name, unit] = split_suffix(letters_of_name(seconds.name));
  if (unit.empty() || time_unit_of_name("time" + unit) != 1) return nullptr;
  for (const Column& column : table.columns) {
    const auto [other, unit_of_other] = split_suffix(letters_of_name(column.name));
    if (other != name || unit_of_other.empty() || time_unit_of_name("time" + unit_of_other) == 1)
      continue;
    if (time_unit_of_name("time" + unit_of_other) != 1e-9) continue;
    bool is_fraction = true;
    for (std::size_t i = 0; i < column.size() && is_fraction; ++i) {
      const double value = column.as_double(i);
      is_fraction = value >= 0 && value < kSecond_ns;
    }
    if (is_fraction) return &column;
  }
  return nullptr;
}

const Column* find_column(const Table& table, PointColumn meaning) {
  if (meaning == PointColumn::intensity) return find_intensity(table);
  std::vector<std::string> plain;
  for (const Column& column : table.columns) {
    plain.push_back(letters_of_name(column.name));
    if (meaning == PointColumn::time) plain.back() = split_time_unit(plain.back()).first;
  }
  const bool has_texture = std::ranges::find(plain, "s") != plain.end();
  for (const Name name : names_of_meaning(meaning)) {
    if (meaning == PointColumn::time && name == "t" && has_texture) continue;
    const auto found = std::ranges::find(plain, name);
    if (found == plain.end()) continue;
    const Column& first = table.columns[static_cast<std::size_t>(found - plain.begin())];
    if (meaning == PointColumn::time)
      for (const Column& column : table.columns)
        if (nanoseconds_beside(table, column) == &first) return &column;
    return &first;
  }
  return nullptr;
}

double time_unit_of_name(std::string_view name) {
  return split_time_unit(letters_of_name(name)).second;
}

std::optional<std::string> likely_column_name(std::string_view name) {
  constexpr std::size_t kShortest = 5;  // shorter words are near to too many others
  constexpr std::size_t kLong = 8;      // two edits of shorter words make other words
  const std::string plain = split_time_unit(letters_of_name(name)).first;
  if (plain.size() < kShortest || is_name_among(plain, kOtherNames)) return std::nullopt;
  if (las_field_name(name) != lower_case(name)) return std::nullopt;
  std::vector<std::string> known;
  for (const auto& [meaning, names] : kColumnNames) {
    if (is_name_among(plain, names)) return std::nullopt;
    if (meaning == PointColumn::scan_index) continue;  // of our own files; near to scan_angle
    for (const Name each : names)
      if (each.size() >= kShortest) known.emplace_back(each);
  }
  auto nearest = nearest_word(plain, known);
  if (!nearest || !is_within_edits(plain, *nearest, plain.size() < kLong ? 1 : 2))
    return std::nullopt;
  return nearest;
}

}  // namespace adasplats
