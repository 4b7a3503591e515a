// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A sensor as a list of rays: azimuth_deg, elevation_deg[, time_s[, ring]]; and the tables of
// livox_laser_simulation: Time/s, Azimuth/deg, Zenith/deg.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "adasplats/core/maths/median.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

using Word = std::string_view;

enum class RayColumn : std::uint8_t { azimuth, elevation, time, ring };
constexpr std::array<Word, 4> kFields = {"azimuth_deg", "elevation_deg", "time_s", "ring"};

struct RayName {
  Word word;
  RayColumn column;
  bool is_zenith = false;  ///< the angle from +z: 90 degrees minus the elevation
};
constexpr RayName kRayNames[] = {{"azimuth", RayColumn::azimuth},
                                 {"elevation", RayColumn::elevation},
                                 {"zenith", RayColumn::elevation, true},
                                 {"time", RayColumn::time},
                                 {"timestamp", RayColumn::time},
                                 {"offset_time", RayColumn::time},
                                 {"ring", RayColumn::ring},
                                 {"line", RayColumn::ring},
                                 {"laser", RayColumn::ring},
                                 {"laser_id", RayColumn::ring}};
constexpr double kRadian_deg = 180 / std::numbers::pi;
/// The factor to degrees or seconds.
struct RayUnit {
  Word word;
  double factor;
  bool is_angle;
};
constexpr RayUnit kRayUnits[] = {{"deg", 1, true},
                                 {"degree", 1, true},
                                 {"degrees", 1, true},
                                 {"rad", kRadian_deg, true},
                                 {"radian", kRadian_deg, true},
                                 {"radians", kRadian_deg, true},
                                 {"s", 1, false},
                                 {"sec", 1, false},
                                 {"ms", 1e-3, false},
                                 {"us", 1e-6, false},
                                 {"ns", 1e-9, false}};
constexpr double kLivoxScans_hz = 10;
/// Points a second of Livox's sensors (their user manuals), by words in file names.
constexpr std::pair<Word, double> kLivoxRates_hz[] = {
    {"mid40", 100e3}, {"mid-40", 100e3},  {"mid70", 100e3}, {"mid-70", 100e3},
    {"avia", 240e3},  {"horizon", 240e3}, {"tele", 240e3},  {"hap", 452e3}};
constexpr double kMid360Rate_hz = 200e3;

/// Longer than any scan of a stationary scanner, and small enough for a float to resolve seconds.
constexpr double kLongestScan_s = 86'400;
constexpr double kMaxScans_hz = 1e6;  // as in TOML files

std::uint16_t parse_ring(std::string_view text, const FilePosition& place) {
  const std::optional<std::uint16_t> ring = parse_number<std::uint16_t>(text);
  if (!ring)
    throw data_error(place, "ring is " + shown(text) + ", not a whole number from 0 to 65535");
  return *ring;
}

/// The columns of a table; an index of -1: none.
struct Columns {
  std::array<int, kFields.size()> of = {0, 1, 2, 3};
  std::array<double, kFields.size()> factors = {1, 1, 1, 1};
  bool is_zenith = false;
  bool has_units = false;      ///< of the angles
  bool has_time_unit = false;  ///< or the table has no names, which means seconds
};

/// "Zenith/deg", "zenith [deg]", "zenith_deg": a name, and the unit behind it.
std::pair<std::string, std::string> split_ray_name(std::string_view field) {
  std::string name = lower_case(field);
  while (!name.empty() && (name.back() == ']' || name.back() == ')')) name.pop_back();
  const std::size_t at = name.find_last_of("/[(_ ");
  if (at == std::string::npos) return {name, ""};
  const std::string unit = name.substr(at + 1);
  if (std::ranges::find(kRayUnits, unit, &RayUnit::word) == std::end(kRayUnits)) return {name, ""};
  name.resize(name.find_last_not_of("/[(_ ", at) + 1);
  return {name, unit};
}

void take_name(std::string_view field, int index, const FilePosition& place, Columns& columns) {
  const auto [word, unit_word] = split_ray_name(field);
  const auto* const name = std::ranges::find(kRayNames, word, &RayName::word);
  const auto* const unit = std::ranges::find(kRayUnits, unit_word, &RayUnit::word);
  const bool has_unit = unit != std::end(kRayUnits);
  const auto takes_unit = [](RayColumn column, bool is_angle) {
    return column != RayColumn::ring && is_angle == (column != RayColumn::time);
  };
  if (name == std::end(kRayNames) || (has_unit && !takes_unit(name->column, unit->is_angle))) {
    const auto nearest = nearest_word(lower_case(field), {kFields.begin(), kFields.end()});
    throw data_error(place, "unknown column " + shown(field) +
                                (nearest ? ", did you mean '" + *nearest + "'?"
                                         : ", expected azimuth_deg, elevation_deg (or zenith_deg), "
                                           "time_s, ring"));
  }
  const auto column = static_cast<std::size_t>(name->column);
  if (columns.of[column] >= 0) throw data_error(place, "two columns " + shown(field));
  columns.of[column] = index;
  if (name->is_zenith) columns.is_zenith = true;
  if (!has_unit) return;
  columns.factors[column] = unit->factor;
  (unit->is_angle ? columns.has_units : columns.has_time_unit) = true;
}

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
  columns.of.fill(-1);
  for (std::size_t i = 0; i < names.size(); ++i)
    take_name(names[i], static_cast<int>(i), place, columns);
  for (const std::size_t needed : {0, 1})
    if (columns.of[needed] < 0)
      throw data_error(place, "no column '" + std::string(kFields[needed]) + "'");
  return columns;
}

/// Elevation in degrees of an angle in the unit of its column.
double elevation_deg(double angle, const Columns& columns, std::string_view text,
                     const FilePosition& place) {
  const double turned_deg = columns.factors[1] * angle;
  const double elevation = columns.is_zenith ? 90 - turned_deg : turned_deg;
  constexpr double kRounding_deg = 1e-3;
  if (std::fabs(elevation) > 90 + kRounding_deg)
    throw data_error(place, (columns.is_zenith ? "zenith is " : "elevation is ") + shown(text) +
                                ", expected " + (columns.is_zenith ? "0 to 180" : "-90 to 90") +
                                " degrees");
  return elevation;
}

/// A ray, with the time in double precision.
struct TimedRay {
  Firing firing;
  double azimuth_deg = 0, elevation_deg = 0, time_s = 0;
  double time = 0;  ///< as written
  std::size_t fields = 0;
};

TimedRay parse_ray(std::string_view line, const Columns& columns, std::uint32_t index,
                   const FilePosition& place) {
  const std::vector<std::string_view> fields = fields_of(line, ',');
  const auto has = [&](std::size_t field) {
    return columns.of[field] >= 0 && static_cast<std::size_t>(columns.of[field]) < fields.size();
  };
  const auto max_fields = static_cast<std::size_t>(*std::ranges::max_element(columns.of)) + 1;
  if (!has(0) || !has(1) || fields.size() > max_fields)
    throw data_error(place, std::to_string(fields.size()) +
                                " values, expected azimuth_deg, elevation_deg[, time_s[, ring]]");
  const auto text = [&](std::size_t field) {
    return fields[static_cast<std::size_t>(columns.of[field])];
  };
  const auto number = [&](std::size_t field) {
    return finite_number(text(field), kFields[field], place);
  };
  TimedRay ray;
  ray.fields = fields.size();
  ray.time = has(2) ? number(2) : 0.0;
  ray.time_s = columns.factors[2] * ray.time;
  if (!(ray.time_s >= 0))
    throw data_error(place, "time_s is negative, expected seconds since the start of the scan");
  if (ray.time_s > kLongestScan_s && !columns.is_zenith)
    throw data_error(place, "time_s is " + shown(text(2)) +
                                ", expected seconds since the start of the scan, at most a day");
  const std::uint16_t ring = has(3) ? parse_ring(text(3), place) : std::uint16_t{0};
  ray.azimuth_deg = columns.factors[0] * number(0);
  ray.elevation_deg = elevation_deg(number(1), columns, text(1), place);
  ray.firing = {direction_of(radians(ray.azimuth_deg), radians(ray.elevation_deg)),
                ring,
                index,
                static_cast<float>(ray.time_s),
                {}};
  return ray;
}

/// Rejects tables whose angles were not filled in, or are in another unit.
class RayAngles {
 public:
  void add(const TimedRay& ray, bool is_zenith) {
    ++count_;
    azimuth_ = std::max(azimuth_, std::fabs(ray.azimuth_deg));
    const double up = is_zenith ? 90 - ray.elevation_deg : ray.elevation_deg;
    elevation_ = std::max(elevation_, std::fabs(up));
  }
  /// Narrow patterns with a stated unit are possible, a sensor that looks only upwards is not.
  std::optional<std::string> fault(const Columns& columns) const {
    constexpr std::size_t kMinRays = 16;
    constexpr double kTurn = 2 * std::numbers::pi + 1e-3;
    if (count_ < kMinRays) return std::nullopt;
    if (azimuth_ == 0 && elevation_ == 0) return "all angles are 0";
    const bool in_degrees = columns.factors[0] == 1 && columns.factors[1] == 1;
    const bool may_be_narrow = columns.has_units && !columns.is_zenith;
    const double max_elevation = columns.is_zenith ? kTurn / 2 : kTurn / 4;
    if (!in_degrees || may_be_narrow || azimuth_ > kTurn || elevation_ > max_elevation)
      return std::nullopt;
    return "its angles are at most " + exact_text(azimuth_) + " and " + exact_text(elevation_) +
           " degrees, are they in radians? Name the columns azimuth_rad, elevation_rad (or "
           "zenith_rad), or azimuth_deg, elevation_deg";
  }

 private:
  std::size_t count_ = 0;
  double azimuth_ = 0, elevation_ = 0;
};

/// Recognises tables without names whose first column is the time: it ascends from ray to ray, and
/// the third one goes up and down.
class ColumnOrder {
 public:
  void add(const TimedRay& ray) {
    if (count_++ > 0) {
      ascends_ = ascends_ && ray.azimuth_deg > last_.azimuth_deg;
      has_later_ = has_later_ || ray.time > last_.time;
      has_earlier_ = has_earlier_ || ray.time < last_.time;
    }
    last_ = ray;
  }
  bool begins_with_time() const {
    constexpr std::size_t kMinRays = 16;
    return count_ >= kMinRays && ascends_ && has_later_ && has_earlier_;
  }

 private:
  std::size_t count_ = 0;
  bool ascends_ = true, has_later_ = false, has_earlier_ = false;
  TimedRay last_;
};

/// Recognises tables without names that may be the channels of a sensor, one elevation and azimuth
/// each (Robosense's angle.csv), instead of rays.
class ChannelTable {
 public:
  void add(const TimedRay& ray) {
    ++count_;
    constexpr std::size_t kAngles = 2;
    may_be_ = may_be_ && ray.fields == kAngles && std::fabs(ray.azimuth_deg) <= 90 &&
              count_ <= kChannels.back() && first_angles_.insert(ray.azimuth_deg).second;
  }
  bool is_possible() const {
    return may_be_ && std::ranges::find(kChannels, count_) != kChannels.end();
  }
  std::size_t count() const { return count_; }

 private:
  static constexpr std::array<std::size_t, 7> kChannels = {16, 32, 40, 48, 64, 80, 128};
  bool may_be_ = true;
  std::size_t count_ = 0;
  std::set<double> first_angles_;
};

/// Rejects times without a stated unit that are too far apart to be seconds.
void require_seconds(std::vector<Firing> firings, const std::filesystem::path& path) {
  constexpr std::size_t kMinRays = 16;
  constexpr double kMaxStep_s = 1e-3, kShortest_s = 2e-7, kLongest_s = 2e-4;
  if (firings.size() < kMinRays) return;
  std::ranges::sort(firings, {}, &Firing::time_s);
  std::vector<double> steps;
  for (std::size_t i = 1; i < firings.size(); ++i)
    if (firings[i].time_s > firings[i - 1].time_s)
      steps.push_back(static_cast<double>(firings[i].time_s) -
                      static_cast<double>(firings[i - 1].time_s));
  if (steps.empty()) return;
  const double step = upper_median_of(steps);
  if (step <= kMaxStep_s) return;
  std::string_view unit = "ms";
  for (const auto& [word, factor, is_angle] : kRayUnits)
    if (!is_angle && factor * step >= kShortest_s && factor * step < kLongest_s) unit = word;
  throw data_error({path, {}, {}}, "the column of times has no unit, and its rows are " +
                                       exact_text(step) + " apart, expected at most " +
                                       exact_text(kMaxStep_s) + " s; name the unit, such as time_" +
                                       std::string(unit));
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

/// The times of Livox's tables, in order. In some of them the column of times numbers the rows:
/// then the points a second of the sensor in the file's name, or of a Mid-360, give the times.
void set_livox_times(bool are_row_numbers, const std::filesystem::path& path, LidarModel& model) {
  std::vector<Firing>& firings = model.free_pattern;
  if (are_row_numbers) {
    const std::string name = lower_case(path.filename().string());
    double rate_hz = kMid360Rate_hz;
    for (const auto& [word, each_hz] : kLivoxRates_hz)
      if (name.find(word) != std::string::npos) rate_hz = each_hz;
    for (std::size_t i = 0; i < firings.size(); ++i)
      firings[i].time_s = static_cast<float>(static_cast<double>(i) / rate_hz);
    model.source += ", " + decimal_text(rate_hz) + " rows per second";
  }
  std::ranges::stable_sort(firings, {}, &Firing::time_s);
  for (std::uint32_t i = 0; i < firings.size(); ++i) firings[i].column = i;
  if (static_cast<double>(firings.back().time_s) > kLongestScan_s)
    throw data_error({path, {}, {}}, "its times reach " +
                                         exact_text(static_cast<double>(firings.back().time_s)) +
                                         " s, expected at most a day");
}

/// Sets how long the pattern and a scan last.
void set_scan_length(const Columns& columns, bool are_row_numbers,
                     const std::filesystem::path& path, LidarModel& model) {
  std::vector<Firing>& firings = model.free_pattern;
  const bool is_livox = columns.is_zenith && columns.of[2] >= 0;
  if (!columns.has_time_unit && !are_row_numbers) require_seconds(firings, path);
  if (is_livox) set_livox_times(are_row_numbers, path, model);
  model.rotation_hz = rotation_hz_of(firings);
  if (model.rotation_hz > kMaxScans_hz)
    throw data_error({path, {}, {}},
                     "the times yield " + exact_text(model.rotation_hz) +
                         " scans a second, expected at most a million: time_s is in seconds");
  if (std::ranges::is_sorted(firings, {}, &Firing::time_s)) model.pattern_s = 1 / model.rotation_hz;
  if (is_livox) model.rotation_hz = kLivoxScans_hz;
}

}  // namespace

LidarFile read_lidar_csv(std::string_view text, const std::filesystem::path& path) {
  LidarFile file;
  file.model.name = path.stem().string();
  file.model.source = path.filename().string();
  std::vector<Firing>& firings = file.model.free_pattern;
  Columns columns;
  columns.has_time_unit = true;  // documented, unless names say otherwise
  RayAngles angles;
  ColumnOrder order;
  ChannelTable channels;
  bool has_names = false;
  double first_time = 0;
  bool are_row_numbers = true;
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
        has_names = true;
        continue;
      }
    }
    if (firings.size() >= std::numeric_limits<std::uint32_t>::max())
      throw data_error(lines.place(), "more than 2^32 - 1 rays");
    const TimedRay ray =
        parse_ray(*line, columns, static_cast<std::uint32_t>(firings.size()), lines.place());
    angles.add(ray, columns.is_zenith);
    order.add(ray);
    channels.add(ray);
    if (firings.empty()) first_time = ray.time;
    are_row_numbers =
        are_row_numbers && ray.time == first_time + static_cast<double>(firings.size());
    firings.push_back(ray.firing);
  }
  if (firings.empty()) throw data_error({path, {}, {}}, "no rays");
  if (!has_names && order.begins_with_time())
    throw data_error(
        {path, {}, {}},
        "column 1 ascends from ray to ray like a time, and column 3 does not; name the "
        "columns in a first line, such as Time/s,Azimuth/deg,Zenith/deg");
  if (const auto fault = angles.fault(columns)) throw data_error({path, {}, {}}, *fault);
  if (!has_names && channels.is_possible())
    throw data_error(
        {path, {}, {}},
        std::to_string(channels.count()) +
            " lines of two angles without names are rays (azimuth, elevation) or channels "
            "(elevation, azimuth, as in Robosense's angle.csv); name the columns in a first line: "
            "azimuth_deg,elevation_deg for rays, or Channel,Elevation,Azimuth with numbers of "
            "channels");
  set_scan_length(columns, are_row_numbers, path, file.model);
  return file;
}

}  // namespace adasplats
