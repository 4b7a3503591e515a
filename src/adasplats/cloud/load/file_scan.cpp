// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/file_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {

namespace {

constexpr std::array kTimeUnits_s = {1.0, 1e-3, 1e-6, 1e-9};
// Sensors turn 5 to 100 times a second; frames of sensors that do not turn last at most a second.
constexpr double kShortestSweep_s = 0.005, kLongestSweep_s = 1;

}  // namespace

TimeSpan FileScan::time_span() const {
  TimeSpan span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < times.size(); ++i)
    if (is_valid_position(positions[i]) && std::isfinite(times[i]))
      span = {std::min(span.first, times[i]), std::max(span.last, times[i])};
  return span.first <= span.last ? span : TimeSpan{};
}

namespace {

FileScan scan_of_part(CloudPart&& part) {
  FileScan scan;
  scan.positions = std::move(part.world_positions);
  scan.times = std::move(part.times_s);
  scan.intensities = std::move(part.cloud.intensities);
  scan.classes = std::move(part.cloud.classes);
  scan.instances = std::move(part.cloud.instances);
  return scan;
}

class FileSource final : public ScanSource {
 public:
  FileScan read(const std::filesystem::path& scan) const override { return read_file_scan(scan); }
};

}  // namespace

FileScan read_file_scan(const std::filesystem::path& file) {
  require_points(file);
  return scan_of_table(file, read_points(file));
}

FileScan scan_of_table(const std::filesystem::path& name, const Table& table) {
  ProgressSink silent;
  CloudPart part = part_of_table(name, table, {}, silent);
  mark_missing_returns(table, part.world_positions);
  return scan_of_part(std::move(part));
}

std::shared_ptr<const ScanSource> scans_in_files() { return std::make_shared<FileSource>(); }

PointTimes meaning_of_times(TimeSpan first, TimeSpan last, const TimeSpan* track_s,
                            double time_offset_s) {
  const double length = std::max(first.last - first.first, last.last - last.first);
  PointTimes times;
  const bool is_same = first.first == last.first && first.last == last.last;
  if (length == 0 && is_same) return times;
  const auto is_sweep = [&](double unit_s) {
    return unit_s * length >= kShortestSweep_s && unit_s * length <= kLongestSweep_s;
  };
  const bool begin_alike = std::fabs(first.first - last.first) < 0.5 * length;
  times.kind = begin_alike ? PointTimes::Kind::offsets : PointTimes::Kind::absolute;
  times.shift_s = time_offset_s;
  times.fits = false;
  for (const double unit_s : kTimeUnits_s) {
    if (!(is_sweep(unit_s) || (length == 0 && !begin_alike))) continue;
    const double min_s = unit_s * std::min(first.first, last.first) + time_offset_s;
    const double max_s = unit_s * std::max(first.last, last.last) + time_offset_s;
    const bool covered = track_s == nullptr || (min_s >= track_s->first - kLongestSweep_s &&
                                                max_s <= track_s->last + kLongestSweep_s);
    if (!begin_alike && !covered) continue;
    times.unit_s = unit_s;
    times.fits = true;
    return times;
  }
  return times;
}

PointTimes meaning_of_times(TimeSpan only, const TimeSpan* track_s, double time_offset_s) {
  const double length = only.last - only.first;
  PointTimes times;
  if (length == 0) return times;
  times.fits = false;
  for (const auto kind : {PointTimes::Kind::absolute, PointTimes::Kind::offsets}) {
    times.kind = kind;
    for (const double unit_s : kTimeUnits_s) {
      if (!(unit_s * length >= kShortestSweep_s && unit_s * length <= kLongestSweep_s)) continue;
      const bool covers = track_s != nullptr &&
                          unit_s * only.first + time_offset_s >= track_s->first &&
                          unit_s * only.last + time_offset_s <= track_s->last;
      const bool fits = kind == PointTimes::Kind::absolute
                            ? covers
                            : std::fabs(unit_s * only.first) <= kLongestSweep_s;
      if (!fits) continue;
      times.unit_s = unit_s;
      times.shift_s = time_offset_s;
      times.fits = true;
      return times;
    }
  }
  return times;
}

namespace {

constexpr float kMaxOfByte = 255;

/// A value that is not finite is unknown and fits any scale.
bool can_be_byte(float value) {
  return !std::isfinite(value) || (value >= 0 && value <= kMaxOfByte && value == std::trunc(value));
}

bool is_above_share(float value) { return std::isfinite(value) && value > 1; }

Error other_scale(const std::filesystem::path& file, float value, const char* others) {
  return {ErrorKind::data, file.string() + ": has an intensity of " +
                               exact_text(static_cast<double>(value)) +
                               ", but the intensities of other scans are " + others +
                               "; bring the files to one scale"};
}

}  // namespace

IntensityScale::IntensityScale(std::span<const std::vector<float>> sample) {
  bool all_bytes = true, any_above = false;
  for (const std::vector<float>& scan : sample) {
    all_bytes = all_bytes && std::ranges::all_of(scan, can_be_byte);
    any_above = any_above || std::ranges::any_of(scan, is_above_share);
  }
  is_bytes_ = all_bytes && any_above;
  are_shares_ = !any_above;
}

std::vector<float> IntensityScale::scaled(std::vector<float> intensities,
                                          const std::filesystem::path& file) const {
  if (is_bytes_) {
    const auto wrong = std::ranges::find_if_not(intensities, can_be_byte);
    if (wrong != intensities.end()) throw other_scale(file, *wrong, "whole numbers from 0 to 255");
    for (float& value : intensities) value /= kMaxOfByte;
  } else if (are_shares_) {
    const auto wrong = std::ranges::find_if(intensities, is_above_share);
    if (wrong != intensities.end()) throw other_scale(file, *wrong, "at most 1");
  }
  return intensities;
}

IntensityScale scale_of_scans(const ScanSource& source,
                              const std::vector<std::filesystem::path>& files) {
  const std::set<std::size_t> chosen = {0, files.size() / 2, files.size() - 1};
  std::vector<std::vector<float>> sample;
  sample.reserve(chosen.size());
  for (const std::size_t k : chosen) sample.push_back(source.read(files[k]).intensities);
  return IntensityScale(sample);
}

std::string IntensityScale::description() const {
  return is_bytes_ ? "0 to 255 in the files, divided by 255" : "as in the files";
}

}  // namespace adasplats
