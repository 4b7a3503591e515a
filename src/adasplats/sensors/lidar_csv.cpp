// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor as a list of rays: azimuth_deg, elevation_deg[, time_s[, ring]].

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

constexpr std::array<std::string_view, 4> kFields = {"azimuth_deg", "elevation_deg", "time_s",
                                                     "ring"};

/// Longer than any scan of a stationary scanner, and small enough for a float to resolve seconds.
constexpr double kLongestScan_s = 86'400;
constexpr double kMaxScans_hz = 1e6;  // as in TOML files

std::uint16_t parse_ring(std::string_view text, const FilePosition& place) {
  const std::optional<std::uint16_t> ring = parse_number<std::uint16_t>(text);
  if (!ring)
    throw data_error(place, "ring is " + shown(text) + ", not a whole number from 0 to 65535");
  return *ring;
}

/// The column of each of kFields; -1: none.
using Columns = std::array<int, kFields.size()>;

/// Reads the names of the columns, in any order; nothing if the line is a ray.
std::optional<Columns> read_header(std::string_view line, const FilePosition& place) {
  const std::vector<std::string_view> names = fields_of(line, ',');
  if (parse_number<double>(names.front())) return std::nullopt;
  const auto starts_with_letter = [](std::string_view name) {
    return !name.empty() &&
           ((name[0] >= 'a' && name[0] <= 'z') || (name[0] >= 'A' && name[0] <= 'Z'));
  };
  if (!std::ranges::all_of(names, starts_with_letter)) return std::nullopt;
  Columns columns;
  columns.fill(-1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto field = std::ranges::find(kFields, lower_case(names[i]));
    if (field == kFields.end()) {
      const auto nearest = nearest_word(std::string(names[i]), {kFields.begin(), kFields.end()});
      throw data_error(place,
                       "unknown column " + shown(names[i]) +
                           (nearest ? ", did you mean '" + *nearest + "'?"
                                    : ", expected azimuth_deg, elevation_deg, time_s, ring"));
    }
    int& column = columns[static_cast<std::size_t>(field - kFields.begin())];
    if (column >= 0) throw data_error(place, "two columns " + shown(names[i]));
    column = static_cast<int>(i);
  }
  for (const std::size_t needed : {0, 1})
    if (columns[needed] < 0)
      throw data_error(place, "no column '" + std::string(kFields[needed]) + "'");
  return columns;
}

Firing parse_ray(std::string_view line, const Columns& columns, std::uint32_t index,
                 const FilePosition& place) {
  const std::vector<std::string_view> fields = fields_of(line, ',');
  const auto has = [&](std::size_t field) {
    return columns[field] >= 0 && static_cast<std::size_t>(columns[field]) < fields.size();
  };
  const auto max_fields = static_cast<std::size_t>(*std::ranges::max_element(columns)) + 1;
  if (!has(0) || !has(1) || fields.size() > max_fields)
    throw data_error(place, std::to_string(fields.size()) +
                                " values, expected azimuth_deg, elevation_deg[, time_s[, ring]]");
  const auto number = [&](std::size_t field) {
    return finite_number(fields[static_cast<std::size_t>(columns[field])], kFields[field], place);
  };
  const double time_s = has(2) ? number(2) : 0.0;
  if (!(time_s >= 0))
    throw data_error(place, "time_s is negative, expected seconds since the start of the scan");
  if (time_s > kLongestScan_s)
    throw data_error(place, "time_s is " + shown(fields[static_cast<std::size_t>(columns[2])]) +
                                ", expected seconds since the start of the scan, at most a day");
  const std::uint16_t ring =
      has(3) ? parse_ring(fields[static_cast<std::size_t>(columns[3])], place) : std::uint16_t{0};
  return {direction_of(radians(number(0)), radians(number(1))),
          ring,
          index,
          static_cast<float>(time_s),
          {}};
}

/// Scans per second: a scan ends one mean interval after its last firing time. 10 if all rays have
/// the same time.
double rotation_hz_of(const std::vector<Firing>& firings) {
  std::vector<float> times_s;
  times_s.reserve(firings.size());
  for (const Firing& firing : firings) times_s.push_back(firing.time_s);
  std::ranges::sort(times_s);
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  if (times_s.size() < 2) return 10.0;
  const auto last_s = static_cast<double>(times_s.back());
  const auto gaps = static_cast<double>(times_s.size() - 1);
  return 1.0 / (last_s + (last_s - static_cast<double>(times_s.front())) / gaps);
}

}  // namespace

LidarFile read_lidar_csv(std::string_view text, const std::filesystem::path& path) {
  LidarFile file;
  file.model.name = path.stem().string();
  file.model.source = path.filename().string();
  std::vector<Firing>& firings = file.model.free_pattern;
  Columns columns = {0, 1, 2, 3};
  FilledLines lines(text, path);
  bool first = true;
  while (const auto line = lines.next()) {
    if (first) {
      first = false;
      const std::string word = lower_case(fields_of(*line, ',').front());
      if (word == "channel" || word.starts_with("laser") || word == "operational state" ||
          word == "eeff")
        return read_hesai_csv(text, path);
      if (const auto header = read_header(*line, lines.place())) {
        columns = *header;
        continue;
      }
    }
    if (firings.size() >= std::numeric_limits<std::uint32_t>::max())
      throw data_error(lines.place(), "more than 2^32 - 1 rays");
    firings.push_back(
        parse_ray(*line, columns, static_cast<std::uint32_t>(firings.size()), lines.place()));
  }
  if (firings.empty()) throw data_error({path, {}, {}}, "no rays");
  file.model.rotation_hz = rotation_hz_of(firings);
  if (file.model.rotation_hz > kMaxScans_hz)
    throw data_error({path, {}, {}},
                     "the times yield " + exact_text(file.model.rotation_hz) +
                         " scans a second, expected at most a million: time_s is in seconds");
  return file;
}

}  // namespace adasplats
