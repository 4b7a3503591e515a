// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace adasplats {

/// How the intensity that a sensor measures depends on range and incidence: intensity =
/// reflectance * range gain * incidence gain. Both are tables, linear between their nodes and
/// constant outside; 1 at about 10 m and head on. Empty tables: 1 everywhere.
struct IntensityResponse {
  std::vector<float> ranges_m;         ///< ascending
  std::vector<float> range_gains;      ///< one a range
  std::vector<float> cos_incidences;   ///< ascending, 0..1
  std::vector<float> incidence_gains;  ///< one a cosine

  bool empty() const { return ranges_m.empty(); }
  float gain(float range_m, float cos_incidence) const;
};

/// Reflectances of splats with the response of the sensor that measured them (ReflectancesOn).
struct Reflectances {
  std::vector<float> values;  ///< one a disk; 0 or more
  IntensityResponse response;
};

}  // namespace adasplats
