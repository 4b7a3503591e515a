// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/echoes/beam_grid.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr int kSteps = 4000;  // of the encoder, 0.09 degrees each: HDL-64E S2 user's manual
constexpr double kStep_rad = 2 * std::numbers::pi / kSteps;
/// Points are on their cones to within millimetres (cloud/sequence/scan_beams.cpp), and from 9 m on
/// cones are farther apart than twice this. A smaller value loses points, a larger one adds points
/// of no ring.
constexpr double kMaxOffCone_m = 0.02;
/// Of a ring. For this many random phases the mean has a length of 0.1, far below kMinOrder.
constexpr std::size_t kMinPoints = 100;
/// An eighth of an HDL-64E: a few rings may fit by chance, and not all need to be present.
constexpr std::size_t kMinRings = 8;
/// Length of the mean of unit vectors at the phases of a ring's azimuths: 1 on a lattice; at least
/// 0.95 for KITTI's raw rings, at most 0.6 for compensated ones.
constexpr double kMinOrder = 0.8;
/// Share of a ring's points on the firings of the fullest ring: halfway between the expected share
/// for random points (half) and all.
constexpr double kMinOnFirings = 0.75;

using Steps = std::bitset<kSteps>;

/// One laser: its points and the lattice of its azimuths.
struct Ring {
  std::size_t beam = 0;               ///< of the sensor
  std::vector<std::uint32_t> points;  ///< of the scan
  double lateral_m = 0;               ///< of its origin, left of the axis seen along the beam
  double phase_rad = 0;               ///< of the lattice, within half a step
  int shift = 0;                      ///< steps from the fullest ring's firings to this ring's
  std::vector<int> steps;             ///< of each point
  Steps occupied;
};

int wrapped(int step) { return ((step % kSteps) + kSteps) % kSteps; }

Vec3d point_of(const KittiScan& scan, std::uint32_t i) {
  return vec_cast<double>(scan.positions[i]);
}

double rho_m(Vec3d point) { return std::hypot(point.x, point.y); }

double height_m(const LidarModel& sensor, std::size_t beam) {
  return sensor.beam_origins_m.empty() ? 0.0 : sensor.beam_origins_m[beam].z;
}

/// Azimuth of a beam that started `lateral_m` left of the axis and hit `point`.
double beam_azimuth_rad(Vec3d point, double lateral_m) {
  const double sine = std::clamp(lateral_m / rho_m(point), -1.0, 1.0);
  return std::atan2(point.y, point.x) - std::asin(sine);
}

/// Points by the cone that they are on; others belong to no ring.
std::vector<Ring> rings_of(const KittiScan& scan, const LidarModel& sensor) {
  std::vector<Ring> rings(sensor.elevations_rad.size());
  for (std::size_t beam = 0; beam < rings.size(); ++beam) rings[beam].beam = beam;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3d point = point_of(scan, static_cast<std::uint32_t>(i));
    if (!is_finite(point) || !(rho_m(point) > 0)) continue;
    double nearest_m = kMaxOffCone_m;
    Ring* nearest = nullptr;
    for (Ring& ring : rings) {
      const double elevation_rad = sensor.elevations_rad[ring.beam];
      const double above_m =
          point.z - height_m(sensor, ring.beam) - std::tan(elevation_rad) * rho_m(point);
      const double distance_m = std::fabs(above_m) * std::cos(elevation_rad);
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      nearest = &ring;
    }
    if (nearest != nullptr) nearest->points.push_back(static_cast<std::uint32_t>(i));
  }
  std::erase_if(rings, [](const Ring& ring) { return ring.points.size() < kMinPoints; });
  return rings;
}

/// Mean of the phases of a ring's azimuths on the lattice, as unit vectors.
std::complex<double> mean_phase(const KittiScan& scan, const Ring& ring, double lateral_m) {
  constexpr std::size_t kEnough = 400;  // points: the mean is accurate to 1/20
  const std::size_t every = std::max<std::size_t>(1, ring.points.size() / kEnough);
  std::complex<double> sum = 0;
  double count = 0;
  for (std::size_t k = 0; k < ring.points.size(); k += every) {
    const double azimuth_rad = beam_azimuth_rad(point_of(scan, ring.points[k]), lateral_m);
    sum += std::polar(1.0, azimuth_rad / kStep_rad * 2 * std::numbers::pi);
    ++count;
  }
  return sum / count;
}

/// Finds a ring's lattice and the steps of its points on it. False: there is no lattice.
bool fit_lattice(const KittiScan& scan, Ring& ring) {
  constexpr int kMaxLateral_mm = 60;  // about twice what sensors/velodyne-hdl-64e-*.toml have
  double best = 0;
  for (int distance_mm = 0; distance_mm <= kMaxLateral_mm; ++distance_mm) {
    for (const int side : {1, -1}) {
      const double lateral_m = 1e-3 * side * distance_mm;
      const std::complex<double> mean = mean_phase(scan, ring, lateral_m);
      if (std::abs(mean) <= best) continue;
      best = std::abs(mean);
      ring.lateral_m = lateral_m;
      ring.phase_rad = std::arg(mean) / (2 * std::numbers::pi) * kStep_rad;
    }
  }
  if (best < kMinOrder) return false;
  for (const std::uint32_t i : ring.points) {
    const double azimuth_rad = beam_azimuth_rad(point_of(scan, i), ring.lateral_m);
    const int step = static_cast<int>(std::lround((azimuth_rad - ring.phase_rad) / kStep_rad));
    ring.steps.push_back(wrapped(step));
    ring.occupied.set(static_cast<std::size_t>(ring.steps.back()));
  }
  return true;
}

/// `steps` rotated counter-clockwise.
Steps turned(const Steps& steps, int by) {
  const auto shift = static_cast<std::size_t>(wrapped(by));
  return (steps << shift) | (steps >> (kSteps - shift));
}

/// Rotates `ring` onto the firings of `fullest`. False: it does not fit.
bool align(Ring& ring, const Ring& fullest) {
  constexpr int kMaxShift = 300;  // 27 degrees; 18.5 at most in sensors/velodyne-hdl-64e-*.toml
  std::size_t best = 0;
  for (int size = 0; size <= kMaxShift; ++size) {
    for (const int shift : {size, -size}) {
      const std::size_t common = (ring.occupied & turned(fullest.occupied, shift)).count();
      if (common <= best) continue;
      best = common;
      ring.shift = shift;
    }
  }
  return static_cast<double>(best) >= kMinOnFirings * static_cast<double>(ring.occupied.count());
}

/// Steps of the fullest ring at which lasers fired: at least two rings have a point there.
std::vector<int> firing_steps(const std::vector<Ring>& rings) {
  std::vector<int> support(kSteps);
  for (const Ring& ring : rings) {
    const Steps occupied = turned(ring.occupied, -ring.shift);
    for (int step = 0; step < kSteps; ++step) {
      support[static_cast<std::size_t>(step)] += occupied[static_cast<std::size_t>(step)] ? 1 : 0;
    }
  }
  std::vector<int> firings;
  // Clockwise from the rear, which is half a turn.
  for (int k = 0; k < kSteps; ++k) {
    const int step = wrapped(kSteps / 2 - k);
    if (support[static_cast<std::size_t>(step)] >= 2) firings.push_back(step);
  }
  return firings;
}

Firing firing_at(const Ring& ring, std::uint32_t column, int step, const LidarModel& sensor) {
  const double azimuth_rad = wrapped(step + ring.shift) * kStep_rad + ring.phase_rad;
  const double elevation_rad = sensor.elevations_rad[ring.beam];
  const double sine = std::sin(azimuth_rad), cosine = std::cos(azimuth_rad);
  const double flat = std::cos(elevation_rad);
  const double share =
      0.5 - std::remainder(azimuth_rad, 2 * std::numbers::pi) / (2 * std::numbers::pi);
  Firing firing{};
  firing.direction = vec_cast<float>(Vec3d{flat * cosine, flat * sine, std::sin(elevation_rad)});
  firing.origin = vec_cast<float>(
      Vec3d{-ring.lateral_m * sine, ring.lateral_m * cosine, height_m(sensor, ring.beam)});
  firing.ring = static_cast<std::uint16_t>(ring.beam);
  firing.column = column;
  firing.time_s = static_cast<float>(share / sensor.rotation_hz);
  return firing;
}

void add_ring(BeamGrid& grid, const KittiScan& scan, const Ring& ring,
              const std::vector<int>& firings, const LidarModel& sensor) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::int64_t> point_at(kSteps, -1);
  for (std::size_t k = 0; k < ring.points.size(); ++k) {
    std::int64_t& cell = point_at[static_cast<std::size_t>(ring.steps[k])];
    if (cell >= 0) {
      ++grid.doubled;
    } else {
      cell = ring.points[k];
    }
  }
  for (std::size_t column = 0; column < firings.size(); ++column) {
    const Firing firing =
        firing_at(ring, static_cast<std::uint32_t>(column), firings[column], sensor);
    const auto step = static_cast<std::size_t>(wrapped(firings[column] + ring.shift));
    const std::int64_t point = point_at[step];
    grid.beams.push_back(firing);
    grid.ranges_m.push_back(kNothing);
    grid.intensities.push_back(kNothing);
    if (point < 0) continue;
    const auto i = static_cast<std::size_t>(point);
    grid.ranges_m.back() = length(scan.positions[i] - firing.origin);
    if (!scan.intensities.empty()) grid.intensities.back() = scan.intensities[i];
    ++grid.points;
  }
}

}  // namespace

BeamGrid find_beam_grid(const KittiScan& scan, const LidarModel& sensor) {
  if (sensor.elevations_rad.empty() || !(sensor.rotation_hz > 0)) {
    throw Error(ErrorKind::usage, std::string("sensor '") + sensor.name +
                                      "' has no rotating beams, expected a rotating sensor such as "
                                      "an HDL-64E");
  }
  std::vector<Ring> rings = rings_of(scan, sensor);
  std::erase_if(rings, [&](Ring& ring) { return !fit_lattice(scan, ring); });
  if (!rings.empty()) {
    const auto fewer = [](const Ring& a, const Ring& b) {
      return a.occupied.count() < b.occupied.count();
    };
    const Ring fullest = *std::max_element(rings.begin(), rings.end(), fewer);
    std::erase_if(rings, [&](Ring& ring) { return !align(ring, fullest); });
  }
  if (rings.size() < kMinRings) {
    throw Error(ErrorKind::data,
                std::string("the points match the firings of ") + std::to_string(rings.size()) +
                    " beams of sensor '" + sensor.name + "', expected at least " +
                    std::to_string(kMinRings) +
                    ": missing returns can only be identified in raw scans of an HDL-64E");
  }
  const std::vector<int> firings = firing_steps(rings);
  BeamGrid grid;
  grid.columns = firings.size();
  for (const Ring& ring : rings) add_ring(grid, scan, ring, firings, sensor);
  grid.outside = scan.positions.size() - grid.points - grid.doubled;
  return grid;
}

}  // namespace adasplats
