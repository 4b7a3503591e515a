// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"

namespace adasplats {

/// A place on an ellipsoid.
struct Geographic {
  double latitude_rad = 0, longitude_rad = 0;
};

/// Places the coordinates of a map projection on the Earth: UTM zones of WGS 84 (EPSG:32601 to
/// 32660, 32701 to 32760) and ETRS89 (EPSG:25828 to 25838), and Lambert-93 (EPSG:2154). WGS 84,
/// ETRS89 and RGF93 count as the same datum, which is right to a metre.
class MapProjection {
 public:
  /// The projection of a system; nullopt for any other one.
  static std::optional<MapProjection> of(const Crs& crs);

  /// Latitude and longitude of easting and northing, m; nullopt more than 1000 km from the central
  /// meridian of a UTM zone, or beyond a pole. Accurate to 1 um within a zone.
  std::optional<Geographic> geographic(double easting_m, double northing_m) const;
  /// Earth-centered, Earth-fixed coordinates (EPSG:4978), m, of easting, northing and height above
  /// the ellipsoid; nullopt where geographic() is.
  std::optional<Vec3d> geocentric(Vec3d projected_m) const;
  /// Affine map of easting, northing and height near `at` to geocentric(): a matrix of 4 x 4,
  /// column by column, that is exact at `at` and has the convergence and scale of the projection
  /// there; nullopt where geographic() is.
  std::optional<std::array<double, 16>> geocentric_from_local(Vec3d at) const;

 private:
  MapProjection() = default;
  Geographic of_utm(double easting_m, double northing_m) const;
  Geographic of_lambert_93(double easting_m, double northing_m) const;

  double inverse_flattening_ = 0;
  int zone_ = 0;  ///< of UTM; 0: Lambert-93
  bool is_south_ = false;
};

}  // namespace adasplats
