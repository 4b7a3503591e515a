// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The correction files of Hesai sensors: a CSV of angles (Channel, Elevation, Azimuth) and, in the
// same folder, a CSV of firing times with "firetime" instead of "angle" in its name: (Channel, fire
// time(us)), or one column per azimuth state, "-" if a channel does not fire. A table of angles may
// begin with a line "EEFF,..." and end with a SHA-256, which is not checked: editors change line
// ends. Tables that end early are rejected by the number of channels and the last elevation.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/sensors/hesai_models.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

namespace fs = std::filesystem;

struct Channel {
  int number = 0;
  double elevation_deg = 0;
  double azimuth_deg = 0;
};

int channel_number(std::string_view text, const FilePosition& place) {
  const std::optional<int> number = parse_number<int>(text);
  if (!number || *number < 1 || *number > static_cast<int>(kMaxBeams))
    throw data_error(place, "channel is " + shown(text) + ", not a whole number from 1 to 65536");
  return *number;
}

/// Indices of the columns of angles.
struct AngleColumns {
  std::size_t elevation = 0;
  std::size_t azimuth = 0;
};

AngleColumns angle_columns(std::string_view header, const FilePosition& place) {
  AngleColumns columns;
  const auto names = fields_of(header, ',');
  for (std::size_t i = 1; i < names.size(); ++i) {
    const std::string name = lower_case(names[i]);
    if (name.starts_with("elevation")) columns.elevation = i;
    if (name.starts_with("azimuth")) columns.azimuth = i;
    if (name.starts_with("fire"))
      throw data_error(place,
                       "a table of firing times: expected the table of angles (\"angle\" instead "
                       "of \"firetime\" in its name); the times are found next to it");
  }
  if (columns.elevation == 0 || columns.azimuth == 0)
    throw data_error(place, "expected the columns Channel, Elevation, Azimuth");
  return columns;
}

double angle_deg(std::string_view text, std::string_view field, double limit,
                 const FilePosition& place) {
  const double angle = finite_number(text, field, place);
  if (!(std::fabs(angle) <= limit))
    throw data_error(place, std::string(field) + " is " + shown(text) + " degrees");
  return angle;
}

/// Newer files end with their SHA-256 digest.
bool is_digest(const std::vector<std::string_view>& fields) {
  constexpr std::size_t kDigits = 64;
  return fields.size() == 1 && fields[0].size() == kDigits &&
         fields[0].find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}
bool is_hesai_start(std::string_view line) { return lower_case(line).starts_with("eeff"); }

std::vector<Channel> read_angles(std::string_view text, const fs::path& path) {
  FilledLines lines(text, path);
  std::string_view header = lines.next().value_or("");
  if (is_hesai_start(header)) header = lines.next().value_or("");
  if (lower_case(header).starts_with("operational"))
    throw data_error(lines.place(), "a table of firing times: expected the table of angles");
  const AngleColumns columns = angle_columns(header, lines.place());
  std::vector<Channel> channels;
  while (const auto line = lines.next()) {
    const auto fields = fields_of(*line, ',');
    if (is_digest(fields)) continue;
    if (fields.size() <= std::max(columns.elevation, columns.azimuth))
      throw data_error(lines.place(), std::to_string(fields.size()) +
                                          " values, expected Channel, Elevation, Azimuth");
    const int number = channel_number(fields[0], lines.place());
    if (std::ranges::find(channels, number, &Channel::number) != channels.end())
      throw data_error(lines.place(), "channel " + std::to_string(number) + " occurs twice");
    channels.push_back({number,
                        angle_deg(fields[columns.elevation], "elevation", 90, lines.place()),
                        angle_deg(fields[columns.azimuth], "azimuth", 360, lines.place())});
  }
  if (channels.empty()) throw data_error({path, {}, {}}, "the table has no channels");
  const int last = std::ranges::max(channels, {}, &Channel::number).number;
  if (static_cast<std::size_t>(last) != channels.size())
    throw data_error({path, {}, {}}, "the table has " + std::to_string(channels.size()) +
                                         " channels, but their numbers go up to " +
                                         std::to_string(last) + "; expected 1, 2, 3, ...");
  return channels;
}

/// Rejects tables cut off at the end. Channels are numbered from the top to -12.5 degrees and
/// below, or from the bottom to +40 and above (QT, JT), in tables of these many.
void require_all_channels(const std::vector<Channel>& sorted, const fs::path& path) {
  constexpr std::array<std::size_t, 10> kCounts = {16, 20, 32, 40, 48, 64, 80, 90, 96, 128};
  constexpr double kLowest_deg = -12, kHighest_deg = 40;
  const std::string found = "the table ends with channel " + std::to_string(sorted.size()) +
                            " at elevation " + exact_text(sorted.back().elevation_deg);
  const std::string cause = "; is the file cut off at the end?";
  if (std::ranges::find(kCounts, sorted.size()) == kCounts.end()) {
    std::string counts;
    for (const std::size_t count : kCounts)
      counts += (counts.empty()            ? ""
                 : count == kCounts.back() ? " or "
                                           : ", ") +
                std::to_string(count);
    throw data_error({path, {}, {}}, found + ", expected " + counts + " channels" + cause);
  }
  const double last_deg = sorted.back().elevation_deg;
  const auto elevation = &Channel::elevation_deg;
  if (std::ranges::is_sorted(sorted, std::greater<>(), elevation) && last_deg > kLowest_deg)
    throw data_error({path, {}, {}}, found + " degrees, expected the last one below " +
                                         exact_text(kLowest_deg) + cause);
  if (std::ranges::is_sorted(sorted, {}, elevation) && last_deg < kHighest_deg)
    throw data_error({path, {}, {}}, found + " degrees, expected the last one above " +
                                         exact_text(kHighest_deg) + cause);
}

/// When a channel fires after the start of its column, and in which columns.
struct FiringTime {
  int channel = 0;
  double time_us = 0;
  std::uint32_t step = 1;
  std::uint32_t phase = 0;
};

/// Azimuth states count columns; those of the first operational state form one cycle.
FiringTime firing_of_states(const std::vector<std::string_view>& fields, std::size_t states,
                            const FilePosition& place) {
  FiringTime firing;
  std::vector<std::uint32_t> fires;
  for (std::size_t state = 0; state < states; ++state) {
    const std::string_view field = state + 1 < fields.size() ? fields[state + 1] : "-";
    if (field == "-" || field.empty()) continue;
    const double time_us = finite_number(field, "fire time", place);
    if (fires.empty()) firing.time_us = time_us;
    fires.push_back(static_cast<std::uint32_t>(state));
  }
  if (fires.empty()) throw data_error(place, "the channel never fires");
  if (states % fires.size() != 0) throw data_error(place, "the channel fires at uneven steps");
  firing.step = static_cast<std::uint32_t>(states / fires.size());
  firing.phase = fires.front();
  for (std::size_t i = 0; i < fires.size(); ++i)
    if (fires[i] != firing.phase + i * firing.step)
      throw data_error(place, "the channel fires at uneven steps");
  return firing;
}

/// The number of table columns of the first operational state.
std::size_t states_of(const std::vector<std::string_view>& operational, const FilePosition& place) {
  std::size_t states = 0;
  while (states + 1 < operational.size() && operational[states + 1] == operational[1]) ++states;
  if (states == 0) throw data_error(place, "no operational states");
  return states;
}

std::vector<FiringTime> read_firing_times(std::string_view text, const fs::path& path) {
  FilledLines lines(text, path);
  const auto header = fields_of(lines.next().value_or(""), ',');
  std::size_t states = 1;
  if (lower_case(header[0]).starts_with("operational")) {
    states = states_of(header, lines.place());
    lines.next();  // names of the azimuth states
  } else if (header.size() != 2 || !lower_case(header[1]).starts_with("fire")) {
    throw data_error(lines.place(), "expected the columns Channel, fire time(us)");
  }
  std::vector<FiringTime> times;
  while (const auto line = lines.next()) {
    const auto fields = fields_of(*line, ',');
    FiringTime firing = firing_of_states(fields, states, lines.place());
    firing.channel = channel_number(fields[0], lines.place());
    times.push_back(firing);
  }
  return times;
}

/// "X_firetime.csv" for "X_angle.csv"; nothing if no such file exists.
std::optional<fs::path> firing_time_file(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t at = lower_case(name).rfind("angle");
  if (at == std::string::npos) return std::nullopt;
  for (const char* word : {"firetime", "Firetime", "FireTime"}) {
    std::string sibling = name;
    sibling.replace(at, 5, word);
    std::error_code ignored;  // of names that are too long for a file
    if (fs::is_regular_file(path.parent_path() / sibling, ignored))
      return path.parent_path() / sibling;
  }
  return std::nullopt;
}

void add_firing_times(const fs::path& path, const std::vector<Channel>& channels, LidarFile& file) {
  const auto times = read_firing_times(read_file(path), path);
  double first_us = 0;
  for (const FiringTime& firing : times) first_us = std::min(first_us, firing.time_us);
  LidarModel& model = file.model;
  if (!(-1e-6 * first_us * model.rotation_hz < 1))
    throw data_error({path, {}, {}},
                     "a channel fires " + exact_text(-first_us) +
                         " us before its column starts, which is more than a revolution");
  for (const Channel& channel : channels) {
    const auto firing = std::ranges::find(times, channel.number, &FiringTime::channel);
    if (firing == times.end())
      throw data_error({path, {}, {}}, "no channel " + std::to_string(channel.number));
    model.firing_times_s.push_back(1e-6 * (firing->time_us - first_us));
    file.column_steps.push_back(firing->step);
    file.column_phases.push_back(firing->phase);
  }
  if (const auto fault = column_fault(model))
    throw data_error({path, {}, {}}, std::to_string(model.columns) + " columns " + *fault);
  // Times before the start of the block are shifted to 0, and the head's azimuth with them.
  model.first_azimuth_rad = -1e-6 * first_us * model.rotation_hz * 2 * std::numbers::pi;
}

/// A model without a library sensor: its columns, ranges and firing times.
LidarFile base_of_model(PacketFormat format) {
  LidarFile file = default_rotating_lidar();
  LidarModel& model = file.model;
  constexpr double kCount_m = 0.004;
  model.range_resolution_m = kCount_m;
  model.max_returns = 2;
  model.firing_times_s = hesai_firing_times_s(format);
  switch (format) {
    case PacketFormat::pandar_40p: model.max_range_m = 200; break;
    case PacketFormat::pandar_qt:
      model.columns = 600;
      model.max_range_m = 60;
      break;
    case PacketFormat::xt_16: model.columns = 2000; break;
    case PacketFormat::xt_32m:
      model.columns = 2000;
      model.max_range_m = 300;
      break;
    case PacketFormat::qt_128:
      model.columns = 900;
      model.max_range_m = 50;
      for (std::size_t laser = 0; laser < 128; ++laser) {
        const double first_s = late_s_of_qt128(0, laser), second_s = late_s_of_qt128(1, laser);
        model.firing_times_s.push_back(first_s > 0 ? first_s : second_s);
        file.column_steps.push_back(first_s > 0 && second_s > 0 ? 1 : 2);
        file.column_phases.push_back(first_s > 0 ? 0 : 1);
      }
      break;
    default: break;
  }
  return file;
}

LidarFile base_of_hesai(std::optional<PacketFormat> format, std::size_t channels) {
  if (format == PacketFormat::xt_32) return *read_library_lidar("hesai-pandarxt-32");
  if (format == PacketFormat::pandar_64) return *read_library_lidar("hesai-pandar64");
  // Also of a Pandar128E3X, whose packets are not supported.
  if (format == PacketFormat::ot_128 || (!format && channels == 128))
    return *read_library_lidar("hesai-ot128");
  return format ? base_of_model(*format) : default_rotating_lidar();
}

std::optional<PacketFormat> model_of(const std::vector<Channel>& sorted) {
  std::vector<double> elevations_deg, azimuths_deg;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (sorted[i].number != static_cast<int>(i + 1)) return std::nullopt;
    elevations_deg.push_back(sorted[i].elevation_deg);
    azimuths_deg.push_back(sorted[i].azimuth_deg);
  }
  return hesai_model_of(elevations_deg, azimuths_deg);
}

}  // namespace

LidarFile read_hesai_csv(std::string_view text, const fs::path& path) {
  std::vector<Channel> channels = read_angles(text, path);
  std::ranges::stable_sort(channels, {}, &Channel::number);
  const std::optional<PacketFormat> format = model_of(channels);
  auto times = firing_time_file(path);
  // A QT128's file has two sequences; they are the same for all units.
  if (times && is_hesai_start(read_file(*times))) times.reset();
  LidarFile file = base_of_hesai(format, channels.size());
  LidarFile base = file;
  file.clear_pattern();
  LidarModel& model = file.model;
  model.name = path.stem().string();
  model.source = path.filename().string() + (times ? ", " + times->filename().string() : "") +
                 (base.has_beams() ? ", like " + base.model.name : "");
  // The table's azimuths are added to the block's, clockwise from the sensor's front.
  for (const Channel& channel : channels) {
    model.elevations_rad.push_back(radians(channel.elevation_deg));
    model.azimuth_offsets_rad.push_back(-radians(channel.azimuth_deg));
  }
  for (const auto& fault : {angle_fault(model), degrees_fault(model)})
    if (fault) throw data_error({path, {}, {}}, *fault);
  require_all_channels(channels, path);
  if (format) {
    model.packets.emplace().format = *format;
    for (const Channel& channel : channels)
      model.packets->laser_ids.push_back(static_cast<std::uint32_t>(channel.number - 1));
  }
  if (times) {
    add_firing_times(*times, channels, file);
  } else if (base.model.firing_times_s.size() == channels.size()) {
    model.firing_times_s = std::move(base.model.firing_times_s);
    file.column_steps = std::move(base.column_steps);
    file.column_phases = std::move(base.column_phases);
  }
  return file;
}

}  // namespace adasplats
