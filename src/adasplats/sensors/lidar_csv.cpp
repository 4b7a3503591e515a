// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor as a list of rays: azimuth_deg, elevation_deg[, time_s[, ring]].

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/core/error.h"
#include "adasplats/io/atomic_file.h"
#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

constexpr std::array<std::string_view, 4> kFields = {"azimuth_deg", "elevation_deg", "time_s",
                                                     "ring"};

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Takes what stands before `separator` off the front of `rest`.
std::string_view take(std::string_view& rest, char separator) {
  const std::size_t end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return part;
}

/// What a line may hold, for messages: 40 characters are enough to find it.
std::string shown(std::string_view text) {
  return "'" + std::string(text.substr(0, 40)) + (text.size() > 40 ? "...'" : "'");
}

double parse_number(std::string_view text, std::string_view field, const FilePlace& place) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw data_error(place, std::string(field) + " is " + shown(text) + ", not a finite number");
  return value;
}

std::uint16_t parse_ring(std::string_view text, const FilePlace& place) {
  std::uint16_t ring = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), ring);
  if (status != std::errc() || end != text.data() + text.size())
    throw data_error(place, "ring is " + shown(text) + ", not a whole number from 0 to 65535");
  return ring;
}

/// The line with the names of its columns: the first ones of kFields.
bool is_header(std::string_view line) {
  std::size_t column = 0;
  for (std::string_view rest = line; !rest.empty(); ++column)
    if (column >= kFields.size() || trimmed(take(rest, ',')) != kFields[column]) return false;
  return column >= 2;
}

Firing parse_ray(std::string_view line, std::uint32_t index, const FilePlace& place) {
  std::array<std::string_view, kFields.size()> fields;
  std::size_t count = 0;
  bool more = true;
  for (std::string_view rest = line; more; ++count) {
    more = rest.find(',') != std::string_view::npos;
    const std::string_view field = trimmed(take(rest, ','));
    if (count < fields.size()) fields[count] = field;
  }
  if (count < 2 || count > fields.size())
    throw data_error(place, std::to_string(count) +
                                " values, expected azimuth_deg, elevation_deg[, time_s[, ring]]");
  const double azimuth_deg = parse_number(fields[0], kFields[0], place);
  const double elevation_deg = parse_number(fields[1], kFields[1], place);
  const double time_s = count > 2 ? parse_number(fields[2], kFields[2], place) : 0.0;
  const std::uint16_t ring = count > 3 ? parse_ring(fields[3], place) : std::uint16_t{0};
  return {direction_of(radians(azimuth_deg), radians(elevation_deg)), ring, index,
          static_cast<float>(time_s)};
}

}  // namespace

LidarModel read_lidar_csv(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  LidarModel model;
  model.name = path.stem().string();
  FilePlace place{path, std::nullopt, 0};
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of spreadsheets
  while (!rest.empty()) {
    place.line = *place.line + 1;
    const std::string_view line = trimmed(take(rest, '\n'));
    if (line.empty() || line.front() == '#') continue;
    if (model.free_pattern.empty() && is_header(line)) continue;
    if (model.free_pattern.size() >= std::numeric_limits<std::uint32_t>::max())
      throw data_error(place, "more than 2^32 - 1 rays");
    model.free_pattern.push_back(
        parse_ray(line, static_cast<std::uint32_t>(model.free_pattern.size()), place));
  }
  if (model.free_pattern.empty()) throw data_error({path, {}, {}}, "a pattern with no rays");
  return model;
}

}  // namespace adasplats
