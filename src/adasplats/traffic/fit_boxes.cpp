// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/fit_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "adasplats/traffic/object_kind.h"
#include "adasplats/traffic/smooth_path.h"

namespace adasplats {
namespace {

/// The value below which a share of the values is; without values 0.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto k =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(k));
  return values[k];
}

/// Least and greatest coordinate of the points without the outermost 2 %.
struct Extent {
  double low = 0, high = 0;
  double length() const { return high - low; }
};

Extent extent_of(const std::vector<double>& values) {
  constexpr double kOutermost = 0.02;
  return {quantile(values, kOutermost), quantile(values, 1 - kOutermost)};
}

/// A cluster along the axes of an object that drives in a direction: ahead, left, up.
struct View {
  std::array<Extent, 3> extents;
  Vec3d sensor;
};

View view_of(const Cluster& cluster, const LoosePoints& loose, double heading_rad) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const auto turned = [&](Vec3d v) { return Vec3d{c * v.x + s * v.y, -s * v.x + c * v.y, v.z}; };
  std::array<std::vector<double>, 3> coordinates;
  for (const std::uint32_t i : cluster.points) {
    const Vec3d point = turned(loose.points[i] - cluster.middle);
    for (int axis = 0; axis < 3; ++axis)
      coordinates[static_cast<std::size_t>(axis)].push_back(point[axis]);
  }
  View view;
  for (std::size_t axis = 0; axis < 3; ++axis) view.extents[axis] = extent_of(coordinates[axis]);
  view.sensor = turned(loose.sensor - cluster.middle);
  return view;
}

/// The middle of a side of known length, of which the sensor sees the near end.
double middle_of(const Extent& extent, double sensor, double length) {
  if (sensor < extent.low) return extent.low + length / 2;
  if (sensor > extent.high) return extent.high - length / 2;
  return (extent.low + extent.high) / 2;
}

/// The same if several sensors see it: nothing is hidden between two that see both ends.
Extent whole_side(const Extent& extent, const Extent& sensors, double length) {
  if (extent.length() >= length) return extent;
  const bool is_low_seen = sensors.low<extent.low, is_high_seen = sensors.high> extent.high;
  if (is_low_seen == is_high_seen) return extent;
  return is_low_seen ? Extent{extent.low, extent.low + length}
                     : Extent{extent.high - length, extent.high};
}

/// The coordinates of points along axes that are turned about z.
std::array<std::vector<double>, 3> turned(std::span<const Vec3d> points, Vec3d origin,
                                          double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  std::array<std::vector<double>, 3> coordinates;
  for (const Vec3d& point : points) {
    const Vec3d off = point - origin;
    coordinates[0].push_back(c * off.x + s * off.y);
    coordinates[1].push_back(-s * off.x + c * off.y);
    coordinates[2].push_back(off.z);
  }
  return coordinates;
}

Extent whole_extent(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return {*low, *high};
}

/// The lower side of a box: the ground, if it is where the lowest points make it likely.
double bottom_of(double ground, double lowest) {
  constexpr double kHidden_m = 1, kInside_m = 0.3;
  return ground >= lowest - kHidden_m && ground <= lowest + kInside_m ? ground : lowest;
}

/// Fits the boxes of one track.
class Fit {
 public:
  Fit(const ClusterTrack& track, std::span<const LoosePoints> loose, const BoxFitOptions& options)
      : track_(track), loose_(loose), options_(options) {
    for (const Cluster& cluster : track) {
      times_s_.push_back(cluster.time_s);
      middles_.push_back(cluster.middle);
    }
  }

  /// Whether it moves.
  bool find_path() {
    constexpr double kCluster_m = 0.5;  // the visible part changes
    smooth(kCluster_m);
    const Vec3d way = middles_.back() - middles_.front();
    const double way_m = std::hypot(way.x, way.y), time_s = times_s_.back() - times_s_.front();
    return way_m >= options_.min_way_m && way_m >= 0.7 * options_.min_speed_mps * time_s &&
           find_headings();
  }

  void find_boxes() {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
      find_views();
      find_size();
      for (std::size_t k = 0; k < track_.size(); ++k) {
        const View& view = views_[k];
        const double along = middle_of(view.extents[0], view.sensor.x, size_m_.x);
        const double left = middle_of(view.extents[1], view.sensor.y, size_m_.y);
        const double c = std::cos(headings_rad_[k]), s = std::sin(headings_rad_[k]);
        middles_[k] = track_[k].middle + Vec3d{c * along - s * left, s * along + c * left, 0};
      }
      smooth(options_.face_m);
      find_headings();
    }
  }

  BoxTrack boxes(FunctionRef<double(Vec3d)> height_below) const {
    constexpr double kHeight_m = 0.2;
    std::vector<double> tops, bottoms, deviations(track_.size(), kHeight_m);
    for (std::size_t k = 0; k < track_.size(); ++k) {
      const Extent& up = views_[k].extents[2];
      tops.push_back(track_[k].middle.z + up.high);
      bottoms.push_back(bottom_of(height_below(middles_[k]), track_[k].middle.z + up.low));
    }
    std::vector<double> heights;
    for (std::size_t k = 0; k < tops.size(); ++k) heights.push_back(tops[k] - bottoms[k]);
    const double height_m = std::max(quantile(heights, 0.75), 0.5);
    const std::vector<double> smooth_bottoms =
        smooth_path(times_s_, bottoms, deviations, options_.acceleration / 4).values;
    BoxTrack track;
    track.label = label_;
    for (std::size_t k = 0; k < track_.size(); ++k)
      track.boxes.push_back({times_s_[k],
                             {middles_[k].x, middles_[k].y, smooth_bottoms[k] + height_m / 2},
                             {size_m_.x / 2, size_m_.y / 2, height_m / 2},
                             headings_rad_[k]});
    return track;
  }

 private:
  void smooth(double deviation_m) {
    std::vector<double> x, y, deviations(middles_.size(), deviation_m);
    for (const Vec3d& middle : middles_) {
      x.push_back(middle.x);
      y.push_back(middle.y);
    }
    const SmoothPath on_x = smooth_path(times_s_, x, deviations, options_.acceleration);
    const SmoothPath on_y = smooth_path(times_s_, y, deviations, options_.acceleration);
    velocities_.clear();
    for (std::size_t k = 0; k < middles_.size(); ++k) {
      middles_[k].x = on_x.values[k];
      middles_[k].y = on_y.values[k];
      velocities_.push_back({on_x.rates[k], on_y.rates[k], 0});
    }
  }

  /// Where it drives; where it is slow, as at the nearest time at which it is not.
  bool find_headings() {
    headings_rad_.assign(track_.size(), 0);
    std::vector<std::size_t> fast;
    for (std::size_t k = 0; k < track_.size(); ++k)
      if (length(velocities_[k]) >= options_.min_speed_mps) fast.push_back(k);
    if (fast.empty()) return false;
    for (std::size_t k = 0; k < track_.size(); ++k) {
      const std::size_t nearest = *std::ranges::min_element(
          fast, {}, [&](std::size_t other) { return std::fabs(times_s_[other] - times_s_[k]); });
      headings_rad_[k] = std::atan2(velocities_[nearest].y, velocities_[nearest].x);
    }
    return true;
  }

  void find_views() {
    views_.clear();
    for (std::size_t k = 0; k < track_.size(); ++k)
      views_.push_back(view_of(track_[k], loose_[track_[k].scan], headings_rad_[k]));
  }

  void find_size() {
    constexpr double kLargest = 0.9;
    std::array<std::vector<double>, 3> lengths;
    std::vector<double> speeds;
    for (std::size_t k = 0; k < track_.size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        lengths[axis].push_back(views_[k].extents[axis].length());
      speeds.push_back(length(velocities_[k]));
    }
    const Vec3d seen = {quantile(lengths[0], kLargest), quantile(lengths[1], kLargest),
                        quantile(lengths[2], kLargest)};
    const double speed_mps = quantile(speeds, 0.5);
    constexpr Vec3d kCar = {4.5, 1.85, 1.5}, kTruck = {6, 2.4, 2.5}, kCyclist = {1.75, 0.6, 1.7},
                    kPerson = {0.6, 0.6, 1.7};
    Vec3d usual;
    const double longer = std::max(seen.x, seen.y);
    if (longer >= 2.3 || (seen.y >= 1.25 && speed_mps > 2.5)) {
      const bool is_truck = seen.z > 2 || seen.x > 6;
      label_ = is_truck ? "truck" : "car";
      usual = is_truck ? kTruck : kCar;
      // A whole side was seen: its length is known.
      size_m_ = {seen.x > 3.6 ? seen.x : usual.x, seen.y > 1.55 ? seen.y : usual.y, seen.z};
      return;
    }
    const bool is_cyclist = speed_mps > 2.5;
    label_ = is_cyclist ? "cyclist" : "pedestrian";
    usual = is_cyclist ? kCyclist : kPerson;
    size_m_ = {std::max(seen.x, usual.x), std::max(seen.y, usual.y), seen.z};
  }

  const ClusterTrack& track_;
  std::span<const LoosePoints> loose_;
  const BoxFitOptions& options_;
  std::vector<double> times_s_, headings_rad_;
  std::vector<Vec3d> middles_, velocities_;
  std::vector<View> views_;
  Vec3d size_m_;
  std::string label_;
};

}  // namespace

std::optional<BoxTrack> fit_boxes(const ClusterTrack& track, std::span<const LoosePoints> loose,
                                  FunctionRef<double(Vec3d)> height_below,
                                  const BoxFitOptions& options) {
  Fit fit(track, loose, options);
  if (!fit.find_path()) return std::nullopt;
  fit.find_boxes();
  return fit.boxes(height_below);
}

TimedBox fit_box_at_rest(std::span<const Vec3d> points, std::span<const Vec3d> sensors,
                         std::string_view label) {
  constexpr double kStep_rad = std::numbers::pi / 180;
  constexpr double kUsualLength_m = 4.2, kUsualWidth_m = 1.75;
  const Vec3d origin = points.front();
  double yaw_rad = 0, least_m2 = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 90; ++step) {
    const auto coordinates = turned(points, origin, step * kStep_rad);
    const Extent x = extent_of(coordinates[0]), y = extent_of(coordinates[1]);
    if (x.length() * y.length() >= least_m2) continue;
    least_m2 = x.length() * y.length();
    yaw_rad = step * kStep_rad + (x.length() >= y.length() ? 0 : std::numbers::pi / 2);
  }
  const auto coordinates = turned(points, origin, yaw_rad);
  std::array<Extent, 3> sides = {extent_of(coordinates[0]), extent_of(coordinates[1]),
                                 whole_extent(coordinates[2])};
  if (object_kind_of(label).is_vehicle) {
    const auto seen_from = turned(sensors, origin, yaw_rad);
    sides[0] = whole_side(sides[0], whole_extent(seen_from[0]), kUsualLength_m);
    sides[1] = whole_side(sides[1], whole_extent(seen_from[1]), kUsualWidth_m);
  }
  const auto middle = [](const Extent& side) { return 0.5 * (side.low + side.high); };
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const double along = middle(sides[0]), left = middle(sides[1]);
  TimedBox box;
  box.middle = origin + Vec3d{c * along - s * left, s * along + c * left, middle(sides[2])};
  box.half_size = {0.5 * sides[0].length(), 0.5 * sides[1].length(), 0.5 * sides[2].length()};
  box.yaw_rad = yaw_rad;
  return box;
}

}  // namespace adasplats
