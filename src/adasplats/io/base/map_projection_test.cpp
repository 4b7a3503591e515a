// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/map_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace adasplats {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kTolerance_deg = 1e-10;  // 11 um

std::optional<MapProjection> projection(const std::string& code) {
  return MapProjection::of(crs_of_wkt("EPSG:" + code));
}

struct Place {
  const char* code;
  double easting_m, northing_m, latitude_deg, longitude_deg;
};

// The latitudes and longitudes are those of proj4js 2 (etmerc and lcc).
constexpr Place kPlaces[] = {{"32632", 455000.25, 5430000.5, 49.021249770362, 8.384502721974},
                             {"32738", 444140.54, 6315293.64, -33.300000039883, 44.399999946898},
                             {"25833", 800000, 5800000, 52.268365083165, 19.397379049534},
                             {"2154", 652470.64, 6862035.26, 48.856600124521, 2.352222041014},
                             {"2154", 1200000, 6100000, 41.829506139858, 9.010871731777}};

TEST(MapProjection, AgreesWithAnotherImplementation) {
  for (const Place& place : kPlaces) {
    const auto found = projection(place.code)->geographic(place.easting_m, place.northing_m);
    ASSERT_TRUE(found) << place.code;
    EXPECT_NEAR(found->latitude_rad * kDegrees, place.latitude_deg, kTolerance_deg) << place.code;
    EXPECT_NEAR(found->longitude_rad * kDegrees, place.longitude_deg, kTolerance_deg) << place.code;
  }
}

TEST(MapProjection, HasPublishedValues) {
  // The example of GeographicLib's GeoConvert: 33.3 N 44.4 E, to a centimetre.
  const auto baghdad = projection("32638")->geographic(444140.54, 3684706.36);
  EXPECT_NEAR(baghdad->latitude_rad * kDegrees, 33.3, 1e-7);
  EXPECT_NEAR(baghdad->longitude_rad * kDegrees, 44.4, 1e-7);
  // The false origin of Lambert-93 by its definition (EPSG:18085).
  const auto origin = projection("2154")->geographic(700000, 6600000);
  EXPECT_NEAR(origin->latitude_rad * kDegrees, 46.5, kTolerance_deg);
  EXPECT_NEAR(origin->longitude_rad * kDegrees, 3, kTolerance_deg);
  // Guidance Note 7-2, method 9602: its example is 53.80939 N 2.12955 E, 73 m; here on the equator.
  const Vec3d equator = *projection("32631")->geocentric({500000, 0, 10});
  EXPECT_NEAR(std::hypot(equator.x, equator.y), 6378147, 1e-6);
  EXPECT_NEAR(std::atan2(equator.y, equator.x) * kDegrees, 3, kTolerance_deg);
  EXPECT_NEAR(equator.z, 0, 1e-6);
}

TEST(MapProjection, HasScaleAndConvergence) {
  const Vec3d at = {800000, 5800000, 100};
  const auto projected = projection("25833");
  const auto m = projected->geocentric_from_local(at);
  ASSERT_TRUE(m);
  const auto column = [&m](std::size_t k) {
    return Vec3d{(*m)[4 * k], (*m)[4 * k + 1], (*m)[4 * k + 2]};
  };
  // proj4js 2, as above.
  const Vec3d center = at.x * column(0) + at.y * column(1) + at.z * column(2) + column(3);
  EXPECT_NEAR(length(center - Vec3d{3689425.750545821, 1299062.2064277637, 5021211.499553121}), 0,
              1e-3);
  // Point scale 0.9996 (1 + x^2 / 2 + ...), x = distance from the meridian over k0 R.
  const double k = 1 / length(column(0)) * (1 + at.z / 6.39e6);
  const double x = 300000 / (0.9996 * 6.385e6);
  EXPECT_NEAR(k, 0.9996 * (1 + x * x / 2 + x * x * x * x / 24), 2e-6);
  EXPECT_NEAR(length(column(1)), length(column(0)), 1e-7);  // at 100 m, by the two radii
  EXPECT_NEAR(length(column(2)), 1, 1e-9);
  EXPECT_NEAR(dot(column(0), column(1)), 0, 1e-8);
  // Grid north is turned from true north by atan(tan(lon - lon0) sin(lat)) of the sphere.
  const auto place = *projected->geographic(at.x, at.y);
  const double east = std::sin(place.longitude_rad), cosine = std::cos(place.longitude_rad);
  const double turn = std::atan2(dot(column(1), Vec3d{-east, cosine, 0}),
                                 dot(column(1), normalized(cross(column(2), {-east, cosine, 0}))));
  const double from_meridian = place.longitude_rad - 15 / kDegrees;
  EXPECT_NEAR(turn, std::atan(std::tan(from_meridian) * std::sin(place.latitude_rad)), 3e-5);
}

TEST(MapProjection, KnowsNoOtherSystemAndNoOtherPlace) {
  for (const char* code : {"2263", "4326", "32600", "32661", "25839", "31467", "26910", "21"})
    EXPECT_FALSE(projection(code)) << code;
  EXPECT_FALSE(MapProjection::of({}));
  EXPECT_FALSE(MapProjection::of(crs_of_wkt("LOCAL_CS[\"site\"]")));
  EXPECT_TRUE(MapProjection::of(crs_of_wkt("EPSG:32632")));
  const auto zone = projection("32632");
  EXPECT_FALSE(zone->geographic(2e6, 5e6));
  EXPECT_FALSE(zone->geographic(5e5, -1));
  EXPECT_FALSE(zone->geographic(NAN, 5e6));
  EXPECT_FALSE(zone->geocentric_from_local({5e5, 50, 0}));
}

}  // namespace
}  // namespace adasplats
