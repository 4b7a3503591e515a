// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

namespace {

constexpr int kMaxSide_px = 1 << 15;

/// The largest distance of a pixel's corner from the principal point, at z = 1.
double largest_distorted(const Lens& lens) {
  const double x = std::max(lens.cx + 0.5, lens.width - 0.5 - lens.cx) / lens.fx;
  const double y = std::max(lens.cy + 0.5, lens.height - 0.5 - lens.cy) / lens.fy;
  return std::hypot(x, y);
}

/// The radius at an angle to the axis.
double radius_at(const Lens& lens, double angle_rad) {
  return lens.is_fisheye ? angle_rad : std::tan(angle_rad);
}

/// Follows the distortion outwards from the axis, as far as it grows or the picture needs it.
double growing_radius(const Lens& lens) {
  constexpr int kSteps = 16384;
  const double end_rad = lens.is_fisheye ? std::numbers::pi : 1.5698;  // 89.94 degrees
  const double needed = largest_distorted(lens);
  const double tangential = 3 * std::hypot(lens.p1, lens.p2);
  double before = 0, distorted = 0;
  for (int step = 1; step <= kSteps; ++step) {
    const double radius = radius_at(lens, end_rad * step / kSteps);
    const Lens::Radial at = lens.distorted_radius(radius);
    // A pole of the denominator lies between steps with signs that differ.
    if (!(at.slope > 0 && at.value > distorted)) return before;
    if (at.value - tangential * radius * radius > needed) return radius;
    before = radius;
    distorted = at.value;
  }
  return before;
}

/// Whether the determinant of the distortion is clearly positive within max_radius.
bool is_clearly_regular(const Lens& lens) {
  constexpr int kTurns = 64, kRings = 64;
  constexpr double kClear = 0.05;
  for (int ring = 1; ring <= kRings; ++ring)
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = 2 * std::numbers::pi * turn / kTurns;
      const double radius = lens.max_radius * ring / kRings;
      const Lens::Point p = {radius * std::cos(angle), radius * std::sin(angle)};
      if (!(lens.distort(p).determinant() > kClear)) return false;
    }
  return true;
}

constexpr double kMaxValue = 1e9;

void require_value(double value, const char* key, const std::string& name) {
  if (!(std::fabs(value) <= kMaxValue))
    throw Error(ErrorKind::config, name + ": " + key + " is not a number from -1e9 to 1e9");
}

}  // namespace

Lens complete_lens(Lens lens, const std::string& name) {
  const auto is_size = [](int size) { return size >= 1 && size <= kMaxSide_px; };
  if (!is_size(lens.width) || !is_size(lens.height))
    throw Error(ErrorKind::config, name + ": a picture of " + std::to_string(lens.width) + " x " +
                                       std::to_string(lens.height) +
                                       " pixels; expected 1 to 32768 each");
  constexpr double kMinFocal_px = 1e-3;
  for (const auto& [value, key] : {std::pair{lens.fx, "fx"}, {lens.fy, "fy"}}) {
    require_value(value, key, name);
    if (!(value >= kMinFocal_px))
      throw Error(ErrorKind::config, name + ": " + key + " is " + exact_text(value) +
                                         ", expected a focal length above 0, in pixels");
  }
  require_value(lens.cx, "cx", name);
  require_value(lens.cy, "cy", name);
  for (const double k : lens.k) require_value(k, "a distortion coefficient", name);
  require_value(lens.p1, "p1", name);
  require_value(lens.p2, "p2", name);
  lens.max_radius = growing_radius(lens);
  lens.is_regular_throughout = !lens.is_fisheye && is_clearly_regular(lens);
  return lens;
}

std::optional<Lens::Point> project(const Lens& lens, Vec3d point) {
  const double across = std::hypot(point.x, point.y);
  Lens::Point image;
  if (lens.is_fisheye) {
    const double angle = std::atan2(across, point.z);
    if (!(angle <= lens.max_radius)) return std::nullopt;
    const double distorted = lens.distorted_radius(angle).value;
    if (across > 0) image = {point.x * distorted / across, point.y * distorted / across};
  } else {
    if (!(point.z > 0)) return std::nullopt;
    const Lens::Point flat = {point.x / point.z, point.y / point.z};
    if (!lens.is_regular(flat)) return std::nullopt;
    image = lens.distort(flat).at;
  }
  return Lens::Point{lens.fx * image.x + lens.cx, lens.fy * image.y + lens.cy};
}

}  // namespace adasplats
