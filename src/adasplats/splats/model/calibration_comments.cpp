// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/calibration_comments.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr const char* kSensorComment = "adasplats.calibration_sensor ";
constexpr const char* kRangeOffsetsComment = "adasplats.calibration_range_offsets_m ";
constexpr const char* kElevationOffsetsComment = "adasplats.calibration_elevation_offsets_rad ";
constexpr const char* kAzimuthOffsetsComment = "adasplats.calibration_azimuth_offsets_rad ";
constexpr const char* kCellsComment = "adasplats.calibration_cells ";
constexpr const char* kMountComment = "adasplats.calibration_mount ";
constexpr const char* kSmoothComment = "adasplats.calibration_smooth_s ";
constexpr const char* kPoseComment = "adasplats.calibration_pose ";

Error calibration_error(const std::filesystem::path& path, const std::string& message) {
  return {ErrorKind::data, path.string() + ": the calibration " + message};
}

/// The shortest texts that parse to the same numbers.
std::string calibration_comment(const char* key, std::span<const double> values) {
  std::string comment = key;
  std::array<char, 32> buffer;
  for (const double value : values) {
    char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    comment += std::string(buffer.data(), end) + " ";
  }
  comment.pop_back();
  return comment;
}

std::vector<double> calibration_numbers(const std::filesystem::path& path, std::string_view text) {
  std::vector<double> numbers;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::optional<double> value = parse_number<double>(word);
    if (!value || !std::isfinite(*value))
      throw calibration_error(path, "contains '" + word + "', expected a number");
    numbers.push_back(*value);
  }
  return numbers;
}

/// The comments of one sensor.
class SensorComments {
 public:
  SensorComments(std::span<const std::string> comments, const std::filesystem::path& path)
      : comments_(comments), path_(path) {}

  Calibration calibration() const {
    Calibration result;
    result.lasers = lasers();
    const std::vector<double> mount = numbers(kMountComment, 6);
    if (!mount.empty())
      result.mount = {{mount[0], mount[1], mount[2]}, {mount[3], mount[4], mount[5]}};
    const std::vector<double> smooth = numbers(kSmoothComment, 1);
    if (!smooth.empty()) result.smooth_s = smooth.front();
    if (result.smooth_s < 0) throw calibration_error(path_, "has a negative smooth_s");
    for (const std::string& comment : comments_) {
      if (!comment.starts_with(kPoseComment)) continue;
      const std::vector<double> v = numbers_of_comment(comment, kPoseComment, 10);
      result.poses.push_back({v[0], {v[1], v[2], v[3]}, {v[4], v[5], v[6]}, {v[7], v[8], v[9]}});
    }
    return result;
  }

 private:
  LaserOffsets lasers() const {
    LaserOffsets lasers;
    lasers.range_m = numbers(kRangeOffsetsComment, 0);
    lasers.elevation_rad = numbers(kElevationOffsetsComment, 0);
    lasers.azimuth_rad = numbers(kAzimuthOffsetsComment, 0);
    const std::size_t count = lasers.range_m.size();
    if (lasers.elevation_rad.size() != count ||
        (!lasers.azimuth_rad.empty() && lasers.azimuth_rad.size() != count))
      throw calibration_error(path_, "has offsets of " + std::to_string(count) + " ranges and " +
                                         std::to_string(lasers.elevation_rad.size()) +
                                         " elevations");
    const std::vector<double> v = numbers(kCellsComment, 6);
    if (v.empty()) return lasers;
    constexpr double kMaxCells = 0xffff;
    const bool is_sound = v[2] > 0 && v[3] > 0 && v[4] >= 1 && v[5] >= 1 && v[4] * v[5] < kMaxCells;
    if (!is_sound) throw calibration_error(path_, "has cells without a size");
    lasers.cells = {
        v[0], v[1], v[2], v[3], static_cast<std::size_t>(v[4]), static_cast<std::size_t>(v[5])};
    return lasers;
  }

  /// Of the comment with a key; empty if there is none. `count`: expected; 0: any.
  std::vector<double> numbers(const char* key, std::size_t count) const {
    const auto found = std::ranges::find_if(
        comments_, [key](const std::string& comment) { return comment.starts_with(key); });
    if (found == comments_.end()) return {};
    return numbers_of_comment(*found, key, count);
  }

  std::vector<double> numbers_of_comment(const std::string& comment, std::string_view key,
                                         std::size_t count) const {
    std::vector<double> numbers =
        calibration_numbers(path_, std::string_view(comment).substr(key.size()));
    if (count != 0 && numbers.size() != count)
      throw calibration_error(path_, "has " + std::to_string(numbers.size()) + " numbers in '" +
                                         std::string(key) + "', expected " + std::to_string(count));
    return numbers;
  }

  std::span<const std::string> comments_;
  const std::filesystem::path& path_;
};

}  // namespace

void add_calibration_comments(const Calibration& calibration, std::vector<std::string>& comments) {
  if (!calibration.sensor.empty()) comments.push_back(kSensorComment + calibration.sensor);
  const LaserOffsets& lasers = calibration.lasers;
  if (!lasers.empty()) {
    comments.push_back(calibration_comment(kRangeOffsetsComment, lasers.range_m));
    comments.push_back(calibration_comment(kElevationOffsetsComment, lasers.elevation_rad));
  }
  if (!lasers.cells.empty()) {
    const BeamCells& c = lasers.cells;
    comments.push_back(calibration_comment(kAzimuthOffsetsComment, lasers.azimuth_rad));
    comments.push_back(calibration_comment(
        kCellsComment,
        std::array{c.azimuth_rad, c.elevation_rad, c.azimuth_step_rad, c.elevation_step_rad,
                   static_cast<double>(c.columns), static_cast<double>(c.rows)}));
  }
  if (!calibration.mount.empty()) {
    const auto& [r, s] = calibration.mount;
    comments.push_back(
        calibration_comment(kMountComment, std::array{r.x, r.y, r.z, s.x, s.y, s.z}));
  }
  if (!calibration.poses.empty())
    comments.push_back(calibration_comment(kSmoothComment, std::array{calibration.smooth_s}));
  for (const PoseCorrection& pose : calibration.poses) {
    const auto& [time_s, p, r, s] = pose;
    comments.push_back(calibration_comment(
        kPoseComment, std::array{time_s, p.x, p.y, p.z, r.x, r.y, r.z, s.x, s.y, s.z}));
  }
  for (const Calibration& other : calibration.others) add_calibration_comments(other, comments);
}

Calibration calibration_of_comments(std::span<const std::string> comments,
                                    const std::filesystem::path& path) {
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < comments.size(); ++k)
    if (comments[k].starts_with(kSensorComment)) begins.push_back(k);
  if (begins.empty()) return SensorComments(comments, path).calibration();
  Calibration rig;
  for (std::size_t s = 0; s < begins.size(); ++s) {
    const std::size_t end = s + 1 < begins.size() ? begins[s + 1] : comments.size();
    Calibration own =
        SensorComments(comments.subspan(begins[s], end - begins[s]), path).calibration();
    own.sensor = comments[begins[s]].substr(std::string_view(kSensorComment).size());
    if (s == 0)
      rig = std::move(own);
    else
      rig.others.push_back(std::move(own));
  }
  return rig;
}

}  // namespace adasplats
