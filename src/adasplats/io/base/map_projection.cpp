// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/map_projection.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <string_view>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

// Formulas and their symbols: IOGP, "Geomatics Guidance Note 7, part 2" (373-7-2), methods 9807
// (Transverse Mercator, series of Krueger as in JHS 154), 9802 (Lambert Conic Conformal, 2SP) and
// 9602 (geocentric coordinates).

constexpr double kSemiMajor_m = 6'378'137;  // of WGS 84 and GRS 1980
constexpr double kWgs84 = 298.257223563, kGrs80 = 298.257222101;
constexpr double kMaxFromMeridian_m = 1e6, kMaxNorthing_m = 1e7;
constexpr double kDegree = std::numbers::pi / 180;

double eccentricity(double inverse_flattening) {
  const double f = 1 / inverse_flattening;
  return std::sqrt(f * (2 - f));
}

/// Isometric latitude of a latitude.
double isometric(double latitude, double e) {
  return std::asinh(std::tan(latitude)) - e * std::atanh(e * std::sin(latitude));
}

/// The inverse of isometric(). The iteration gains more than two digits a round.
double latitude_of(double isometric_latitude, double e) {
  double conformal = isometric_latitude;
  for (int round = 0; round < 8; ++round)
    conformal = isometric_latitude + e * std::atanh(e * std::tanh(conformal));
  return std::atan(std::sinh(conformal));
}

}  // namespace

std::optional<MapProjection> MapProjection::of(const Crs& crs) {
  constexpr std::string_view kAuthority = "EPSG:";
  const std::string name = crs.name();  // "EPSG:32632+5773 (...)"
  if (!name.starts_with(kAuthority)) return std::nullopt;
  const std::string code =
      name.substr(kAuthority.size(), name.find_first_of("+ ") - kAuthority.size());
  const int number = parse_number<int>(code).value_or(0);
  MapProjection made;
  made.inverse_flattening_ = kGrs80;
  if (number == 2154) return made;
  const int family = number / 100;
  made.zone_ = number % 100;
  if (family == 258 && made.zone_ >= 28 && made.zone_ <= 38) return made;
  made.inverse_flattening_ = kWgs84;
  made.is_south_ = family == 327;
  if ((family == 326 || family == 327) && made.zone_ >= 1 && made.zone_ <= 60) return made;
  return std::nullopt;
}

Geographic MapProjection::of_utm(double easting_m, double northing_m) const {
  constexpr double kScale = 0.9996, kFalseEasting_m = 5e5, kFalseNorthing_m = 1e7;
  const double n = 1 / (2 * inverse_flattening_ - 1);  // f / (2 - f)
  const std::array<double, 4> h = {
      n / 2 - n * n * 2 / 3 + n * n * n * 37 / 96 - n * n * n * n / 360,
      n * n / 48 + n * n * n / 15 - n * n * n * n * 437 / 1440,
      n * n * n * 17 / 480 - n * n * n * n * 37 / 840, n * n * n * n * 4397 / 161280};
  const double radius = kSemiMajor_m / (1 + n) * (1 + n * n / 4 + n * n * n * n / 64) * kScale;
  const double xi = (northing_m - (is_south_ ? kFalseNorthing_m : 0)) / radius;
  const double eta = (easting_m - kFalseEasting_m) / radius;
  double xi0 = xi, eta0 = eta;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double twice = 2 * static_cast<double>(i + 1);
    xi0 -= h[i] * std::sin(twice * xi) * std::cosh(twice * eta);
    eta0 -= h[i] * std::cos(twice * xi) * std::sinh(twice * eta);
  }
  const double conformal = std::asinh(std::sin(xi0) / std::hypot(std::sinh(eta0), std::cos(xi0)));
  const double meridian = (6 * zone_ - 183) * kDegree;
  return {latitude_of(conformal, eccentricity(inverse_flattening_)),
          meridian + std::atan2(std::sinh(eta0), std::cos(xi0))};
}

Geographic MapProjection::of_lambert_93(double easting_m, double northing_m) const {
  constexpr double kNorth = 49 * kDegree, kSouth = 44 * kDegree, kOrigin = 46.5 * kDegree;
  constexpr double kMeridian = 3 * kDegree, kFalseEasting_m = 7e5, kFalseNorthing_m = 6.6e6;
  const double e = eccentricity(inverse_flattening_);
  const auto m = [e](double latitude) {
    const double s = e * std::sin(latitude);
    return std::cos(latitude) / std::sqrt(1 - s * s);
  };
  const double n = std::log(m(kNorth) / m(kSouth)) / (isometric(kSouth, e) - isometric(kNorth, e));
  // r = a F exp(-n psi), with the isometric latitude psi = -ln t.
  const double a_f = kSemiMajor_m * m(kNorth) / n * std::exp(n * isometric(kNorth, e));
  const double east = easting_m - kFalseEasting_m;
  const double south = a_f * std::exp(-n * isometric(kOrigin, e)) - (northing_m - kFalseNorthing_m);
  return {latitude_of(-std::log(std::hypot(east, south) / a_f) / n, e),
          kMeridian + std::atan2(east, south) / n};
}

std::optional<Geographic> MapProjection::geographic(double easting_m, double northing_m) const {
  const double meridian_m = zone_ > 0 ? 5e5 : 7e5;
  if (!(std::fabs(easting_m - meridian_m) <= kMaxFromMeridian_m) || !(northing_m >= 0) ||
      !(northing_m <= kMaxNorthing_m))
    return std::nullopt;
  return zone_ > 0 ? of_utm(easting_m, northing_m) : of_lambert_93(easting_m, northing_m);
}

std::optional<Vec3d> MapProjection::geocentric(Vec3d projected_m) const {
  const auto place = geographic(projected_m.x, projected_m.y);
  if (!place) return std::nullopt;
  const double e = eccentricity(inverse_flattening_);
  const double sine = std::sin(place->latitude_rad), cosine = std::cos(place->latitude_rad);
  const double normal_m = kSemiMajor_m / std::sqrt(1 - e * e * sine * sine);
  const double from_axis_m = (normal_m + projected_m.z) * cosine;
  return Vec3d{from_axis_m * std::cos(place->longitude_rad),
               from_axis_m * std::sin(place->longitude_rad),
               (normal_m * (1 - e * e) + projected_m.z) * sine};
}

std::optional<std::array<double, 16>> MapProjection::geocentric_from_local(Vec3d at) const {
  // Central differences: the second order cancels, and rounding is 1e-11 of this step.
  constexpr double kStep_m = 100;
  std::array<double, 16> matrix{};
  const auto center = geocentric(at);
  if (!center) return std::nullopt;
  Vec3d translation = *center;
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    Vec3d step;
    step[axis] = kStep_m;
    const auto after = geocentric(at + step), before = geocentric(at - step);
    if (!after || !before) return std::nullopt;
    const Vec3d column = (*after - *before) / (2 * kStep_m);
    translation = translation - at[axis] * column;
    for (std::size_t row = 0; row < 3; ++row) matrix[4 * k + row] = column[static_cast<int>(row)];
  }
  for (std::size_t row = 0; row < 3; ++row) matrix[12 + row] = translation[static_cast<int>(row)];
  matrix[15] = 1;
  return matrix;
}

}  // namespace adasplats
