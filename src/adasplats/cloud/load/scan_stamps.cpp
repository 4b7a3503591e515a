// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/scan_stamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/file_kind.h"
#include "adasplats/cloud/origins/track.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/error.h"
#include "adasplats/core/list_folder.h"
#include "adasplats/core/maths/median.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

// From sensors that turn 200 times a second to drives of which every hundredth scan was kept.
constexpr double kMinStep_s = 0.005, kMaxStep_s = 10;
constexpr std::array kStampUnits_s = {1.0, 1e-3, 1e-6, 1e-9};
constexpr std::size_t kStampDigits = 9;  // seconds since 1973

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The last number in a name, with its fraction.
std::string last_number(const std::string& stem) {
  const std::size_t end = stem.find_last_of("0123456789");
  if (end == std::string::npos) return {};
  std::size_t begin = end;
  bool has_point = false;
  while (begin > 0) {
    const char c = stem[begin - 1];
    const bool is_point = c == '.' && !has_point && begin >= 2 && is_digit(stem[begin - 2]);
    if (!is_digit(c) && !is_point) break;
    has_point = has_point || is_point;
    --begin;
  }
  return stem.substr(begin, end + 1 - begin);
}

/// "1583836591_182590976" (seconds and nanoseconds) becomes "1583836591.182590976".
std::string stamp_text(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::string number = last_number(stem);
  if (number.size() == kStampDigits && stem.size() > number.size()) {
    const std::string before = stem.substr(0, stem.size() - number.size());
    if (before.back() == '_' && stem.ends_with(number)) {
      const std::string seconds = last_number(before);
      if (seconds.size() >= kStampDigits && before.ends_with(seconds + "_"))
        return seconds + "." + number;
    }
  }
  return number;
}

double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  if (steps.empty()) return 0;
  return upper_median_of(steps);
}

bool ascend(const std::vector<double>& times) {
  return std::ranges::adjacent_find(times, std::greater_equal<>()) == times.end();
}

std::string seconds_text(double first_s, double last_s) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "%.3f to %.3f s", first_s, last_s);
  return text.data();
}

/// The poses at given times. Errors: data for times outside the track or in its gaps.
PosesOfFiles poses_at(const std::vector<double>& times_s, const Track& track,
                      const std::string& from, const fs::path& trajectory) {
  const TimeSpan covered = track.covered_s();
  PosesOfFiles poses{{}, track.poses, "interpolated at " + from, true};
  for (const double time_s : times_s) {
    if (time_s < covered.first || time_s > covered.last)
      throw Error(ErrorKind::data, trajectory.string() + ": its poses cover " +
                                       seconds_text(track.measured_s.first, track.measured_s.last) +
                                       ", but the scans (by " + from + ") " +
                                       seconds_text(times_s.front(), times_s.back()) +
                                       "; the clocks differ (give `time_offset`), or the "
                                       "trajectory belongs to another drive");
    if (is_in_gap(track.gaps, {time_s, time_s}))
      throw Error(ErrorKind::data, trajectory.string() + ": has a gap around " +
                                       seconds_text(time_s, time_s) + ", the time of a scan (by " +
                                       from +
                                       "); remove the scan, or give a trajectory without the gap");
    poses.of_scans.push_back({time_s, interpolate(track.poses, time_s)});
  }
  return poses;
}

/// For stamps of another clock and as many poses as scans: both must have the same steps.
void require_same_steps(const std::vector<double>& times_s, const Trajectory& poses,
                        const std::string& from, const fs::path& trajectory) {
  const double step_s = median_step(times_s);
  std::vector<double> ahead_s;
  for (std::size_t k = 0; k < times_s.size(); ++k) ahead_s.push_back(times_s[k] - poses[k].time_s);
  const auto [least, most] = std::ranges::minmax(ahead_s);
  if (most - least <= 0.5 * step_s) return;
  throw Error(
      ErrorKind::data,
      trajectory.string() + ": has one pose per scan, but " + from +
          " are ahead of the times of the poses by " + seconds_text(least, most) +
          ", so poses and scans do not match one by one; give `time_offset` or `scan_times`");
}

PosesOfFiles poses_in_order(Trajectory given, const Track* track, std::string by, bool timed) {
  PosesOfFiles poses;
  if (track != nullptr) poses.track = track->poses;
  poses.of_scans = std::move(given);
  poses.by = std::move(by);
  poses.has_times = timed;
  return poses;
}

/// By the numbers in the names, as in KITTI's sequences; nothing if a number is beyond the poses.
std::optional<Trajectory> poses_by_number(const std::vector<fs::path>& files,
                                          const Trajectory& given) {
  Trajectory matched;
  for (const fs::path& file : files) {
    const auto number = number_in_name(file);
    if (!number || *number >= given.size()) return std::nullopt;
    matched.push_back(given[*number]);
  }
  return matched;
}

/// The time stamp in the name of a single scan, in the unit in which the track covers it, s;
/// nothing if there is none.
std::optional<double> stamp_on_track(const fs::path& file, const Track& track, double offset_s) {
  const std::string text = stamp_text(file);
  const auto number = parse_number<double>(text);
  const bool is_short = text.find('.') == std::string::npos && text.size() < kStampDigits;
  if (!number || is_short) return std::nullopt;
  for (const double unit_s : kStampUnits_s)
    if (track.covers(unit_s * *number + offset_s)) return unit_s * *number + offset_s;
  return std::nullopt;
}

std::optional<PosesOfFiles> poses_by_stamps(std::vector<double> times_s, const std::string& from,
                                            const Trajectory& given, bool timed,
                                            const fs::path& trajectory,
                                            std::optional<double> time_offset_s, bool is_stated) {
  for (double& time_s : times_s) time_s += time_offset_s.value_or(0);
  const bool one_each = given.size() == times_s.size();
  if (!timed) {  // the stamps are the times of the poses
    if (!one_each)
      throw Error(ErrorKind::data, trajectory.string() + ": " + std::to_string(given.size()) +
                                       " poses without times for " +
                                       std::to_string(times_s.size()) +
                                       " scans; expected one pose per scan, or poses with times");
    Trajectory poses = given;
    for (std::size_t k = 0; k < poses.size(); ++k) poses[k].time_s = times_s[k];
    const Track track = track_of(poses);
    return poses_in_order(poses, &track, "one per scan, at " + from, true);
  }
  const Track track = track_of(given);
  const bool covered =
      times_s.front() >= track.covered_s().first && times_s.back() <= track.covered_s().last;
  if (covered || is_stated || time_offset_s || !one_each)
    return poses_at(times_s, track, from, trajectory);
  require_same_steps(times_s, given, from, trajectory);
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), "one per scan in order (%s are %.3f s ahead)",
                from.c_str(), times_s.front() - given.front().time_s);
  return poses_in_order(given, &track, text.data(), true);
}

}  // namespace

std::vector<fs::path> scan_files(const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_regular_file(folder, ignored) && kind_of_file(folder) == FileKind::points)
    return {folder};
  if (!fs::is_directory(folder, ignored) || !sequences_of_tree(folder).empty()) return {};
  std::vector<fs::path> files;
  std::vector<std::pair<double, fs::path>> numbered;
  for (const fs::path& path : list_folder(folder)) {
    if (path.filename().string().front() == '.' || !fs::is_regular_file(path, ignored)) continue;
    const FileKind kind = kind_of_file(path);
    if (kind == FileKind::mesh || kind == FileKind::splat_model) return {};
    if (kind == FileKind::points) files.push_back(path);
  }
  for (const fs::path& file : files) {
    if (lower_case(file.extension().string()) != lower_case(files.front().extension().string()))
      return {};
    if (const auto number = parse_number<double>(stamp_text(file)))
      numbered.emplace_back(*number, file);
  }
  std::ranges::sort(numbered);
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (numbered.size() != files.size() ||
      std::ranges::adjacent_find(numbered, same) != numbered.end())
    return files;
  for (std::size_t k = 0; k < files.size(); ++k) files[k] = numbered[k].second;
  return files;
}

std::vector<double> stamps_in_names(const std::vector<fs::path>& files) {
  std::vector<double> stamps;
  for (const fs::path& file : files) {
    const std::string text = stamp_text(file);
    const auto number = parse_number<double>(text);
    const bool is_short = text.find('.') == std::string::npos && text.size() < kStampDigits;
    if (!number || is_short) return {};
    stamps.push_back(*number);
  }
  if (stamps.size() < 2 || !ascend(stamps)) return {};
  for (const double unit_s : kStampUnits_s) {
    const double step_s = unit_s * median_step(stamps);
    if (step_s < kMinStep_s || step_s > kMaxStep_s) continue;
    for (double& stamp : stamps) stamp *= unit_s;
    return stamps;
  }
  return {};
}

std::vector<double> read_scan_times(const fs::path& file, std::size_t count) {
  InputFile input(file);
  LineReader reader(input);
  std::vector<double> times_s;
  while (const auto line = reader.next_filled()) {
    const auto time_s = parse_number<double>(*line);
    if (!time_s || !std::isfinite(*time_s))
      throw data_error({file, {}, reader.line()}, "expected one time, s, found " + shown(*line));
    times_s.push_back(*time_s);
  }
  if (times_s.size() != count)
    throw Error(ErrorKind::data, file.string() + ": " + std::to_string(times_s.size()) +
                                     " times for " + std::to_string(count) +
                                     " scans; expected one per scan");
  const double step_s = median_step(times_s);
  if (ascend(times_s) && (count < 2 || (step_s >= kMinStep_s && step_s <= kMaxStep_s)))
    return times_s;
  throw Error(ErrorKind::data, file.string() +
                                   ": its times are not ascending seconds: their median step is " +
                                   exact_text(step_s) + ", expected 0.005 to 10 s");
}

std::optional<PosesOfFiles> poses_of_files(const std::vector<fs::path>& files,
                                           const fs::path& trajectory, const fs::path& times_file,
                                           std::optional<double> time_offset_s) {
  const Trajectory given = read_trajectory(trajectory);
  const bool timed = has_times(trajectory);
  if (!times_file.empty())
    return poses_by_stamps(read_scan_times(times_file, files.size()),
                           "the times in " + times_file.filename().string(), given, timed,
                           trajectory, time_offset_s, true);
  if (std::vector<double> stamps = stamps_in_names(files); !stamps.empty())
    return poses_by_stamps(std::move(stamps), "the time stamps in the names of the scans", given,
                           timed, trajectory, time_offset_s, false);
  const Track track = timed ? track_of(given) : Track();
  const Track* const known = timed ? &track : nullptr;
  if (timed && files.size() == 1)
    if (const auto stamp_s = stamp_on_track(files.front(), track, time_offset_s.value_or(0)))
      return poses_at({*stamp_s}, track, "the time stamp in the name of the scan", trajectory);
  if (auto matched = poses_by_number(files, given))
    return poses_in_order(std::move(*matched), known, "by the numbers in the names of the scans",
                          timed);
  if (given.size() != files.size()) return std::nullopt;
  PosesOfFiles poses = poses_in_order(given, known, "one per scan in order", timed);
  poses.by_order = true;
  return poses;
}

}  // namespace adasplats
