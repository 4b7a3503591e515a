// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Trajectories as files.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "adasplats/cloud/poses/kitti_poses.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

namespace {

constexpr double kTolerance = 1e-3;  // of rotation matrices and quaternion norms
constexpr double kDefaultPeriodS = 0.1;
constexpr std::string_view kCsvHeader = "time,x,y,z,qw,qx,qy,qz";
constexpr const char* kCalibrationName = "calib.txt";
constexpr const char* kTimesName = "times.txt";

/// Whether a file beside another is there. What is there and cannot be read is left to the reader.
bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::status(path, ignored).type() != std::filesystem::file_type::not_found;
}

/// A line that is not blank, by its number from 1.
struct NumberedLine {
  std::uint64_t number;
  std::string text;
};

std::vector<NumberedLine> filled_lines(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader reader(file);
  std::vector<NumberedLine> lines;
  while (const auto line = reader.next_filled())
    lines.push_back({reader.line(), std::string(*line)});
  return lines;
}

std::vector<std::string_view> split_commas(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find(',');
    fields.push_back(BlankTokens(line.substr(0, end)).rest());
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::string short_text(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::general, 6);
  return std::string(buffer.data(), result.ptr);
}

double finite_number(const FilePlace& place, const std::vector<std::string_view>& fields,
                     std::size_t index) {
  const auto number = parse_number<double>(fields[index]);
  if (!number || !std::isfinite(*number))
    throw data_error(place, "value " + std::to_string(index + 1) + " " + shown(fields[index]) +
                                " is not a finite number");
  return *number;
}

void require_count(const FilePlace& place, const std::vector<std::string_view>& fields,
                   std::size_t expected) {
  if (fields.size() != expected)
    throw data_error(place, "found " + std::to_string(fields.size()) + " values, expected " +
                                std::to_string(expected));
}

/// `N` finite numbers, or an error that names the line.
template <std::size_t N>
std::array<double, N> finite_numbers(const std::filesystem::path& path, std::uint64_t line,
                                     const std::vector<std::string_view>& fields) {
  const FilePlace place{path, {}, line};
  require_count(place, fields, N);
  std::array<double, N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = finite_number(place, fields, i);
  return numbers;
}

RigidTransform transform_from_rows(const std::filesystem::path& path, std::uint64_t line,
                                   const std::vector<std::string_view>& fields) {
  const auto v = finite_numbers<12>(path, line, fields);
  const Mat3d matrix{{{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}}};
  const double error = orthonormality_error(matrix);
  if (std::isinf(error))
    throw data_error({path, {}, line},
                     "the matrix mirrors: its determinant is negative, a rotation's is 1; do the "
                     "axes of the file form a left-handed frame?");
  if (!(error <= kTolerance))
    throw data_error({path, {}, line}, "the rotation is not orthonormal to " +
                                           short_text(kTolerance) + " (off by " +
                                           short_text(error) + ")");
  return {orthonormalized(matrix), {v[3], v[7], v[11]}};
}

constexpr const char* kStateFrame =
    "; where the poses are the LiDAR's own, say so by the line 'Tr: 1 0 0 0 0 1 0 0 0 0 1 0'";

/// The `Tr:` line of a KITTI calib.txt: camera_from_velodyne. A sequence needs one, since its poses
/// are the camera's.
std::optional<RigidTransform> read_calibration(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kCalibrationName;
  if (!is_there(path)) {
    if (!is_there(folder / "velodyne")) return std::nullopt;
    throw Error(ErrorKind::data, path.string() +
                                     ": is missing; its line 'Tr:' brings the poses of a "
                                     "sequence, which are the camera's, to the LiDAR" +
                                     kStateFrame);
  }
  std::string names;
  for (const NumberedLine& line : filled_lines(path)) {
    std::vector<std::string_view> fields = split_blanks(line.text);
    if (fields.front() != "Tr:") {
      names += (names.empty() ? "" : ", ") + shown(fields.front());
      continue;
    }
    fields.erase(fields.begin());
    return transform_from_rows(path, line.number, fields);
  }
  throw Error(ErrorKind::data, path.string() + ": has no line 'Tr:' (camera_from_velodyne), but " +
                                   names + kStateFrame);
}

void require_ascending(const std::filesystem::path& path, std::uint64_t line, double before_s,
                       double time_s) {
  if (!(time_s > before_s))
    throw data_error({path, {}, line}, "time " + short_text(time_s) +
                                           " s does not come after the one before, " +
                                           short_text(before_s) + " s");
}

/// Times of `count` poses from times.txt, else by a fixed period.
std::vector<double> read_times(const std::filesystem::path& path, std::size_t count) {
  std::vector<double> times_s;
  if (!is_there(path)) {
    for (std::size_t i = 0; i < count; ++i)
      times_s.push_back(kDefaultPeriodS * static_cast<double>(i));
    return times_s;
  }
  for (const NumberedLine& line : filled_lines(path)) {
    const double time_s = finite_numbers<1>(path, line.number, split_blanks(line.text))[0];
    if (!times_s.empty()) require_ascending(path, line.number, times_s.back(), time_s);
    times_s.push_back(time_s);
  }
  if (times_s.size() != count)
    throw Error(ErrorKind::data, path.string() + ": " + std::to_string(times_s.size()) +
                                     " times, " + std::to_string(count) + " poses");
  return times_s;
}

Trajectory read_kitti_poses(const std::filesystem::path& path,
                            const std::vector<NumberedLine>& lines) {
  const std::filesystem::path folder = path.parent_path();
  const auto camera_from_sensor = read_calibration(folder);
  const std::vector<double> times_s = read_times(folder / kTimesName, lines.size());
  Trajectory trajectory;
  trajectory.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    RigidTransform pose = transform_from_rows(path, lines[i].number, split_blanks(lines[i].text));
    if (camera_from_sensor) pose = camera_from_sensor->inverse() * pose * *camera_from_sensor;
    trajectory.push_back({times_s[i], pose});
  }
  return trajectory;
}

/// Where a line of a timed pose has time, x, y, z, qw, qx, qy and qz.
struct PoseColumns {
  std::array<std::size_t, 8> of{};
  std::size_t count = 0;  ///< all columns of the line
};

std::vector<std::string_view> split_fields(std::string_view line) {
  return line.find(',') != std::string_view::npos ? split_commas(line) : split_blanks(line);
}

bool is_comment(std::string_view line) { return line.starts_with('#'); }

/// The columns that a line names, as our CSV and the TUM format call them; nothing where one is
/// missing.
std::optional<PoseColumns> columns_named_by(std::string_view line) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"time", "timestamp"},
                                                                      {"x", "tx"},
                                                                      {"y", "ty"},
                                                                      {"z", "tz"},
                                                                      {"qw", "qw"},
                                                                      {"qx", "qx"},
                                                                      {"qy", "qy"},
                                                                      {"qz", "qz"}}};
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  while (is_comment(line)) line.remove_prefix(1);
  const std::vector<std::string_view> fields = split_fields(line);
  PoseColumns columns;
  columns.count = fields.size();
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const auto found = std::ranges::find_if(fields, [&](std::string_view field) {
      return std::ranges::find(kNames[k], lower_case(field)) != kNames[k].end();
    });
    if (found == fields.end()) return std::nullopt;
    columns.of[k] = static_cast<std::size_t>(found - fields.begin());
  }
  return columns;
}

/// What a file says of itself before its poses.
struct Heading {
  std::optional<PoseColumns> columns;
  std::size_t lines = 0;  ///< comments and the line of names
};

Heading heading_of(const std::vector<NumberedLine>& lines) {
  Heading heading;
  for (; heading.lines < lines.size(); ++heading.lines) {
    const std::string& text = lines[heading.lines].text;
    const auto columns = columns_named_by(text);
    if (columns) heading.columns = columns;
    if (!columns && !is_comment(text)) break;
  }
  return heading;
}

Trajectory read_timed_poses(const std::filesystem::path& path, const PoseColumns& columns,
                            const std::vector<NumberedLine>& lines) {
  Trajectory trajectory;
  for (const NumberedLine& line : lines) {
    const FilePlace place{path, {}, line.number};
    const std::vector<std::string_view> fields = split_fields(line.text);
    require_count(place, fields, columns.count);
    std::array<double, 8> v;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = finite_number(place, fields, columns.of[k]);
    const double norm = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
    if (!(std::fabs(norm - 1) <= kTolerance))
      throw data_error(place, "the quaternion's norm is " + short_text(norm) + ", expected 1");
    if (!trajectory.empty()) require_ascending(path, line.number, trajectory.back().time_s, v[0]);
    const Mat3d rotation =
        rotation_from_quaternion(v[4] / norm, v[5] / norm, v[6] / norm, v[7] / norm);
    trajectory.push_back({v[0], {rotation, {v[1], v[2], v[3]}}});
  }
  return trajectory;
}

/// Lines that may be timed poses say which value is which: of the quaternion the usual orders
/// differ, and nothing in the numbers distinguishes them.
void require_rows_of_matrices(const std::filesystem::path& path, const NumberedLine& first) {
  constexpr std::size_t kTimedPose = 8;
  const bool has_commas = first.text.find(',') != std::string::npos;
  if (!has_commas && split_blanks(first.text).size() != kTimedPose) return;
  throw data_error({path, {}, first.number},
                   "no line before it names the columns; expected a first line '" +
                       std::string(kCsvHeader) +
                       "' (CSV), '# timestamp tx ty tz qx qy qz qw' (TUM) or another order of "
                       "these names, or KITTI's rows of 12 numbers");
}

void append_fixed(std::string& text, double value) {
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::fixed, 9);
  text.append(buffer.data(), result.ptr);
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  std::vector<NumberedLine> lines = filled_lines(path);
  const Heading heading = heading_of(lines);
  lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(heading.lines));
  std::erase_if(lines, [](const NumberedLine& line) { return is_comment(line.text); });
  if (lines.empty()) throw Error(ErrorKind::data, path.string() + ": holds no poses");
  if (heading.columns) return read_timed_poses(path, *heading.columns, lines);
  require_rows_of_matrices(path, lines.front());
  return read_kitti_poses(path, lines);
}

bool has_times(const std::filesystem::path& trajectory) {
  return heading_of(filled_lines(trajectory)).columns.has_value() ||
         is_there(trajectory.parent_path() / kTimesName);
}

std::vector<std::filesystem::path> trajectory_files(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files = {path};
  if (heading_of(filled_lines(path)).columns) return files;
  for (const char* name : {kCalibrationName, kTimesName})
    if (const auto file = path.parent_path() / name; is_there(file)) files.push_back(file);
  return files;
}

void write_trajectory_csv(const std::filesystem::path& path, const Trajectory& trajectory) {
  std::string text(kCsvHeader);
  text += '\n';
  for (const TimedPose& pose : trajectory) {
    const Vec3d p = pose.world_from_sensor.translation;
    const Quaternion q = quaternion_from_rotation(pose.world_from_sensor.rotation);
    append_fixed(text, pose.time_s);
    for (const double value : {p.x, p.y, p.z, q.w, q.x, q.y, q.z}) {
      text += ',';
      append_fixed(text, value);
    }
    text += '\n';
  }
  write_file(path, text);
}

void write_kitti_poses(const std::filesystem::path& path, const Trajectory& world_from_velodyne,
                       const std::filesystem::path& sequence_folder) {
  const auto camera_from_sensor = read_calibration(sequence_folder);
  if (!camera_from_sensor)
    throw Error(ErrorKind::data, (sequence_folder / kCalibrationName).string() + ": is missing");
  std::string text;
  for (const TimedPose& pose : world_from_velodyne) {
    const RigidTransform camera =
        *camera_from_sensor * pose.world_from_sensor * camera_from_sensor->inverse();
    for (int r = 0; r < 3; ++r) {
      const Vec3d row = camera.rotation.rows[r];
      for (const double value : {row.x, row.y, row.z}) text += exact_text(value) + " ";
      text += exact_text(camera.translation[r]) + (r < 2 ? " " : "\n");
    }
  }
  write_file(path, text);
}

}  // namespace adasplats
