// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Trajectories as files.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "adasplats/cloud/poses/exact_time.h"
#include "adasplats/cloud/poses/openscenario.h"
#include "adasplats/cloud/poses/pose_columns.h"
#include "adasplats/cloud/poses/quaternion_order.h"
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

std::string short_text(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::general, 6);
  return std::string(buffer.data(), result.ptr);
}

double finite_number(const FilePosition& place, const std::vector<std::string_view>& fields,
                     std::size_t index) {
  const auto number = parse_number<double>(fields[index]);
  if (!number || !std::isfinite(*number))
    throw data_error(place, "value " + std::to_string(index + 1) + " " + shown(fields[index]) +
                                " is not a finite number");
  return *number;
}

void require_count(const FilePosition& place, const std::vector<std::string_view>& fields,
                   std::size_t expected) {
  if (fields.size() != expected)
    throw data_error(place, "found " + std::to_string(fields.size()) + " values, expected " +
                                std::to_string(expected));
}

/// `N` finite numbers, or an error that names the line.
template <std::size_t N>
std::array<double, N> finite_numbers(const std::filesystem::path& path, std::uint64_t line,
                                     const std::vector<std::string_view>& fields) {
  const FilePosition place{path, {}, line};
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
    "; if the poses are those of the LiDAR, write the line 'Tr: 1 0 0 0 0 1 0 0 0 0 1 0'";

/// The `Tr:` line of a KITTI calib.txt: camera_from_velodyne. A sequence needs one, since its poses
/// are the camera's.
std::optional<RigidTransform> read_calibration(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kCalibrationName;
  if (!is_there(path)) {
    if (!is_there(folder / "velodyne")) return std::nullopt;
    throw Error(ErrorKind::data, path.string() +
                                     ": is missing; its line 'Tr:' transforms the poses of a "
                                     "sequence from the camera to the LiDAR" +
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

/// The times of a file, which must ascend. They are compared exactly, as they are written.
class AscendingTimes {
 public:
  explicit AscendingTimes(const std::filesystem::path& path) : path_(path) {}

  /// The next time as a double that is above the one before. `exact`: if the text is decimal.
  double next(std::uint64_t line, std::string_view text, std::optional<ExactTime> exact,
              double time_s) {
    if (!text_.empty()) {
      const bool ascends = exact && exact_ ? *exact > *exact_ : time_s > time_s_;
      if (!ascends)
        throw data_error({path_, {}, line}, "time " + std::string(text) +
                                                " does not come after the one before, " + text_ +
                                                fraction_hint(text));
      time_s = time_after(time_s_, time_s);
    }
    text_ = text;
    exact_ = exact;
    time_s_ = time_s;
    return time_s;
  }

 private:
  /// Nanoseconds printed without their zeros: "7.15205860" for 7.015205860.
  std::string fraction_hint(std::string_view text) const {
    const std::string_view before = text_;
    const std::size_t point = before.find('.');
    if (point == std::string_view::npos || point != text.find('.') ||
        before.substr(0, point) != text.substr(0, point) || before.size() == text.size())
      return {};
    return "; their fractions have " + std::to_string(text.size() - point - 1) + " and " +
           std::to_string(before.size() - point - 1) + " digits: were zeros after the point lost?";
  }

  std::filesystem::path path_;
  std::string text_;
  std::optional<ExactTime> exact_;
  double time_s_ = 0;
};

/// Times of `count` poses from times.txt, else by a fixed period.
std::vector<double> read_times(const std::filesystem::path& path, std::size_t count) {
  std::vector<double> times_s;
  if (!is_there(path)) {
    for (std::size_t i = 0; i < count; ++i)
      times_s.push_back(kDefaultPeriodS * static_cast<double>(i));
    return times_s;
  }
  AscendingTimes ascending(path);
  for (const NumberedLine& line : filled_lines(path)) {
    const auto fields = split_blanks(line.text);
    const double time_s = finite_numbers<1>(path, line.number, fields)[0];
    times_s.push_back(ascending.next(line.number, fields[0], exact_time(fields[0], 0), time_s));
  }
  if (times_s.size() != count)
    throw Error(ErrorKind::data, path.string() + ": " + std::to_string(times_s.size()) +
                                     " times, but " + std::to_string(count) +
                                     " poses; both files need one line per scan");
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

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with('%'); }

/// What a file says of itself before its poses.
struct Heading {
  std::optional<PoseColumns> columns;
  std::size_t lines = 0;  ///< comments and the line of names
};

bool is_tum(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".tum";
}

/// Errors: data where names are not clear.
Heading heading_of(const std::filesystem::path& path, const std::vector<NumberedLine>& lines) {
  Heading heading;
  for (; heading.lines < lines.size(); ++heading.lines) {
    const NumberedLine& line = lines[heading.lines];
    // What begins with a number is a pose; its fields are none of names.
    const std::vector<std::string_view> fields = split_pose_fields(line.text);
    if (parse_number<double>(fields.front())) break;
    const PoseHeading named = pose_heading_of(line.text);
    if (named.columns) heading.columns = named.columns;
    if (named.columns || is_comment(line.text)) continue;
    if (named.problem.empty()) break;
    throw data_error({path, {}, line.number}, named.problem);
  }
  // The format has one order, and often no line of names.
  if (!heading.columns && is_tum(path)) heading.columns = PoseColumns::tum();
  return heading;
}

/// Seconds; no others have so many digits. Errors: data.
void require_seconds(const FilePosition& place, double time_s, double unit_s) {
  constexpr double kMaxSeconds = 1e11;  // the year 5138
  if (std::fabs(time_s) <= kMaxSeconds) return;
  throw data_error(place, "a time of " + short_text(time_s / unit_s) +
                              (unit_s == 1 ? " s is none since any epoch; a name says another unit "
                                             "(timestamp_ns, timestamp_us, timestamp_ms)"
                                           : " in the unit of its name is none since any epoch"));
}

/// The time of a line without rounding, if its numbers are decimal.
std::optional<ExactTime> exact_time_of_line(const PoseColumns& columns,
                                            const std::vector<std::string_view>& fields) {
  const int exponent = static_cast<int>(std::lround(std::log10(columns.time_unit_s)));
  const auto time = exact_time(fields[columns.of[0]], exponent);
  if (!time || !columns.nanoseconds) return time;
  const auto nanoseconds = exact_time(fields[*columns.nanoseconds], -9);
  return nanoseconds ? std::optional(*time + *nanoseconds) : std::nullopt;
}

double time_of_line(const FilePosition& place, const PoseColumns& columns,
                    const std::vector<std::string_view>& fields) {
  constexpr double kNanosecond_s = 1e-9;
  const double time_s = columns.time_unit_s * finite_number(place, fields, columns.of[0]);
  require_seconds(place, time_s, columns.time_unit_s);
  if (!columns.nanoseconds) return time_s;
  const double nanoseconds = finite_number(place, fields, *columns.nanoseconds);
  if (!(nanoseconds >= 0 && nanoseconds < 1e9))
    throw data_error(place, short_text(nanoseconds) + " ns within a second, expected 0 to 1e9");
  return time_s + kNanosecond_s * nanoseconds;
}

Trajectory read_timed_poses(const std::filesystem::path& path, const PoseColumns& columns,
                            const std::vector<NumberedLine>& lines) {
  Trajectory trajectory;
  AscendingTimes ascending(path);
  std::vector<PlacedQuaternion> placed;
  for (const NumberedLine& line : lines) {
    const FilePosition place{path, {}, line.number};
    const std::vector<std::string_view> fields = split_pose_fields(line.text);
    require_count(place, fields, columns.count);
    std::array<double, 8> v;
    v[0] = time_of_line(place, columns, fields);
    for (std::size_t k = 1; k < v.size(); ++k) v[k] = finite_number(place, fields, columns.of[k]);
    const double norm = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
    if (!(std::fabs(norm - 1) <= kTolerance))
      throw data_error(place, "the quaternion's norm is " + short_text(norm) + ", expected 1");
    std::string text(fields[columns.of[0]]);
    if (columns.nanoseconds) text += " s, " + std::string(fields[*columns.nanoseconds]) + " ns";
    v[0] = ascending.next(line.number, text, exact_time_of_line(columns, fields), v[0]);
    const Quaternion q{v[4] / norm, v[5] / norm, v[6] / norm, v[7] / norm};
    placed.push_back({{v[1], v[2], v[3]}, q});
    trajectory.push_back(
        {v[0], {rotation_from_quaternion(q.w, q.x, q.y, q.z), placed.back().place}});
  }
  const std::string objection = quaternion_order_problem(placed);
  if (!objection.empty()) throw Error(ErrorKind::data, path.string() + ": " + objection);
  return trajectory;
}

/// Lines that may be timed poses say which value is which: of the quaternion the usual orders
/// differ, and nothing in the numbers distinguishes them.
void require_rows_of_matrices(const std::filesystem::path& path, const NumberedLine& first) {
  constexpr std::size_t kTimedPose = 8;
  const bool has_separators = first.text.find_first_of(",;") != std::string::npos;
  if (!has_separators && split_blanks(first.text).size() != kTimedPose) return;
  throw data_error({path, {}, first.number},
                   "no line before it names the columns; expected a first line '" +
                       std::string(kCsvHeader) +
                       "' (CSV), '# timestamp tx ty tz qx qy qz qw' (TUM, or name the file "
                       "*.tum) or another order of these names, or KITTI's rows of 12 numbers");
}

void append_fixed(std::string& text, double value) {
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::fixed, 9);
  text.append(buffer.data(), result.ptr);
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  if (const std::optional<ScenarioPath> scenario = scenario_path(path))
    return read_scenario(*scenario);
  std::vector<NumberedLine> lines = filled_lines(path);
  const Heading heading = heading_of(path, lines);
  lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(heading.lines));
  std::erase_if(lines, [](const NumberedLine& line) { return is_comment(line.text); });
  if (lines.empty()) throw Error(ErrorKind::data, path.string() + ": holds no poses");
  if (heading.columns) return read_timed_poses(path, *heading.columns, lines);
  require_rows_of_matrices(path, lines.front());
  return read_kitti_poses(path, lines);
}

bool has_times(const std::filesystem::path& trajectory) {
  if (scenario_path(trajectory)) return true;
  return heading_of(trajectory, filled_lines(trajectory)).columns.has_value() ||
         is_there(trajectory.parent_path() / kTimesName);
}

std::vector<std::filesystem::path> trajectory_files(const std::filesystem::path& path) {
  if (const std::optional<ScenarioPath> scenario = scenario_path(path)) return {scenario->file};
  std::vector<std::filesystem::path> files = {path};
  if (heading_of(path, filled_lines(path)).columns) return files;
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
