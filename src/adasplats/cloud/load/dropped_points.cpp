// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/dropped_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "adasplats/core/error.h"

namespace adasplats {

namespace {

std::string short_text(double value, int digits) {
  std::array<char, 32> buffer;
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string percent_text(double share) { return short_text(100 * share, 3) + " %"; }

/// "12 of 40 points (30 %)".
std::string share_text(std::size_t part, std::size_t all) {
  return std::to_string(part) + " of " + std::to_string(all) + " points (" +
         percent_text(static_cast<double>(part) / static_cast<double>(all)) + ")";
}

}  // namespace

void report_dropped(const std::string& input, const LoadReport& report, const LoadOptions& options,
                    ProgressSink& progress) {
  const std::size_t all = report.points_read;
  const double max_points = options.max_dropped * static_cast<double>(all);
  const auto report_points = [&](std::size_t points, const std::string& why,
                                 const std::string& cure) {
    if (points == 0) return;
    const std::string what = input + ": " + share_text(points, all) + " " + why;
    if (!cure.empty() && static_cast<double>(points) > max_points)
      throw Error(ErrorKind::data, what + ", more than " + percent_text(options.max_dropped) +
                                       ": " + cure + "raise `max_dropped` to drop them anyway");
    progress.warn(what + " and are dropped");
  };
  report_points(report.no_returns, "are missing returns (x, y and z are NaN or 0)", "");
  report_points(report.dropped_not_finite - report.no_returns, "have a position that is not finite",
                "check the program that wrote the file, or ");
  report_points(report.dropped_far,
                "are farther than " + short_text(options.max_distance_m, 9) +
                    " m from the median of all points",
                "check for two scenes or two coordinate systems in the input, raise `max_distance` "
                "to keep them, or ");
}

void report_own_body(const std::string& input, const LoadReport& report, const LoadOptions& options,
                     ProgressSink& progress) {
  if (report.driven_path > 0)
    progress.warn(input + ": " + share_text(report.driven_path, report.points_read) +
                  " are in the driven path of the recording vehicle and are removed (`driven_path` "
                  "0 keeps them)");
  if (report.own_body == 0) return;
  progress.warn(
      input + ": " + share_text(report.own_body, report.points_read) +
      (options.own_body_m
           ? " are nearer to their sensor than " + short_text(*options.own_body_m, 9) +
                 " m and are removed"
           : " belong to the recording vehicle and are removed (`own_body` 0 keeps them)"));
}

namespace {

/// Throws data if the box can only be of geocentric coordinates: at the surface of the Earth around
/// zero, and not within 10 km of the plane z = 0, where projected coordinates are.
void require_no_geocentric(const std::string& input, Vec3d low, Vec3d high) {
  constexpr double kMinRadius_m = 6.33e6, kMaxRadius_m = 6.42e6, kMaxHeight_m = 10e3;
  const Vec3d middle = 0.5 * (low + high);
  const double radius = length(middle);
  if (!(radius > kMinRadius_m && radius < kMaxRadius_m && std::fabs(middle.z) > kMaxHeight_m))
    return;
  throw Error(ErrorKind::data,
              input + ": the points are around " + short_text(middle.x, 8) + ", " +
                  short_text(middle.y, 8) + ", " + short_text(middle.z, 8) + ", " +
                  short_text(radius / 1000, 5) +
                  " km from zero, so they are geocentric (ECEF), where z is not up; project them, "
                  "for example to UTM with 'pdal translate IN OUT reprojection "
                  "--filters.reprojection.in_srs=EPSG:4978 --filters.reprojection.out_srs=...'");
}

}  // namespace

void require_metres(const std::string& input, Vec3d low, Vec3d high, const Crs& crs,
                    ProgressSink& progress) {
  require_no_geocentric(input, low, high);
  constexpr double kMaxLongitude = 180, kMaxLatitude = 90;
  constexpr double kCertainSteepness = 1000, kDoubtfulSteepness = 10, kDoubtfulWidth = 1;
  const bool in_range = low.x >= -kMaxLongitude && high.x <= kMaxLongitude &&
                        low.y >= -kMaxLatitude && high.y <= kMaxLatitude;
  const bool holds_zero = low.x <= 0 && high.x >= 0 && low.y <= 0 && high.y >= 0;
  const double width = std::max(high.x - low.x, high.y - low.y), height = high.z - low.z;
  if (!in_range || holds_zero || !(width > 0)) return;
  const std::string seen = input + ": the points span " + short_text(high.x - low.x, 3) + " by " +
                           short_text(high.y - low.y, 3) + " around x " + short_text(low.x, 6) +
                           ", y " + short_text(low.y, 6) + " and " + short_text(height, 3) +
                           " in height";
  const std::string cure =
      "reproject them to metres, for example to UTM with 'pdal translate IN OUT reprojection "
      "--filters.reprojection.out_srs=...'";
  if (height > kCertainSteepness * width)
    throw Error(ErrorKind::data, seen + ", so they are longitudes and latitudes; " + cure);
  if (crs.empty() && width < kDoubtfulWidth && height > kDoubtfulSteepness * width)
    progress.warn(seen + "; assumed to be metres; if they are longitudes and latitudes, " + cure);
}

}  // namespace adasplats
