// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace adasplats {

/// Dependence of measured intensity on range and incidence: intensity = reflectance * range gain *
/// incidence gain. Both gains are tables, linear between nodes and constant outside; 1 at about 10
/// m and at normal incidence. Empty tables: 1 everywhere.
struct IntensityResponse {
  std::vector<float> ranges_m;         ///< ascending
  std::vector<float> range_gains;      ///< one per range
  std::vector<float> cos_incidences;   ///< ascending, 0..1
  std::vector<float> incidence_gains;  ///< one per cosine

  bool empty() const { return ranges_m.empty(); }
  float gain(float range_m, float cos_incidence) const;
};

/// Reflectances of splats, and the response of the sensor that measured them (ReflectancesOn).
struct Reflectances {
  std::vector<float> values;  ///< one per disk; at least 0
  IntensityResponse response;
  /// Per disk, by how much the log odds of losing a return exceed those at its ranges and
  /// incidences; empty: no lost beams are known.
  std::vector<float> drop_log_odds;
};

}  // namespace adasplats
