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

/// Of PDAL and Entwine, near to names above.
constexpr Name kUnrelatedNames[] = {"originid", "pointid", "clusterid", "deviation", "reliability"};

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

constexpr std::pair<Name, double> kTimeSuffixes[] = {
    {"nanoseconds", 1e-9}, {"microseconds", 1e-6}, {"milliseconds", 1e-3}, {"seconds", 1},
    {"nsec", 1e-9},        {"usec", 1e-6},         {"msec", 1e-3},         {"sec", 1},
    {"ns", 1e-9},          {"us", 1e-6},           {"ms", 1e-3},           {"s", 1}};

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

}  // namespace

const Column* find_column(const Table& table, PointColumn meaning) {
  std::vector<std::string> plain;
  for (const Column& column : table.columns) {
    plain.push_back(letters_of_name(column.name));
    if (meaning == PointColumn::time) plain.back() = split_time_unit(plain.back()).first;
  }
  const bool has_texture = std::ranges::find(plain, "s") != plain.end();
  for (const Name name : names_of_meaning(meaning)) {
    if (meaning == PointColumn::time && name == "t" && has_texture) continue;
    const auto found = std::ranges::find(plain, name);
    if (found != plain.end())
      return &table.columns[static_cast<std::size_t>(found - plain.begin())];
  }
  return nullptr;
}

double time_unit_of_name(std::string_view name) {
  return split_time_unit(letters_of_name(name)).second;
}

std::optional<std::string> likely_column_name(std::string_view name) {
  constexpr std::size_t kShortest = 5;  // shorter words are near to too many others
  const std::string plain = split_time_unit(letters_of_name(name)).first;
  if (plain.size() < kShortest || is_name_among(plain, kUnrelatedNames)) return std::nullopt;
  std::vector<std::string> known;
  for (const auto& [meaning, names] : kColumnNames) {
    if (is_name_among(plain, names)) return std::nullopt;
    if (meaning == PointColumn::scan_index) continue;  // of our own files; near to scan_angle
    for (const Name each : names)
      if (each.size() >= kShortest) known.emplace_back(each);
  }
  constexpr std::size_t kMaxOtherLength = 2;
  auto nearest = nearest_word(plain, known);
  if (!nearest || std::max(nearest->size(), plain.size()) >
                      std::min(nearest->size(), plain.size()) + kMaxOtherLength)
    return std::nullopt;
  return nearest;
}

}  // namespace adasplats
