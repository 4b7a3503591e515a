// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/returns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

std::vector<Return> returns_of_hits(const std::vector<Hit>& hits, const BeamOptions& options,
                                    const std::vector<std::uint16_t>& classes = {}) {
  std::vector<Return> out(static_cast<std::size_t>(options.returns));
  out.resize(returns_of(hits, sub_ray_weights(options), classes, options, out));
  return out;
}

LidarModel wide_beam() {
  LidarModel sensor;
  sensor.name = "wide";
  sensor.divergence_rad[0] = 0.02;
  sensor.divergence_rad[1] = 0.01;
  return sensor;
}

std::vector<Firing> one_firing(Vec3f direction) {
  return {{direction, 7, 42, 0.25F, {0.1F, 0.2F, 0.3F}}};
}

/// Hits of the sub-rays of a firing along +x with surfaces x = surface(y, z), and their primitives.
template <class Surface, class Primitive>
std::vector<Hit> hits_on(const LidarModel& sensor, const BeamOptions& options, Surface surface,
                         Primitive primitive) {
  std::vector<Hit> hits;
  for (const Firing& ray : sub_firings(sensor, one_firing({1, 0, 0}), options)) {
    const Vec3d d = vec_cast<double>(ray.direction);
    hits.push_back({static_cast<float>(surface(d)), primitive(d)});
  }
  return hits;
}

// Oracle: identity.
TEST(Returns, OneRayAndOneHitGiveTheHit) {
  const BeamOptions options;
  const Hit hit{12.3456789F, 5};
  const auto returns = returns_of_hits({hit}, options);
  ASSERT_EQ(returns.size(), 1U);
  EXPECT_EQ(returns[0].range_m, hit.t);
  EXPECT_EQ(returns[0].primitive, 5U);
  EXPECT_EQ(returns[0].energy, 1.0F);
  EXPECT_TRUE(returns_of_hits({Hit{}}, options).empty());
}

// Oracle: the formula by hand. D = 5: beta = e^-0.6, e^-0.2, e^-0.2, e^-0.6, e^-1; their sum is
// 3.102964 and that of i beta_i 8.677109: 2.796394 equal steps.
TEST(Returns, FiveOverlappingHitsGiveThePapersMean) {
  BeamOptions options;
  options.depth = 5;
  std::vector<Hit> hits;
  for (std::uint32_t i = 1; i <= 5; ++i) hits.push_back({0.0625F * static_cast<float>(i), 10 + i});
  const auto returns = returns_of_hits(hits, options);
  ASSERT_EQ(returns.size(), 1U);
  const double beta[5] = {0.548811636, 0.818730753, 0.818730753, 0.548811636, 0.367879441};
  double sum = 0;
  double places = 0;
  for (int i = 0; i < 5; ++i) {
    sum += beta[i];
    places += beta[i] * (i + 1);
  }
  EXPECT_NEAR(static_cast<double>(returns[0].range_m), 0.0625 * places / sum, 1e-7);
  EXPECT_EQ(returns[0].primitive, 12U) << "of hits 2 and 3, which weigh the same, the nearer";
  EXPECT_EQ(returns[0].energy, 1.0F);
}

// Oracle: by hand. D' = 2: |1 - 1| / 1 = 0 and |2 - 1| / 1 = 1, so (r1 + r2 / e) / (1 + 1 / e).
TEST(Returns, DepthIsTheNumberOfOverlappingHits) {
  BeamOptions options;
  options.depth = 5;
  const double e = std::numbers::e;
  const float expected = static_cast<float>((10.0 + 10.0625 / e) / (1 + 1 / e));
  EXPECT_FLOAT_EQ(returns_of_hits({{10, 0}, {10.0625F, 1}, {}, {}, {}}, options)[0].range_m,
                  expected)
      << "fewer hits than the depth";
  const std::vector<Hit> with_gap{{10, 0}, {10.0625F, 1}, {10.25F, 2}, {10.3F, 3}, {10.35F, 4}};
  EXPECT_FLOAT_EQ(returns_of_hits(with_gap, options)[0].range_m, expected) << "a gap";
  const std::vector<Hit> of_classes{{10, 0}, {10.0625F, 1}, {10.07F, 2}, {10.08F, 3}, {10.09F, 4}};
  EXPECT_FLOAT_EQ(returns_of_hits(of_classes, options, {9, 9, 8, 9, 9})[0].range_m, expected)
      << "another class";
  EXPECT_EQ(returns_of_hits({{10, 0}, {10.2F, 1}, {10.21F, 2}, {}, {}}, options)[0].range_m, 10.0F)
      << "the first alone";
  EXPECT_TRUE(returns_of_hits(std::vector<Hit>(5), options).empty());
}

// Oracle: analytic. The sub-rays lie evenly around the axis: on the plane x = 10 + y their mean is
// the axis' range but for the second order of the divergence.
TEST(Returns, APlaneAt45DegreesGivesTheRangeOfTheAxis) {
  const LidarModel sensor = wide_beam();
  BeamOptions options;
  options.depth_gap_m = 1;
  for (const int sub_rays : {3, 5, 7, 13, 19, 37, 64}) {
    options.sub_rays = sub_rays;
    const auto hits = hits_on(
        sensor, options, [](Vec3d d) { return 10.0 / (d.x - d.y); },
        [](Vec3d) { return std::uint32_t{3}; });
    const auto returns = returns_of_hits(hits, options);
    ASSERT_EQ(returns.size(), 1U) << sub_rays;
    EXPECT_NEAR(static_cast<double>(returns[0].range_m), 10.0, 10 * 0.01 * 0.01) << sub_rays;
    EXPECT_NEAR(static_cast<double>(returns[0].energy), 1.0, 1e-6) << sub_rays;
    EXPECT_EQ(returns[0].primitive, 3U);
  }
}

// Oracle: the definition: the mean over what lies within the gap of the nearest echo.
TEST(Returns, TheRisingEdgeDecidesOnASlope) {
  BeamOptions options;
  options.sub_rays = 5;
  options.depth_gap_m = 0.1;
  const auto weights = sub_ray_weights(options);
  const std::vector<Hit> hits{{10.5F, 0}, {10.0F, 1}, {10.05F, 2}, {11.0F, 3}, {10.75F, 4}};
  const auto returns = returns_of_hits(hits, options);
  ASSERT_EQ(returns.size(), 1U) << "steps of half a metre are one slope";
  EXPECT_FLOAT_EQ(returns[0].range_m, 10.025F);
  EXPECT_EQ(returns[0].primitive, 1U);
  EXPECT_NEAR(static_cast<double>(returns[0].energy), 1.0, 1e-6);
  options.separation_m = 0.3;
  options.returns = 3;
  options.mode = ReturnMode::first;
  const auto split = returns_of_hits(hits, options);
  ASSERT_EQ(split.size(), 2U);
  EXPECT_FLOAT_EQ(split[0].energy, 2 * weights[1]);
  // The axis is the edge of the second pulse, 10.75 and 11 m lie beyond the gap.
  EXPECT_FLOAT_EQ(split[1].range_m, 10.5F);
  EXPECT_FLOAT_EQ(split[1].energy, weights[0] + 2 * weights[3]);
}

// Oracle: analytic. A Gaussian beam over an edge at the share y of its radius has the energies of
// the two half planes; on the axis each half has one half.
TEST(Returns, AnEdgeBetweenTwoWallsGivesTwoReturnsWithTheirAreas) {
  const LidarModel sensor = wide_beam();
  BeamOptions options;
  options.sub_rays = 61;
  options.returns = 2;
  options.mode = ReturnMode::first;
  const auto weights = sub_ray_weights(options);
  for (const double edge : {-0.004, 0.0005, 0.006}) {
    const auto near_wall = [edge](Vec3d d) { return d.y / d.x < edge; };
    const auto hits = hits_on(
        sensor, options, [&](Vec3d d) { return (near_wall(d) ? 10.0 : 20.0) / d.x; },
        [&](Vec3d d) { return near_wall(d) ? 1U : 2U; });
    const auto returns = returns_of_hits(hits, options);
    ASSERT_EQ(returns.size(), 2U);
    double near_energy = 0;
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (hits[i].primitive == 1) near_energy += static_cast<double>(weights[i]);
    EXPECT_NEAR(static_cast<double>(returns[0].energy), near_energy, 1e-6);
    EXPECT_NEAR(static_cast<double>(returns[1].energy), 1 - near_energy, 1e-6);
    // The share of the half plane: its Gaussian integral, here with the cut at the ellipse ignored.
    EXPECT_NEAR(near_energy, 0.5 * (1 + std::erf(std::sqrt(2.0) * edge / 0.01)), 0.1);
    EXPECT_NEAR(static_cast<double>(returns[0].range_m), 10, 1e-3);
    EXPECT_NEAR(static_cast<double>(returns[1].range_m), 20, 2e-3);
    EXPECT_EQ(returns[0].primitive, 1U);
    EXPECT_EQ(returns[1].primitive, 2U);
  }
}

TEST(Returns, ClassesAreNeverMixed) {
  BeamOptions options;
  options.sub_rays = 5;
  options.returns = 5;
  options.mode = ReturnMode::first;
  options.separation_m = 0.015;
  // Road and pavement alternate in steps of a centimetre.
  const std::vector<Hit> hits{{10.00F, 0}, {10.01F, 1}, {10.02F, 2}, {10.03F, 3}, {10.04F, 4}};
  ASSERT_EQ(returns_of_hits(hits, options).size(), 1U) << "without classes";
  options.separation_m = 0.025;
  const auto strongest_class = returns_of_hits(hits, options, {40, 48, 40, 48, 40});
  // The nearer class has three echoes; the other one cannot be separated from it.
  ASSERT_EQ(strongest_class.size(), 1U);
  EXPECT_NEAR(static_cast<double>(strongest_class[0].range_m),
              (10.00 * static_cast<double>(sub_ray_weights(options)[0]) +
               (10.02 + 10.04) * static_cast<double>(sub_ray_weights(options)[1])) /
                  (static_cast<double>(sub_ray_weights(options)[0]) +
                   2 * static_cast<double>(sub_ray_weights(options)[1])),
              1e-6);
  EXPECT_FLOAT_EQ(strongest_class[0].energy,
                  sub_ray_weights(options)[0] + 2 * sub_ray_weights(options)[1]);
  options.depth = 2;
  options.sub_rays = 1;
  EXPECT_EQ(returns_of_hits({{10, 0}, {10.01F, 1}}, options, {40, 48})[0].range_m, 10.0F);
}

TEST(Returns, MissesTakeTheirEnergyWithThem) {
  BeamOptions options;
  options.sub_rays = 7;
  std::vector<Hit> hits(7);
  EXPECT_TRUE(returns_of_hits(hits, options).empty());
  hits[3] = {4, 1};
  const auto returns = returns_of_hits(hits, options);
  ASSERT_EQ(returns.size(), 1U);
  EXPECT_EQ(returns[0].range_m, 4.0F);
  EXPECT_EQ(returns[0].energy, sub_ray_weights(options)[3]);
}

std::vector<float> reported_ranges(std::vector<Return> pulses, ReturnMode mode, int returns,
                                   double separation_m = 0.75) {
  BeamOptions options;
  options.mode = mode;
  options.returns = returns;
  options.separation_m = separation_m;
  pulses.resize(reported_returns(pulses, options));
  std::vector<float> ranges;
  ranges.reserve(pulses.size());
  for (const Return& pulse : pulses) ranges.push_back(pulse.range_m);
  return ranges;
}

// Oracle: the manual's words for strongest, last and dual returns.
TEST(Returns, ModesFollowTheManual) {
  const std::vector<Return> pulses{{5, 0, 0.2F}, {10, 1, 0.5F}, {15, 2, 0.1F}, {20, 3, 0.2F}};
  using Ranges = std::vector<float>;
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::first, 1), Ranges({5}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::last, 1), Ranges({20}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::strongest, 1), Ranges({10}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::first, 3), Ranges({5, 10, 15}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::last, 2), Ranges({20, 15}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::strongest, 2), Ranges({10, 20})) << "the last";
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::strongest, 9), Ranges({10, 20, 5, 15}));
  const std::vector<Return> far_is_strongest{{5, 0, 0.2F}, {10, 1, 0.3F}, {20, 3, 0.5F}};
  EXPECT_EQ(reported_ranges(far_is_strongest, ReturnMode::strongest, 2), Ranges({20, 10}));
  EXPECT_TRUE(reported_ranges({}, ReturnMode::strongest, 2).empty());
}

TEST(Returns, TiesGoToTheNearerEcho) {
  const std::vector<Return> equal{{5, 0, 0.25F}, {10, 1, 0.25F}, {15, 2, 0.25F}, {20, 3, 0.25F}};
  EXPECT_EQ(reported_ranges(equal, ReturnMode::strongest, 2), std::vector<float>({5, 20}));
  EXPECT_EQ(reported_ranges({equal.begin(), equal.begin() + 1}, ReturnMode::strongest, 2),
            std::vector<float>({5}));
  BeamOptions options;
  options.sub_rays = 3;
  options.separation_m = 0.1;
  const auto returns = returns_of_hits({{}, {9, 4}, {9, 2}}, options);
  ASSERT_EQ(returns.size(), 1U);
  EXPECT_EQ(returns[0].primitive, 4U) << "the sub-ray that comes first";
}

TEST(Returns, CloserReturnsAreSuppressed) {
  const std::vector<Return> pulses{{5, 0, 0.3F}, {5.5F, 1, 0.4F}, {9, 2, 0.2F}};
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::strongest, 3), std::vector<float>({5.5F, 9}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::first, 3), std::vector<float>({5, 9}));
  EXPECT_EQ(reported_ranges(pulses, ReturnMode::last, 3, 0.25), std::vector<float>({9, 5.5F, 5}));
}

TEST(Returns, AMissingClassIsALogicError) {
  BeamOptions options;
  options.depth = 2;
  EXPECT_THROW(returns_of_hits({{1, 0}, {1.01F, 9}}, options, {1}), std::logic_error);
}

// Oracle: the ellipse of the divergence, and symmetry: the energies' centre is the axis.
TEST(SubFirings, AreEvenlyDistributedInsideTheDivergence) {
  const LidarModel sensor = wide_beam();
  for (const Vec3f axis : {Vec3f{1, 0, 0}, normalized(Vec3f{1, -2, 0.5F}), Vec3f{0, 0, 1}}) {
    for (const int sub_rays : {1, 3, 4, 7, 18, 19, 20, 37, 61, 64}) {
      BeamOptions options;
      options.sub_rays = sub_rays;
      const auto rays = sub_firings(sensor, one_firing(axis), options);
      const auto weights = sub_ray_weights(options);
      ASSERT_EQ(rays.size(), static_cast<std::size_t>(sub_rays));
      ASSERT_EQ(weights.size(), rays.size());
      EXPECT_TRUE(rays[0].direction == axis);
      Vec3d centre;
      double energy = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3d d = vec_cast<double>(rays[i].direction);
        EXPECT_NEAR(length(d), 1.0, 1e-7);
        EXPECT_LT(std::acos(std::min(1.0, dot(d, vec_cast<double>(axis)))), 0.0100001);
        EXPECT_EQ(rays[i].ring, 7);
        EXPECT_EQ(rays[i].column, 42U);
        EXPECT_EQ(rays[i].time_s, 0.25F);
        EXPECT_TRUE((rays[i].origin == Vec3f{0.1F, 0.2F, 0.3F}));
        EXPECT_GT(weights[i], 0.0F);
        centre = centre + static_cast<double>(weights[i]) * d;
        energy += static_cast<double>(weights[i]);
      }
      EXPECT_NEAR(energy, 1.0, 1e-6);
      EXPECT_LT(length(cross(centre, vec_cast<double>(axis))), 1e-7) << sub_rays;
    }
  }
}

// Oracle: of a Gaussian with the 1/e^2 radius w cut at w, half the energy lies within w times
// sqrt(-ln((1 + e^-2) / 2) / 2) = 0.532; the mean of r^2 is w^2 (1 - 3 e^-2) / (2 (1 - e^-2)).
TEST(SubFirings, HaveTheEnergyOfAGaussianBeam) {
  LidarModel sensor = wide_beam();
  sensor.divergence_rad[1] = sensor.divergence_rad[0];
  BeamOptions options;
  options.sub_rays = 61;
  const auto rays = sub_firings(sensor, one_firing({1, 0, 0}), options);
  const auto weights = sub_ray_weights(options);
  double squares = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3d d = vec_cast<double>(rays[i].direction) / static_cast<double>(rays[i].direction.x);
    squares += static_cast<double>(weights[i]) * (d.y * d.y + d.z * d.z) / (0.01 * 0.01);
  }
  const double e2 = std::exp(-2.0);
  EXPECT_NEAR(squares, (1 - 3 * e2) / (2 * (1 - e2)), 0.02);
}

// Oracle: the datasheet's 0.18 degrees, where a Gaussian beam has half the intensity of its axis;
// so its 1/e^2 radius is 0.18 / sqrt(2 ln 2) degrees, and the mean of r^2 as above.
TEST(SubFirings, OfAnOusterFillItsWidthAtHalfMaximum) {
  const LidarModel sensor = load_lidar_model("ouster-os1-128");
  BeamOptions options;
  options.sub_rays = 61;
  const auto rays = sub_firings(sensor, one_firing({1, 0, 0}), options);
  const auto weights = sub_ray_weights(options);
  double squares = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3d d = vec_cast<double>(rays[i].direction) / static_cast<double>(rays[i].direction.x);
    squares += static_cast<double>(weights[i]) * (d.y * d.y + d.z * d.z);
  }
  const double radius = 0.18 * std::numbers::pi / 180 / std::sqrt(2.0 * std::numbers::ln2);
  const double e2 = std::exp(-2.0);
  EXPECT_NEAR(squares / (radius * radius), (1 - 3 * e2) / (2 * (1 - e2)), 0.02);
}

TEST(SubFirings, HorizontalDivergenceIsHorizontal) {
  LidarModel sensor = wide_beam();
  sensor.divergence_rad[1] = 0;
  BeamOptions options;
  options.sub_rays = 7;
  for (const Firing& ray : sub_firings(sensor, one_firing({0, 1, 0}), options))
    EXPECT_NEAR(static_cast<double>(ray.direction.z), 0.0, 1e-9);
}

TEST(SubFirings, OneRayIsTheFiringAndNoFiringsGiveNone) {
  const auto rays = sub_firings(LidarModel{}, one_firing({0, 1, 0}), {});
  ASSERT_EQ(rays.size(), 1U);
  EXPECT_TRUE((rays[0].direction == Vec3f{0, 1, 0}));
  EXPECT_TRUE(sub_firings(LidarModel{}, {}, {}).empty());
}

ErrorKind kind_of_check(const BeamOptions& options, const LidarModel& sensor) {
  try {
    check_beam(options, sensor);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::software;
}

TEST(CheckBeam, RejectsInvalidBeams) {
  const LidarModel sensor = wide_beam();
  EXPECT_NO_THROW(check_beam({}, LidarModel{}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const BeamOptions& wrong :
       {BeamOptions{.depth = 0}, BeamOptions{.depth = 65}, BeamOptions{.depth_gap_m = -1},
        BeamOptions{.depth_gap_m = nan}, BeamOptions{.sub_rays = 0}, BeamOptions{.sub_rays = 2},
        BeamOptions{.sub_rays = 65}, BeamOptions{.separation_m = nan}, BeamOptions{.returns = 0},
        BeamOptions{.returns = 65}})
    EXPECT_EQ(kind_of_check(wrong, sensor), ErrorKind::usage);
  EXPECT_EQ(kind_of_check({.sub_rays = 7}, LidarModel{}), ErrorKind::usage) << "no divergence";
  EXPECT_NO_THROW(check_beam({.depth = 64, .sub_rays = 64, .returns = 64}, sensor));
}

}  // namespace
}  // namespace adasplats
