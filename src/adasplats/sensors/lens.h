// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "adasplats/core/maths/elementary.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// The distortion of a real camera and its inverse, with the parameters and formulas of OpenCV
/// (calib3d and fisheye). Pixels: integer coordinates are the centres, (0, 0) is the centre of the
/// top left pixel. Directions: x right, y down, z forward. With a radius (tangent of the angle to
/// the axis, fisheye: the angle itself, rad):
///
///   radial:  distorted = radius (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   fisheye: distorted = radius (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8)
///
/// The first also has the tangential terms p1 and p2. Beyond some radius these polynomials shrink
/// again and mean nothing: `max_radius` ends there, and pixels that only those directions reach
/// have no ray.
struct Lens {
  struct Point {
    double x = 0, y = 0;
  };

  int width = 0, height = 0;           ///< pixels
  double fx = 0, fy = 0;               ///< focal lengths, pixels
  double cx = 0, cy = 0;               ///< principal point, pixels
  bool is_fisheye = false;             ///< equidistant
  double k[6] = {0, 0, 0, 0, 0, 0};    ///< k1 to k6; fisheye: k1 to k4
  double p1 = 0, p2 = 0;               ///< not of a fisheye
  double max_radius = 0;               ///< set by complete_lens()
  bool is_regular_throughout = false;  ///< the same: is_regular() up to max_radius

  /// Direction of the light that reaches a point of the image, of length 1; the zero vector if
  /// there is none.
  ADASPLATS_HD Vec3d direction(double u, double v) const {
    const Point image = {(u - cx) / fx, (v - cy) / fy};
    const double distorted = std::sqrt(image.x * image.x + image.y * image.y);
    if (!(distorted > 0)) return {0, 0, distorted == 0 ? 1.0 : 0.0};  // not for NaN
    const bool has_tangential = !is_fisheye && (p1 != 0 || p2 != 0);
    double radius = undistorted_radius(distorted);
    if (radius < 0) {
      if (!has_tangential) return {};
      radius = max_radius;
    }
    const double scale = radius / distorted;
    if (is_fisheye) {
      constexpr double kTurns = 0.15915494309189535;  // per radian
      const double sine = cos_of_turns(std::fabs(0.25 - kTurns * radius)) / distorted;
      return {image.x * sine, image.y * sine, cos_of_turns(kTurns * radius)};
    }
    Point point = {image.x * scale, image.y * scale};
    if (has_tangential && !solve(image, point)) return {};
    return normalized(Vec3d{point.x, point.y, 1});
  }

  /// A value and its derivatives.
  struct Radial {
    double value, slope;
  };

  /// The factor of a radius, by the square of the radius.
  ADASPLATS_HD Radial factor(double square) const {
    if (is_fisheye) {
      const double value = 1 + square * (k[0] + square * (k[1] + square * (k[2] + square * k[3])));
      return {value, k[0] + square * (2 * k[1] + square * (3 * k[2] + square * 4 * k[3]))};
    }
    const double above = 1 + square * (k[0] + square * (k[1] + square * k[2]));
    const double above_slope = k[0] + square * (2 * k[1] + square * 3 * k[2]);
    if (k[3] == 0 && k[4] == 0 && k[5] == 0) return {above, above_slope};
    const double below = 1 + square * (k[3] + square * (k[4] + square * k[5]));
    const double below_slope = k[3] + square * (2 * k[4] + square * 3 * k[5]);
    return {above / below, (above_slope * below - above * below_slope) / (below * below)};
  }

  /// The distorted radius and its derivative.
  ADASPLATS_HD Radial distorted_radius(double radius) const {
    const Radial at = factor(radius * radius);
    return {radius * at.value, at.value + 2 * radius * radius * at.slope};
  }

  /// The distortion of a point at z = 1 and its derivatives (the matrix xx xy, xy yy).
  struct Distorted {
    Point at;
    double xx, xy, yy;
    ADASPLATS_HD double determinant() const { return xx * yy - xy * xy; }
  };
  ADASPLATS_HD Distorted distort(Point p) const {
    const double square = p.x * p.x + p.y * p.y;
    const Radial radial = factor(square);
    Distorted result;
    result.at.x = p.x * radial.value + 2 * p1 * p.x * p.y + p2 * (square + 2 * p.x * p.x);
    result.at.y = p.y * radial.value + p1 * (square + 2 * p.y * p.y) + 2 * p2 * p.x * p.y;
    result.xx = radial.value + 2 * p.x * p.x * radial.slope + 2 * p1 * p.y + 6 * p2 * p.x;
    result.xy = 2 * p.x * p.y * radial.slope + 2 * p1 * p.x + 2 * p2 * p.y;
    result.yy = radial.value + 2 * p.y * p.y * radial.slope + 6 * p1 * p.y + 2 * p2 * p.x;
    return result;
  }

  /// Whether distortion is one to one from the axis to a point: its determinant is positive on the
  /// line between them.
  ADASPLATS_HD bool is_regular(Point p) const {
    constexpr int kSteps = 8;
    if (!(p.x * p.x + p.y * p.y <= max_radius * max_radius)) return false;
    if (is_regular_throughout) return true;
    for (int i = 1; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      if (!(distort({share * p.x, share * p.y}).determinant() > 0)) return false;
    }
    return true;
  }

 private:
  static constexpr double kTolerance = 1e-10;  // 1e-6 pixels for a focal length of 10,000 pixels

  /// The inverse of distorted_radius() up to max_radius, where it grows; -1 if there is none.
  ADASPLATS_HD double undistorted_radius(double distorted) const {
    constexpr int kMaxSteps = 60;
    double low = 0, high = max_radius;
    double radius = distorted < high ? distorted : high;
    for (int step = 0; step < kMaxSteps; ++step) {  // Newton's steps, halving outside the bracket
      const Radial at = distorted_radius(radius);
      const double error = at.value - distorted;
      if (error == 0) return radius;
      (error > 0 ? high : low) = radius;
      double next = radius - error / at.slope;
      const bool is_inside = next > low && next < high;
      if (!is_inside) next = 0.5 * (low + high);
      const double move = std::fabs(next - radius);
      radius = next;
      // The error after a step of Newton is about the square of the step.
      if (move <= (is_inside ? 1e-9 : 1e-16) * radius) break;
    }
    const bool found = std::fabs(distorted_radius(radius).value - distorted) <= kTolerance;
    return found ? radius : -1;
  }

  /// Newton's method for the point whose distortion is `image`, from a point near it.
  ADASPLATS_HD bool solve(Point image, Point& point) const {
    constexpr int kMaxSteps = 20;
    for (int step = 0; step < kMaxSteps; ++step) {
      const Distorted found = distort(point);
      const Point error = {found.at.x - image.x, found.at.y - image.y};
      const double determinant = found.determinant();
      if (!(determinant > 0)) return false;
      const Point move = {(found.yy * error.x - found.xy * error.y) / determinant,
                          (found.xx * error.y - found.xy * error.x) / determinant};
      point.x -= move.x;
      point.y -= move.y;
      if (std::fabs(move.x) + std::fabs(move.y) <= 1e-9) break;
    }
    const Point error = {distort(point).at.x - image.x, distort(point).at.y - image.y};
    return std::fabs(error.x) + std::fabs(error.y) <= kTolerance && is_regular(point);
  }
};

/// Checks the values of a lens and sets the members for its inversion. Errors: config, with `name`
/// of the camera (sizes outside 1 to 32768, focal lengths below 0.001, numbers that are not finite
/// or beyond 1e9).
Lens complete_lens(Lens lens, const std::string& name);

/// The pixel that shows a point of the camera's frame (x right, y down, z forward); it may be
/// outside the picture. Nothing if the lens does not show that direction.
std::optional<Lens::Point> project(const Lens& lens, Vec3d point);

}  // namespace adasplats
