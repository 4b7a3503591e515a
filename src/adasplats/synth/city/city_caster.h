// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/synth/city/city_sections.h"
#include "adasplats/synth/city/city_traffic.h"
#include "adasplats/synth/street_scan.h"

// Private to synth/city/: casts the rays of one revolution against nearby sections and movers.

namespace adasplats {

/// Firings of a revolution by azimuth, so that an object that covers a narrow angle is cast against
/// few rays.
class FiringSectors {
 public:
  explicit FiringSectors(std::span<const Firing> firings);
  /// Ascending indices of all firings that could hit a sphere; `center` is in the sensor's frame.
  std::vector<std::uint32_t> towards(Vec3d center, double radius) const;

 private:
  std::vector<std::vector<std::uint32_t>> sectors_;  ///< equal angles, from -pi
};

/// Sections and movers for one revolution.
struct CityScene {
  std::vector<const CitySection*> sections;
  const MoverModels* models = nullptr;
  std::vector<PlacedMover> movers;
};

/// The echoes of one revolution in the order of `firings`. Noise is drawn by (seed, scan, ray).
/// Movers that would collide with the scanning vehicle are omitted.
std::vector<StreetEcho> cast_city(const CityScene& scene, const LidarModel& sensor,
                                  std::span<const Firing> firings, const FiringSectors& sectors,
                                  const TimedPose& pose, std::uint64_t seed, std::uint64_t scan,
                                  const Executor& executor);

}  // namespace adasplats
